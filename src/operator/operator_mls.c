/* Moving least squares (Lancaster & Salkauskas 1981; Colagrossi & Landrini 2003): the polynomial
 * a . p(x_j - x_i) that makes sum_j V_j W_ij (a . p - f_j)^2 least,
 *
 *   A a = sum_j V_j W_ij p f_j,   A = sum_j V_j W_ij p p^T,   p = (1, s, s^a s^b/2^(a = b)),
 *
 * s = (x_j - x_i)/h; a holds the value, h times the gradient, h^2 times the second derivatives.
 * V_j belongs there: without it, crowded places count more. */
#include "operator_data.h"

typedef struct task {
  int dim, order;
  double h;
  const double *f;
  double *value;
  double *const *gradient, *const *hessian; /* or NULL */
} task;

/* p; returns how many there are. */
static int basis(int dim, int order, const double *s, double *p)
{
  int n = 0;
  p[n++] = 1;
  for (int a = 0; order > 0 && a < dim; a++) p[n++] = s[a];
  for (int a = 0; order > 1 && a < dim; a++)
    for (int b = a; b < dim; b++) p[n++] = s[a] * s[b] * (a == b ? 0.5 : 1);
  return n;
}

/* The polynomial of that order; 1: A is singular. */
static int fit(const task *t, int order, const sph_row *row, double *a)
{
  double A[SPH_MOMENTS * SPH_MOMENTS] = {0}, p[SPH_MOMENTS], s[3] = {0};
  const int n = basis(t->dim, order, s, p);
  for (long k = 0; k < row->n; k++) {
    for (int d = 0; d < t->dim; d++) s[d] = -row->r[d][k] / t->h;
    basis(t->dim, order, s, p);
    for (int r = 0; r < n; r++) {
      const double weight = row->VW[k] * p[r];
      a[r] += weight * t->f[row->j[k]];
      for (int c = 0; c <= r; c++) A[r * n + c] += weight * p[c];
    }
  }
  for (int r = 0; r < n; r++)
    for (int c = 0; c < r; c++) A[c * n + r] = A[r * n + c];
  return sph_operator_solve(n, A, 1, a);
}

static int mls(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const int dim = t->dim, order = t->order - rung;
  double a[SPH_MOMENTS] = {0};
  if (order > 0 && fit(t, order, row, a)) return 1;
  if (order <= 0 && sph_operator_shepard_row(row, t->f, a) && order == 0) return 1;
  if (t->value) t->value[row->i] = a[0];
  for (int d = 0; t->gradient && d < dim; d++) t->gradient[d][row->i] = a[1 + d] / t->h;
  for (int d = 0; t->hessian && d < dim * (dim + 1) / 2; d++)
    t->hessian[d][row->i] = a[1 + dim + d] / (t->h * t->h);
  return 0;
}

int sph_operator_mls(sph_operator *op, int order, const double *f, double *value,
                     double *const gradient[], double *const hessian[], sph_error *error)
{
  static const char *const names[] = {"mls of order 1", "mls of order 2"};
  if (order < 1 || order > 2)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "mls: order = %d; right is 1 or 2", order);
  if (order == 1 && hessian)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "mls: order = 1 has no second derivatives; right is 2");
  const char *name = names[order - 1];
  int status = sph_operator_check(op, name, 0, error);
  if (status) return status;
  const int dim = op->def.dim;
  const task t = {dim, order, op->def.h, f, value, gradient, hessian};
  status = sph_operator_need(name, "f", 1, &f, error);
  if (!status && gradient)
    status = sph_operator_need(name, "gradient", dim, SPH_WRITTEN(gradient), error);
  if (!status && hessian)
    status = sph_operator_need(name, "hessian", dim * (dim + 1) / 2, SPH_WRITTEN(hessian), error);
  return status ? status : sph_operator_each(op, name, mls, &t, order + 2, error);
}
