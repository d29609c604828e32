/* <f>_i = sum_j V_j f_j W_ij   (Monaghan 1992) */
#include "operator_data.h"

typedef struct task {
  const double *f;
  double *value;
} task;

static int interpolate(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  double sum = 0;
  (void)rung;
  for (long k = 0; k < row->n; k++) sum += row->VW[k] * t->f[row->j[k]];
  t->value[row->i] = sum;
  return 0;
}

int sph_operator_interpolate(sph_operator *op, const double *f, double *value, sph_error *error)
{
  static const char name[] = "interpolate";
  const task t = {f, value};
  int status = sph_operator_check(op, name, 0, error);
  if (!status) status = sph_operator_need(name, "f", 1, &f, error);
  if (!status) status = sph_operator_need(name, "value", 1, SPH_WRITTEN(&value), error);
  return status ? status : sph_operator_each(op, name, interpolate, &t, 1, error);
}
