#include "sphode/term.h"

sph_term sph_term_continuity(void) { return sph_term_continuity_form("c2"); }

sph_term sph_term_continuity_form(const char *form)
{
  return (sph_term){.name = "continuity", .form = form};
}

sph_term sph_term_continuity_phi(double exponent)
{
  return (sph_term){.name = "continuity", .form = "phi", .exponent = exponent};
}
