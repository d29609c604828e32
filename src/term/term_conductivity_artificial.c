#include "sphode/term.h"

sph_term sph_term_conductivity_artificial(double alpha_u)
{
  return (sph_term){.name = "conductivity-artificial", .alpha = alpha_u};
}
