/* Sound of small amplitude e: the linear equations d rho/dt = -rho0 dv/dx, rho0 dv/dt = -dp/dx,
 * p - p0 = c^2 (rho - rho0), with phase k x - omega t, omega = c k:
 *
 *   running    rho = rho0 [1 + e cos(kx - omega t)],      v = e c cos(kx - omega t)
 *   standing   rho = rho0 [1 + e cos(kx) cos(omega t)],   v = e c sin(kx) sin(omega t)
 *
 * What is left out is of order e^2. */
#include <math.h>

#include "exact.h"

sph_exact_gas sph_exact_wave_at(const sph_exact_wave *w, double t, double x)
{
  double kx = w->k * x, phase = w->c * w->k * t;
  double rho = w->amplitude * (w->standing ? cos(kx) * cos(phase) : cos(kx - phase));
  double u = w->amplitude * w->c * (w->standing ? sin(kx) * sin(phase) : cos(kx - phase));
  return (sph_exact_gas){w->rho * (1 + rho), u, w->p + w->c * w->c * w->rho * rho};
}
