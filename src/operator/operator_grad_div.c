/* grad div u = sum_j V_j F_ij ((d + 2) (e.u_ij) e - u_ij),  e = r_ij/r,  u_ij = u_i - u_j
 *
 * (Espanol & Revenga 2003).  Points at the same place have no e: they add nothing. */
#include "operator_data.h"

typedef struct task {
  int dim;
  const double *const *u;
  double *const *out;
} task;

static int grad_div(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const int dim = t->dim;
  double sum[3] = {0};
  (void)rung;
  for (long k = 0; k < row->n; k++) {
    if (!(row->r2[k] > 0)) continue;
    double u[3], ru = 0;
    for (int d = 0; d < dim; d++) {
      u[d] = t->u[d][row->i] - t->u[d][row->j[k]];
      ru += row->r[d][k] * u[d];
    }
    for (int d = 0; d < dim; d++)
      sum[d] += row->VF[k] * ((dim + 2) * ru / row->r2[k] * row->r[d][k] - u[d]);
  }
  for (int d = 0; d < dim; d++) t->out[d][row->i] = sum[d];
  return 0;
}

int sph_operator_grad_div(sph_operator *op, const double *const u[], double *const out[],
                          sph_error *error)
{
  static const char name[] = "grad_div";
  int status = sph_operator_check(op, name, 1, error);
  if (!status) status = sph_operator_need(name, "u", op->def.dim, u, error);
  if (!status) status = sph_operator_need(name, "out", op->def.dim, SPH_WRITTEN(out), error);
  if (status) return status;
  const task t = {op->def.dim, u, out};
  return sph_operator_each(op, name, grad_div, &t, 1, error);
}
