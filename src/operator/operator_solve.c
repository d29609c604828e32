/* Small dense systems, by GSL: QR with column pivoting, whose last pivot tells a singular matrix.
 * These functions of GSL allocate nothing, and for sizes that fit meet no error. */
#include <gsl/gsl_linalg.h>
#include <math.h>

#include "operator_data.h"

static const double LEAST_PIVOT = 1e-10; /* over the first */

int sph_operator_solve(int n, double *A, int columns, double *b)
{
  double tau_of[SPH_MOMENTS], norm_of[SPH_MOMENTS];
  size_t place[SPH_MOMENTS];
  const size_t size = (size_t)n;
  gsl_matrix_view QR = gsl_matrix_view_array(A, size, size);
  gsl_vector_view tau = gsl_vector_view_array(tau_of, size);
  gsl_vector_view norm = gsl_vector_view_array(norm_of, size);
  gsl_permutation p = {size, place};
  int sign;
  gsl_linalg_QRPT_decomp(&QR.matrix, &tau.vector, &p, &sign, &norm.vector);
  if (!(fabs(A[n * n - 1]) > LEAST_PIVOT * fabs(A[0]))) return 1;
  for (int c = 0; c < columns; c++) {
    gsl_vector_view x = gsl_vector_view_array(b + (long)c * n, size);
    gsl_linalg_QRPT_svx(&QR.matrix, &tau.vector, &p, &x.vector);
  }
  return 0;
}
