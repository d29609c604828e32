#include "sphode/term.h"

sph_term sph_term_transport_velocity(double background, double time)
{
  return (sph_term){.name = "transport-velocity",
                    .background = background,
                    .time = time,
                    .advection = 1};
}
