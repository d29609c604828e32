/* Corrective smoothed particle method (Chen & Beraun 2000), value and gradient together (Liu & Liu
 * 2006): the Taylor series f_j = f_i - grad f_i . r_ij, taken with W and with grad W,
 *
 *   sum_j V_j f_j W_ij        =  (sum_j V_j W_ij) f_i         - (sum_j V_j r_ij W_ij) . grad f_i
 *   sum_j V_j f_j grad_i W_ij =  (sum_j V_j grad_i W_ij) f_i  +  M_i grad f_i
 *
 * Exact for linear f.  Rows and unknowns are scaled by h, so that all are of the size of f. */
#include "operator_data.h"

typedef struct task {
  int dim;
  double h;
  const double *f;
  double *value;
  double *const *gradient; /* or NULL */
} task;

static int solve(const task *t, const sph_row *row, double *x)
{
  const int n = t->dim + 1;
  double A[16] = {0};
  for (long k = 0; k < row->n; k++) {
    double test[4] = {row->VW[k]}, basis[4] = {1}; /* W, h grad W; 1, -r/h */
    for (int d = 0; d < t->dim; d++) {
      test[d + 1] = t->h * row->VF[k] * row->r[d][k];
      basis[d + 1] = -row->r[d][k] / t->h;
    }
    for (int a = 0; a < n; a++) {
      x[a] += test[a] * t->f[row->j[k]];
      for (int b = 0; b < n; b++) A[a * n + b] += test[a] * basis[b];
    }
  }
  return sph_operator_solve(n, A, 1, x);
}

static int cspm(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  double x[4] = {0};
  if (rung == 0 && solve(t, row, x)) return 1;
  if (rung > 0) {
    for (int d = 0; d <= t->dim; d++) x[d] = 0;
    if (sph_operator_shepard_row(row, t->f, x) && rung == 1) return 1;
  }
  t->value[row->i] = x[0];
  for (int d = 0; t->gradient && d < t->dim; d++) t->gradient[d][row->i] = x[d + 1] / t->h;
  return 0;
}

int sph_operator_cspm(sph_operator *op, const double *f, double *value, double *const gradient[],
                      sph_error *error)
{
  static const char name[] = "cspm";
  int status = sph_operator_check(op, name, 0, error);
  if (!status) status = sph_operator_need(name, "f", 1, &f, error);
  if (!status) status = sph_operator_need(name, "value", 1, SPH_WRITTEN(&value), error);
  if (!status && gradient)
    status = sph_operator_need(name, "gradient", op->def.dim, SPH_WRITTEN(gradient), error);
  if (status) return status;
  const task t = {op->def.dim, op->def.h, f, value, gradient};
  return sph_operator_each(op, name, cspm, &t, 3, error);
}
