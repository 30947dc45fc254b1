#include "globebrowsing/tiling/geodetic_tiling.h"
