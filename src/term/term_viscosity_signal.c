#include "sphode/term.h"

sph_term sph_term_viscosity_signal(double alpha, double beta)
{
  return (sph_term){.name = "viscosity-signal", .alpha = alpha, .beta = beta};
}
