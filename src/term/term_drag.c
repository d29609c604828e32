#include "sphode/term.h"

sph_term sph_term_drag(double K) { return (sph_term){.name = "drag", .form = "K", .drag = K}; }

sph_term sph_term_drag_time(double t_s)
{
  return (sph_term){.name = "drag", .form = "time", .drag = t_s};
}
