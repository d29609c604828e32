/* lap u + 2 grad div u = 2 (d + 2) sum_j V_j F_ij (e.u_ij) e,  e = r_ij/r,  u_ij = u_i - u_j
 *
 * (Monaghan & Gingold 1983; Cleary 1998; Monaghan 2005): central, so that angular momentum is
 * conserved.  Points at the same place add nothing. */
#include "operator_data.h"

typedef struct task {
  int dim;
  const double *const *u;
  double *const *out;
} task;

static int mcg(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const int dim = t->dim;
  double sum[3] = {0};
  (void)rung;
  for (long k = 0; k < row->n; k++) {
    double ru = 0;
    if (!(row->r2[k] > 0)) continue;
    for (int d = 0; d < dim; d++) ru += row->r[d][k] * (t->u[d][row->i] - t->u[d][row->j[k]]);
    for (int d = 0; d < dim; d++)
      sum[d] += 2 * (dim + 2) * row->VF[k] * ru / row->r2[k] * row->r[d][k];
  }
  for (int d = 0; d < dim; d++) t->out[d][row->i] = sum[d];
  return 0;
}

int sph_operator_mcg(sph_operator *op, const double *const u[], double *const out[],
                     sph_error *error)
{
  static const char name[] = "mcg";
  int status = sph_operator_check(op, name, 1, error);
  if (!status) status = sph_operator_need(name, "u", op->def.dim, u, error);
  if (!status) status = sph_operator_need(name, "out", op->def.dim, SPH_WRITTEN(out), error);
  if (status) return status;
  const task t = {op->def.dim, u, out};
  return sph_operator_each(op, name, mcg, &t, 1, error);
}
