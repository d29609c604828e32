#include "sphode/term.h"

sph_term sph_term_viscosity_laminar(const char *form)
{
  return (sph_term){.name = "viscosity-laminar", .form = form};
}
