/* Eigenvalues of the Jacobian, by GSL: balanced, Hessenberg form, Francis' QR steps. */
#include <gsl/gsl_eigen.h>
#include <string.h>

#include "gsl.h"
#include "jacobian_data.h"
#include "memory.h"
#include "sim_weights.h"

/* number[r]: of row r in the full matrix, -1: left out.  Returns how many there are. */
static long choose(const jacobian *J, int frozen, long *number)
{
  const sph_layout *layout = &J->sim->layout;
  long n = 0, row = 0;
  for (int k = 0; k < layout->segments; k++) {
    int out = frozen && layout->segment[k].role == SPH_ROLE_POSITION;
    for (long i = 0; i < layout->segment[k].n; i++) number[row++] = out ? -1 : n++;
  }
  return n;
}

/* Every field in units of its scale: entries of similar size. */
static int fill(const jacobian *J, const long *number, gsl_matrix *A)
{
  N_Vector weight = sph_nvector_clone(J->sim->y, "weights", &J->sim->error);
  if (!weight) return SPH_ERR_MEMORY;
  int status = sph_sim_weights(J->sim->y, weight, J->sim);
  const double *w = sph_nvector_data(weight);
  for (long r = 0; !status && r < J->open.n; r++)
    for (long e = J->first[r]; e < J->first[r + 1]; e++) {
      const long c = J->column[e];
      if (number[r] < 0 || number[c] < 0) continue;
      gsl_matrix_set(A, (size_t)number[r], (size_t)number[c],
                     J->value[e] * w[J->place[r]] / w[J->place[c]]);
    }
  N_VDestroy(weight);
  return status;
}

static int solve(sph_sim *sim, gsl_matrix *A, double *re, double *im)
{
  const size_t n = A->size1;
  sph_gsl_begin();
  gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(n);
  gsl_vector_complex *lambda = gsl_vector_complex_alloc(n);
  int bad = -1;
  if (work && lambda) {
    gsl_eigen_nonsymm_params(0, 1, work);
    bad = gsl_eigen_nonsymm(A, lambda, work);
    for (size_t k = 0; k < n; k++) {
      re[k] = GSL_REAL(gsl_vector_complex_get(lambda, k));
      im[k] = GSL_IMAG(gsl_vector_complex_get(lambda, k));
    }
  }
  if (work) gsl_eigen_nonsymm_free(work);
  if (lambda) gsl_vector_complex_free(lambda);
  sph_gsl_end();
  if (bad < 0) return sph_sim_fail(sim, SPH_ERR_MEMORY, "out of memory: eigenvalues");
  return bad ? sph_sim_fail(sim, SPH_ERR_STEP, "eigenvalues: the QR steps do not converge")
             : SPH_OK;
}

long sph_jacobian_eigenvalues(const sph_jacobian *open, int frozen, double *re, double *im)
{
  const jacobian *J = (const jacobian *)open;
  if (!J || !sph_sim_data_ok(J->sim)) return J ? sph_sim_status(J->sim) : SPH_ERR_ARGUMENT;
  sph_sim *sim = J->sim;
  if (!J->value)
    return sph_sim_fail(sim, SPH_ERR_STATE, "eigenvalues: call sph_jacobian_evaluate first");
  long *number = SPH_NEW(long, J->open.n, "numbers of rows", &sim->error);
  if (!number) return SPH_ERR_MEMORY;
  const long n = choose(J, frozen, number);
  double *full = NULL;
  if (n > SPH_EIGENVALUES_MAX)
    sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                 "eigenvalues: %ld entries of the state; at most %d: choose a larger spacing", n,
                 SPH_EIGENVALUES_MAX);
  else
    full = SPH_NEW(double, n *n, "a full matrix", &sim->error);
  int status = sim->error.status;
  if (!status) {
    gsl_matrix_view A = gsl_matrix_view_array(full, (size_t)n, (size_t)n);
    status = fill(J, number, &A.matrix);
    if (!status) status = solve(sim, &A.matrix, re, im);
  }
  sph_memory_free(full);
  sph_memory_free(number);
  return status ? status : n;
}
