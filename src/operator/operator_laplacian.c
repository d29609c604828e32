/* div(k grad f), second derivatives through F_ij = (dW/dr)/r, never through lap W:
 *
 *   arithmetic      sum_j V_j (k_i + k_j) (f_i - f_j) F_ij               (Brookshaw 1985)
 *   harmonic        sum_j V_j 4 k_i k_j/(k_i + k_j) (f_i - f_j) F_ij     (Cleary & Monaghan 1999)
 *   corrected       2 sum_j V_j (f_i - f_j - r_ij . g_i) F_ij            g: corrected gradient
 *   fatehi-manzari  2 sum_j V_j (f_i - f_j - r_ij . g_i) (r_ij . B_i r_ij/r^2) F_ij
 *
 * B_i symmetric such that the last is exact for quadratic f (Fatehi & Manzari 2011): for c <= d
 *
 *   B^ef (sum_j V_j F_ij r^c r^d r^e r^f/r^2 + T^cda sum_j V_j F_ij r^a r^e r^f/r^2) = -delta^cd,
 *   T^cda = (M_i^-1)^ab sum_j V_j F_ij r^c r^d r^b,
 *
 * since for f = x.Hx/2 the bracket is -(r.Hr + H^cd T^cda r^a)/2.  The first two are symmetric in i
 * and j: they conserve and dissipate; on disordered points they are not consistent.  Where F is
 * singular it is F r^2/(r^2 + 0.01 h^2) in the first three. */
#include <stdio.h>
#include <string.h>

#include "operator_gradient.h"
#include "words.h"

enum { ARITHMETIC, HARMONIC, CORRECTED, FATEHI, FORMS };
enum { PAIRS = 6 }; /* c <= d in 3D */
static const char *const forms[FORMS] = {"arithmetic", "harmonic", "corrected", "fatehi-manzari"};

const char *sph_operator_laplacian_form(int k) { return k >= 0 && k < FORMS ? forms[k] : NULL; }

typedef struct task {
  int dim, form;
  double eta2;         /* 0.01 h^2 where F is singular, else 0 [m^2] */
  const double *k, *f; /* k NULL: 1 */
  double *laplacian;
} task;

/* r^2/(r^2 + eta^2), or 1. */
static inline double soften(const task *t, double r2)
{
  return t->eta2 > 0 ? r2 / (r2 + t->eta2) : 1;
}

static inline double conductivity(const task *t, int form, long i, long j)
{
  if (!t->k) return 2;
  const double sum = t->k[i] + t->k[j];
  if (form == ARITHMETIC) return sum;
  return sum > 0 ? 4 * t->k[i] * t->k[j] / sum : 0;
}

static double brookshaw(const task *t, int form, const sph_row *row)
{
  const long i = row->i;
  double sum = 0;
  for (long k = 0; k < row->n; k++) {
    const long j = row->j[k];
    sum += conductivity(t, form, i, j) * (t->f[i] - t->f[j]) * soften(t, row->r2[k]) * row->VF[k];
  }
  return sum;
}

/* f_i - f_j - r_ij . g */
static inline double beyond_linear(const task *t, const sph_row *row, long k, const double *g)
{
  double jump = t->f[row->i] - t->f[row->j[k]];
  for (int d = 0; d < t->dim; d++) jump -= row->r[d][k] * g[d];
  return jump;
}

static double subtracted(const task *t, const sph_row *row, const double *g)
{
  double sum = 0;
  for (long k = 0; k < row->n; k++)
    sum += 2 * beyond_linear(t, row, k, g) * soften(t, row->r2[k]) * row->VF[k];
  return sum;
}

/* The products r^c r^d, c <= d, of the k-th point. */
static int products(int dim, const sph_row *row, long k, double *rr)
{
  int n = 0;
  for (int c = 0; c < dim; c++)
    for (int d = c; d < dim; d++) rr[n++] = row->r[c][k] * row->r[d][k];
  return n;
}

/* B^ef, e <= f, counted twice where e < f; 1: singular. */
static int fatehi_matrix(int dim, const sph_row *row, double *B)
{
  double rr[PAIRS], four[PAIRS][PAIRS] = {{0}}, T[PAIRS][3] = {{0}}, E[3][PAIRS] = {{0}};
  int n = 0;
  for (long k = 0; k < row->n; k++) {
    n = products(dim, row, k, rr);
    if (!(row->r2[k] > 0)) continue;
    for (int p = 0; p < n; p++) {
      const double VFp = row->VF[k] * rr[p];
      for (int q = 0; q < n; q++) four[p][q] += VFp * rr[q] / row->r2[k];
      for (int a = 0; a < dim; a++) {
        T[p][a] += VFp * row->r[a][k];
        E[a][p] += VFp * row->r[a][k] / row->r2[k];
      }
    }
  }
  double M[9], third[PAIRS * 3], A[PAIRS * PAIRS];
  sph_operator_gradient_matrix(dim, row, M);
  for (int p = 0; p < n; p++)
    for (int a = 0; a < dim; a++) third[p * dim + a] = T[p][a];
  if (n == 0 || sph_operator_solve(dim, M, n, third)) return 1;
  for (int p = 0; p < n; p++)
    for (int q = 0; q < n; q++) {
      A[p * n + q] = four[p][q];
      for (int a = 0; a < dim; a++) A[p * n + q] += third[p * dim + a] * E[a][q];
    }
  for (int c = 0, p = 0; c < dim; c++)
    for (int d = c; d < dim; d++) B[p++] = c == d ? -1 : 0;
  return sph_operator_solve(n, A, 1, B);
}

static double fatehi(const task *t, const sph_row *row, const double *g, const double *B)
{
  double sum = 0, rr[PAIRS];
  for (long k = 0; k < row->n; k++) {
    const int n = products(t->dim, row, k, rr);
    double rBr = 0;
    for (int p = 0; p < n; p++) rBr += B[p] * rr[p];
    if (row->r2[k] > 0) sum += 2 * beyond_linear(t, row, k, g) * rBr / row->r2[k] * row->VF[k];
  }
  return sum;
}

static int laplacian(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const int form = t->form > HARMONIC && t->form - rung < CORRECTED ? ARITHMETIC : t->form - rung;
  double g[3], B[PAIRS];
  double *out = &t->laplacian[row->i];
  if (form >= CORRECTED && sph_operator_gradient_corrected(t->dim, row, t->f, g)) return 1;
  if (form == FATEHI && fatehi_matrix(t->dim, row, B)) return 1;
  if (form == FATEHI) *out = fatehi(t, row, g, B);
  if (form == CORRECTED) *out = subtracted(t, row, g);
  if (form < CORRECTED) *out = brookshaw(t, form, row);
  return 0;
}

/* Number of a form; -1: unknown, recorded. */
static int find(const char *form, sph_error *error)
{
  sph_words words = {.wanted = form ? form : ""};
  for (int k = 0; k < FORMS; k++) {
    if (form && !strcmp(form, forms[k])) return k;
    sph_words_add(&words, forms[k]);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "laplacian: form \"%s\"; %sknown: %s", words.wanted,
                words.nearest, words.known);
  return -1;
}

static int check_k(const sph_operator *op, int form, const double *k, const char *name,
                   sph_error *error)
{
  if (!k) return SPH_OK;
  if (form > HARMONIC)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "%s: takes no k; right is NULL, or \"arithmetic\" or \"harmonic\"", name);
  for (long i = 0; i < op->points.n; i++)
    if (!(k[i] >= 0))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: k of point %ld is %g; right is >= 0", name,
                           i, k[i]);
  return SPH_OK;
}

int sph_operator_laplacian(sph_operator *op, const char *form_name, const double *k,
                           const double *f, double *out, sph_error *error)
{
  const int form = find(form_name, error);
  if (form < 0) return SPH_ERR_ARGUMENT;
  char name[60];
  snprintf(name, sizeof name, "laplacian \"%s\"", forms[form]);
  int status = sph_operator_check(op, name, 1, error);
  if (!status) status = sph_operator_need(name, "f", 1, &f, error);
  if (!status) status = sph_operator_need(name, "laplacian", 1, SPH_WRITTEN(&out), error);
  if (!status) status = check_k(op, form, k, name, error);
  if (status) return status;
  const double h = op->def.h;
  const task t = {op->def.dim, form, kernel_shape_singular(op->number) ? 0.01 * h * h : 0,
                  k,           f,    out};
  return sph_operator_each(op, name, laplacian, &t, form > HARMONIC ? form : 1, error);
}
