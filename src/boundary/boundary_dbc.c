#include "sphode/boundary.h"

sph_boundary sph_boundary_dbc(void) { return (sph_boundary){.name = "dbc"}; }
