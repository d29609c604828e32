#include "sphode/term.h"

sph_term sph_term_viscosity_artificial(double alpha, double beta)
{
  return (sph_term){.name = "viscosity-artificial", .alpha = alpha, .beta = beta};
}
