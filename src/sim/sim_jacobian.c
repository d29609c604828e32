/* Products with the Jacobian and its transpose as SUNDIALS wants them. */
#include "sim_transposed.h"

static int times(sph_sim *sim, int part, N_Vector v, N_Vector Jv, double t, N_Vector y)
{
  int status = sph_sim_rhs_vectors(sim, y, v);
  if (!status) status = sph_sim_rhs_vectors(sim, y, Jv);
  if (!status)
    status = sph_sim_tangent(sim, part, t, sph_nvector_data(y), sph_nvector_data(v), NULL, 0,
                             sph_nvector_data(Jv));
  sim->derived = 0; /* pressure etc. are those of y */
  return status;
}

int sph_sim_jacobian_times(N_Vector v, N_Vector Jv, double t, N_Vector y, N_Vector fy, void *ctx,
                           N_Vector tmp)
{
  (void)fy, (void)tmp;
  return times(ctx, SPH_WHOLE, v, Jv, t, y);
}

int sph_sim_jacobian_times_implicit(N_Vector v, N_Vector Jv, double t, N_Vector y, N_Vector fy,
                                    void *ctx, N_Vector tmp)
{
  (void)fy, (void)tmp;
  return times(ctx, SPH_PIECE_IMPLICIT, v, Jv, t, y);
}

int sph_sim_jacobian_transposed_times(N_Vector w, N_Vector Jw, double t, N_Vector y, N_Vector fy,
                                      void *ctx, N_Vector tmp)
{
  sph_sim *sim = ctx;
  (void)fy, (void)tmp;
  int status = sph_sim_rhs_vectors(sim, y, w);
  if (!status) status = sph_sim_rhs_vectors(sim, y, Jw);
  if (!status)
    status = sph_sim_transposed(sim, SPH_WHOLE, t, sph_nvector_data(y), sph_nvector_data(w), NULL,
                                0, sph_nvector_data(Jw));
  sim->derived = 0;
  return status;
}
