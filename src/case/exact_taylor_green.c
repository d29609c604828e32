/* Taylor-Green vortices (Taylor & Green 1937), an exact solution of the equations of an
 * incompressible liquid in a periodic box:
 *
 *   v_x = -U cos kx sin ky exp(-2 nu k^2 t),  v_y = U sin kx cos ky exp(-2 nu k^2 t)
 *   p   = -(rho U^2/4) (cos 2kx + cos 2ky) exp(-4 nu k^2 t) */
#include <math.h>

#include "exact.h"

sph_exact_flow sph_exact_taylor_green_at(const sph_exact_taylor_green *f, double t, double x,
                                         double y)
{
  double k = f->k, u = f->speed * exp(-2 * f->nu * k * k * t);
  return (sph_exact_flow){{-u * cos(k * x) * sin(k * y), u * sin(k * x) * cos(k * y)},
                          -f->rho * u * u / 4 * (cos(2 * k * x) + cos(2 * k * y))};
}
