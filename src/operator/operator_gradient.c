/* grad f_i = sum_j V_j s_ij grad_i W_ij,  grad_i W_ij = r_ij F_ij,  with s_ij
 *
 *   plain       f_j
 *   difference  f_j - f_i
 *   density     (rho_j/rho_i) (f_j - f_i)
 *   symmetric   (rho_j/rho_i) f_i + (rho_i/rho_j) f_j
 *   plus        f_i + f_j
 *   corrected   f_j - f_i, and M_i^-1 before the sum (Randles & Libersky 1996; Bonet & Lok 1999)
 *
 * Of these, symmetric and plus add up to zero over all pairs, difference and density are exact for
 * constants, corrected is for linear fields. */
#include "operator_gradient.h"

#include <stdio.h>
#include <string.h>

#include "words.h"

enum { PLAIN, DIFFERENCE, DENSITY, SYMMETRIC, PLUS, CORRECTED, FORMS };
static const char *const forms[FORMS] = {"plain",     "difference", "density",
                                         "symmetric", "plus",       "corrected"};

const char *sph_operator_gradient_form(int k) { return k >= 0 && k < FORMS ? forms[k] : NULL; }

typedef struct task {
  int dim, form;
  const double *rho; /* NULL: 1 */
  const sph_gradient_call *call;
} task;

void sph_operator_gradient_matrix(int dim, const sph_row *row, double M[9])
{
  memset(M, 0, 9 * sizeof *M);
  for (long k = 0; k < row->n; k++)
    for (int a = 0; a < dim; a++)
      for (int b = 0; b < dim; b++) M[a * dim + b] -= row->VF[k] * row->r[a][k] * row->r[b][k];
}

/* s_ij of a field f at the k-th point of the row. */
static inline double jump(const task *t, const double *f, const sph_row *row, long k)
{
  const long i = row->i, j = row->j[k];
  const double ratio = t->rho ? t->rho[j] / t->rho[i] : 1;
  switch (t->form) {
  case PLAIN: return f[j];
  case DENSITY: return ratio * (f[j] - f[i]);
  case SYMMETRIC: return ratio * f[i] + f[j] / ratio;
  case PLUS: return f[i] + f[j];
  default: return f[j] - f[i];
  }
}

static void sum_gradient(const task *t, const double *f, const sph_row *row, double *gradient)
{
  for (int d = 0; d < t->dim; d++) gradient[d] = 0;
  for (long k = 0; k < row->n; k++) {
    const double VFs = row->VF[k] * jump(t, f, row, k);
    for (int d = 0; d < t->dim; d++) gradient[d] += VFs * row->r[d][k];
  }
}

static int gradient(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const sph_gradient_call *call = t->call;
  double sums[9], M[9], G[3][3];
  for (int c = 0; c < call->components; c++)
    sum_gradient(t, call->f[c], row, sums + (long)c * t->dim);
  if (t->form == CORRECTED && rung == 0) {
    sph_operator_gradient_matrix(t->dim, row, M);
    if (sph_operator_solve(t->dim, M, call->components, sums)) return 1;
  }
  for (int c = 0; c < call->components; c++)
    for (int d = 0; d < t->dim; d++) G[c][d] = sums[c * t->dim + d];
  call->use(t->dim, (const double(*)[3])G, row->i, call->out);
  return 0;
}

int sph_operator_gradient_corrected(int dim, const sph_row *row, const double *f, double *gradient)
{
  double M[9];
  const task t = {dim, CORRECTED, NULL, NULL};
  sum_gradient(&t, f, row, gradient);
  sph_operator_gradient_matrix(dim, row, M);
  return sph_operator_solve(dim, M, 1, gradient);
}

/* Number of a form; -1: unknown, recorded. */
static int find(const char *form, const char *what, sph_error *error)
{
  sph_words words = {.wanted = form ? form : ""};
  for (int k = 0; k < FORMS; k++) {
    if (form && !strcmp(form, forms[k])) return k;
    sph_words_add(&words, forms[k]);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "%s: form \"%s\"; %sknown: %s", what, words.wanted,
                words.nearest, words.known);
  return -1;
}

int sph_operator_gradient_call(sph_operator *op, const sph_gradient_call *call, sph_error *error)
{
  const int form = find(call->form, call->what, error);
  if (form < 0) return SPH_ERR_ARGUMENT;
  char name[80];
  snprintf(name, sizeof name, "%s \"%s\"", call->what, call->form);
  int status = sph_operator_check(op, name, form != PLAIN, error);
  if (!status) status = sph_operator_need(name, call->field, call->components, call->f, error);
  if (!status)
    status = sph_operator_need(name, call->result, call->results, SPH_WRITTEN(call->out), error);
  if (!op || status) return status;
  const task t = {op->def.dim, form, op->rho, call};
  return sph_operator_each(op, name, gradient, &t, form == CORRECTED ? 2 : 1, error);
}

/* out[component dim + direction] */
static void keep(int dim, const double G[][3], long i, double *const out[])
{
  for (int d = 0; d < dim; d++) out[d][i] = G[0][d];
}

static void keep_vector(int dim, const double G[][3], long i, double *const out[])
{
  for (int a = 0; a < dim; a++)
    for (int b = 0; b < dim; b++) out[a * dim + b][i] = G[a][b];
}

int sph_operator_gradient(sph_operator *op, const char *form, const double *f,
                          double *const gradient[], sph_error *error)
{
  const int dim = op ? op->def.dim : 1;
  return sph_operator_gradient_call(op,
                                    &(sph_gradient_call){"gradient", form, "f", "gradient", 1, dim,
                                                         &f, gradient, keep},
                                    error);
}

int sph_operator_gradient_vector(sph_operator *op, const char *form, const double *const u[],
                                 double *const gradient[], sph_error *error)
{
  const int dim = op ? op->def.dim : 1;
  return sph_operator_gradient_call(op,
                                    &(sph_gradient_call){"gradient of a vector", form, "u",
                                                         "gradient", dim, dim * dim, u, gradient,
                                                         keep_vector},
                                    error);
}
