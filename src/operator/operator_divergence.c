/* div u = du^a/dx^a, of a tensor ds^ab/dx^b, by any form of the gradient (operator_gradient.c). */
#include "operator_gradient.h"

static void trace(int dim, const double G[][3], long i, double *const out[])
{
  double sum = 0;
  for (int a = 0; a < dim; a++) sum += G[a][a];
  out[0][i] = sum;
}

int sph_operator_divergence(sph_operator *op, const char *form, const double *const u[],
                            double *divergence, sph_error *error)
{
  const int dim = op ? op->def.dim : 1;
  return sph_operator_gradient_call(op,
                                    &(sph_gradient_call){"divergence", form, "u", "divergence", dim,
                                                         1, u, &divergence, trace},
                                    error);
}

int sph_operator_divergence_tensor(sph_operator *op, const char *form, const double *const s[],
                                   double *const divergence[], sph_error *error)
{
  static const char what[] = "divergence of a tensor";
  const int dim = op ? op->def.dim : 1;
  int status = sph_operator_need(what, "s", dim * dim, s, error);
  if (!status) status = sph_operator_need(what, "divergence", dim, SPH_WRITTEN(divergence), error);
  for (int a = 0; !status && a < dim; a++)
    status =
        sph_operator_gradient_call(op,
                                   &(sph_gradient_call){what, form, "s", "divergence", dim, 1,
                                                        s + (long)a * dim, divergence + a, trace},
                                   error);
  return status;
}
