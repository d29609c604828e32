/* Which points are at the end of a body of points, and where it ends:
 *
 *   divergence  div x = -sum_j V_j r_ij . grad_i W_ij = tr M_i is d inside (Lee et al. 2008)
 *   cone        the least eigenvalue of M_i is 1 inside, 0 where nobody is near.  Between 0.2 and
 *               0.75 the point is at the surface unless a neighbour stands in the 45 degrees around
 *               its normal (Marrone et al. 2010, with L = kappa h/2 for their h)
 *
 * Normals: -sum_j V_j grad_i W_ij, with M_i^-1 before it where there is one, of length 1. */
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "operator_gradient.h"
#include "words.h"

enum { DIVERGENCE, CONE, METHODS };
static const char *const methods[METHODS] = {"divergence", "cone"};

static const double LEAST_DIVERGENCE[] = {0.75, 1.5, 2.4}; /* [dim - 1] */
static const double ALONE = 0.2, INSIDE = 0.75;            /* least eigenvalues */

const char *sph_operator_surface_method(int k) { return k >= 0 && k < METHODS ? methods[k] : NULL; }

typedef struct task {
  int dim, method;
  double L; /* [m] */
  int *state;
  double *measure, *const *normal; /* or NULL */
} task;

/* Of a symmetric matrix without negative ones, whose singular values they are. */
static double least_eigenvalue(int dim, double *M)
{
  double vectors[9], values[3];
  const size_t n = (size_t)dim;
  gsl_matrix_view A = gsl_matrix_view_array(M, n, n), Q = gsl_matrix_view_array(vectors, n, n);
  gsl_vector_view S = gsl_vector_view_array(values, n);
  gsl_linalg_SV_decomp_jacobi(&A.matrix, &Q.matrix, &S.vector);
  return values[dim - 1];
}

static void find_normal(int dim, const sph_row *row, double *normal)
{
  double M[9], corrected[3] = {0}, length = 0;
  for (long k = 0; k < row->n; k++)
    for (int d = 0; d < dim; d++) corrected[d] -= row->VF[k] * row->r[d][k];
  memcpy(normal, corrected, sizeof corrected);
  sph_operator_gradient_matrix(dim, row, M);
  if (!sph_operator_solve(dim, M, 1, corrected)) memcpy(normal, corrected, sizeof corrected);
  for (int d = 0; d < dim; d++) length += normal[d] * normal[d];
  for (int d = 0; d < dim; d++) normal[d] = length > 0 ? normal[d] / sqrt(length) : 0;
}

/* Does a neighbour cover the point: in the cone at least sqrt(2) L away, or in the umbrella whose
 * tip is the point and whose top is T = x + L n? */
static int covered(const task *t, const sph_row *row, const double *normal)
{
  for (long k = 0; k < row->n; k++) {
    double along = 0, to_top = 0; /* (x_j - x_i).n, |x_j - T|^2 */
    for (int d = 0; d < t->dim; d++) {
      const double s = -row->r[d][k];
      along += s * normal[d];
      to_top += pow(s - t->L * normal[d], 2);
    }
    if (!(row->r2[k] > 0)) continue;
    if (row->r2[k] >= 2 * t->L * t->L && to_top < t->L * t->L) return 1;
    if (row->r2[k] < 2 * t->L * t->L && along > sqrt(row->r2[k] / 2)) return 1;
  }
  return 0;
}

static int surface(const void *what, const sph_row *row, int rung)
{
  const task *t = what;
  const int dim = t->dim;
  double M[9], normal[3] = {0}, measure = 0;
  int state;
  (void)rung;
  sph_operator_gradient_matrix(dim, row, M);
  find_normal(dim, row, normal);
  if (t->method == DIVERGENCE) {
    for (int d = 0; d < dim; d++) measure += M[d * dim + d];
    state = measure < LEAST_DIVERGENCE[dim - 1] ? SPH_SURFACE : SPH_INSIDE;
  } else {
    measure = least_eigenvalue(dim, M);
    state = measure < ALONE ? SPH_ALONE : measure > INSIDE ? SPH_INSIDE : SPH_SURFACE;
    if (state == SPH_SURFACE && covered(t, row, normal)) state = SPH_INSIDE;
  }
  t->state[row->i] = state;
  if (t->measure) t->measure[row->i] = measure;
  for (int d = 0; t->normal && d < dim; d++) t->normal[d][row->i] = normal[d];
  return 0;
}

int sph_operator_surface(sph_operator *op, const char *method, int *state, double *measure,
                         double *const normal[], sph_error *error)
{
  static const char name[] = "surface";
  sph_words words = {.wanted = method ? method : ""};
  int found = -1;
  for (int k = 0; k < METHODS; k++) {
    sph_words_add(&words, methods[k]);
    if (method && !strcmp(method, methods[k])) found = k;
  }
  if (found < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "surface: method \"%s\"; %sknown: %s",
                         words.wanted, words.nearest, words.known);
  int status = sph_operator_check(op, name, 1, error);
  if (!status && !state)
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "surface: state is NULL; right is [n]");
  if (!status && normal)
    status = sph_operator_need(name, "normal", op->def.dim, SPH_WRITTEN(normal), error);
  if (status) return status;
  const double L = sph_kernel_support(op->kernel) * op->def.h / 2;
  const task t = {op->def.dim, found, L, state, measure, normal};
  return sph_operator_each(op, name, surface, &t, 1, error);
}
