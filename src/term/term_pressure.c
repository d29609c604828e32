#include "sphode/term.h"

sph_term sph_term_pressure(void) { return sph_term_pressure_form("c2"); }

sph_term sph_term_pressure_form(const char *form)
{
  return (sph_term){.name = "pressure", .form = form};
}
