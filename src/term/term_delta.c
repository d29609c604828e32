#include "sphode/term.h"

sph_term sph_term_delta(const char *model, double delta)
{
  return (sph_term){.name = "delta", .form = model, .delta = delta};
}
