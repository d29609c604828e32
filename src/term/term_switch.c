#include "sphode/term.h"

sph_term sph_term_switched(sph_term viscosity, const char *switches, double alpha_min)
{
  viscosity.switches = switches;
  viscosity.alpha_min = alpha_min;
  return viscosity;
}
