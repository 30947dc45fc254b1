#include "globebrowsing/network/fetcher.h"
