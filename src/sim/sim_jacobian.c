/* Products with the Jacobian and its transpose as SUNDIALS wants them. */
#include "sim_transposed.h"

int sph_sim_jacobian_times(N_Vector v, N_Vector Jv, double t, N_Vector y, N_Vector fy, void *ctx,
                           N_Vector tmp)
{
  (void)fy, (void)tmp;
  return sph_sim_tangent(ctx, SPH_WHOLE, t, sph_nvector_data(y), sph_nvector_data(v), NULL, 0,
                         sph_nvector_data(Jv));
}

int sph_sim_jacobian_transposed_times(N_Vector w, N_Vector Jw, double t, N_Vector y, N_Vector fy,
                                      void *ctx, N_Vector tmp)
{
  (void)fy, (void)tmp;
  return sph_sim_transposed(ctx, SPH_WHOLE, t, sph_nvector_data(y), sph_nvector_data(w), NULL, 0,
                            sph_nvector_data(Jw));
}
