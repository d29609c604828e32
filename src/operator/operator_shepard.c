/* f_i = sum_j V_j f_j W_ij/sum_j V_j W_ij   (Shepard 1968) */
#include "operator_data.h"

typedef struct task {
  const double *f;
  double *value;
} task;

int sph_operator_shepard_row(const sph_row *row, const double *f, double *value)
{
  double sum = 0, norm = 0;
  for (long k = 0; k < row->n; k++) {
    sum += row->VW[k] * f[row->j[k]];
    norm += row->VW[k];
  }
  *value = norm > 0 ? sum / norm : 0;
  return !(norm > 0);
}

static int shepard(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  return sph_operator_shepard_row(row, t->f, &t->value[row->i]) && rung == 0;
}

int sph_operator_shepard(sph_operator *op, const double *f, double *value, sph_error *error)
{
  static const char name[] = "shepard";
  const task t = {f, value};
  int status = sph_operator_check(op, name, 0, error);
  if (!status) status = sph_operator_need(name, "f", 1, &f, error);
  if (!status) status = sph_operator_need(name, "value", 1, SPH_WRITTEN(&value), error);
  return status ? status : sph_operator_each(op, name, shepard, &t, 2, error);
}
