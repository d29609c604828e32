/* Heating by a source, q_i = Q(x_i, t) [W/kg]. */
#include <stddef.h>

#include "sphode/term.h"

static int body(const sph_term *term, const sph_particles *s)
{
  for (long i = 0; s->du && i < s->n; i++) {
    double x[3] = {0};
    for (int d = 0; d < s->dim; d++) x[d] = s->x[d][i];
    s->du[i] += term->power(term->ctx, x, s->t);
  }
  return SPH_OK;
}

sph_term sph_term_heat_source(double (*power)(void *ctx, const double x[3], double t), void *ctx)
{
  return (sph_term){
      .name = "heat-source", .power = power, .body = power ? body : NULL, .reads = "", .ctx = ctx};
}
