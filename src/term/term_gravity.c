#include <math.h>

#include "sphode/term.h"

sph_term sph_term_gravity(const double g[3])
{
  sph_term term = {.name = "gravity"};
  for (int d = 0; d < 3; d++) term.g[d] = g ? g[d] : NAN;
  return term;
}
