/* curl u = (du^z/dy - du^y/dz, du^x/dz - du^z/dx, du^y/dx - du^x/dy), in 2D the last alone, by any
 * form of the gradient (operator_gradient.c).  A rigid rotation omega has 2 omega. */
#include "operator_gradient.h"

static void antisymmetric(int dim, const double G[][3], long i, double *const out[])
{
  if (dim == 2) {
    out[0][i] = G[1][0] - G[0][1];
    return;
  }
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    out[a][i] = G[c][b] - G[b][c];
  }
}

int sph_operator_curl(sph_operator *op, const char *form, const double *const u[],
                      double *const curl[], sph_error *error)
{
  const int dim = op ? op->def.dim : 2;
  if (dim == 1) return sph_error_set(error, SPH_ERR_ARGUMENT, "curl: dim = 1; right is 2 or 3");
  return sph_operator_gradient_call(op,
                                    &(sph_gradient_call){"curl", form, "u", "curl", dim,
                                                         dim == 2 ? 1 : 3, u, curl, antisymmetric},
                                    error);
}
