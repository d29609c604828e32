#include "sphode/term.h"

sph_term sph_term_stress_artificial(double alpha, double beta)
{
  return (sph_term){.name = "stress-artificial", .alpha = alpha, .beta = beta};
}
