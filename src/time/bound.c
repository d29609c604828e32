#include "sphode/integrator.h"

const char *sph_bound_name(int bound)
{
  static const char *const name[SPH_BOUND_COUNT] = {
      [SPH_BOUND_CFL] = "cfl",
      [SPH_BOUND_VISCOUS] = "viscous",
      [SPH_BOUND_FORCE] = "force",
      [SPH_BOUND_CONDUCTION] = "conduction",
      [SPH_BOUND_DIFFUSION] = "diffusion",
      [SPH_BOUND_DRAG] = "drag",
      [SPH_BOUND_SWITCH] = "switch",
      [SPH_BOUND_ERROR] = "error",
      [SPH_BOUND_STOP] = "stop",
      [SPH_BOUND_USER] = "dt_max",
      [SPH_BOUND_RETRY] = "retry",
  };
  return bound >= 0 && bound < SPH_BOUND_COUNT ? name[bound] : "";
}
