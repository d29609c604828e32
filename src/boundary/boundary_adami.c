#include "sphode/boundary.h"

sph_boundary sph_boundary_adami(void) { return (sph_boundary){.name = "adami"}; }

sph_boundary sph_boundary_adami_no_slip(void)
{
  return (sph_boundary){.name = "adami", .no_slip = 1};
}
