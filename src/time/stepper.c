#include "stepper.h"

int sph_stepper_rhs(sph_stepper *s, double t, N_Vector y, N_Vector ydot)
{
  s->stats->rhs_evaluations++;
  int status = s->problem->rhs(t, y, ydot, s->problem->ctx);
  if (status) s->stage_status = status;
  return status;
}

void sph_stepper_hermite(double t0, double t1, double t, N_Vector y0, N_Vector f0, N_Vector y1,
                         N_Vector f1, N_Vector at)
{
  double dt = t1 - t0, s = dt > 0 ? (t - t0) / dt : 1, s2 = s * s, s3 = s2 * s;
  sunrealtype c[4] = {2 * s3 - 3 * s2 + 1, dt * (s3 - 2 * s2 + s), 3 * s2 - 2 * s3, dt * (s3 - s2)};
  N_Vector x[4] = {y0, f0, y1, f1};
  N_VLinearCombination(4, c, x, at);
}
