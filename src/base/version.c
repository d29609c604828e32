#include "config.h"
#include "sphode/base.h"

const char *sph_version(void) { return PACKAGE_VERSION; }
