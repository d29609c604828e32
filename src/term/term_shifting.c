#include "sphode/term.h"

sph_term sph_term_shifting(const char *form, double speed)
{
  return (sph_term){.name = "shifting",
                    .form = form,
                    .speed = speed,
                    .strength = 1,
                    .crowding = 0.2,
                    .surface = 1,
                    .advection = 1};
}
