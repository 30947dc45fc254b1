#include "globebrowsing/geodesy/ellipsoid.h"
