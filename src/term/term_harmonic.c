/* Central harmonic body force a = -omega^2 x, potential omega^2 x^2/2 (Monaghan & Rafiee 2013). */
#include "sphode/term.h"

static int body(const sph_term *term, const sph_particles *s)
{
  for (int d = 0; d < s->dim; d++)
    for (long i = 0; i < s->n; i++) s->a[d][i] -= term->omega * term->omega * s->x[d][i];
  return SPH_OK;
}

static double potential(const sph_term *term, const double x[3])
{
  return 0.5 * term->omega * term->omega * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

sph_term sph_term_harmonic(double omega)
{
  return (sph_term){
      .name = "harmonic", .omega = omega, .body = body, .reads = "", .potential = potential};
}
