/* A fluid with dust in it, drag K (Laibe & Price 2011, 2012), each with its own uniform density.
 *
 *   box    both stream uniformly; u: internal energy of the fluid, which all heat goes to
 *
 *     v_f = v - rho_d/rho dv e^(-t/t_s),  v_d = v + rho_f/rho dv e^(-t/t_s),
 *     dv = v_d - v_f at the start,  rho = rho_f + rho_d,  t_s = rho_f rho_d/(K rho),
 *     v: the mean velocity by mass
 *     u = u_0 + rho_d/(2 rho) dv^2 (1 - e^(-2t/t_s))
 *
 *   wave   sound of small amplitude e, at the start as it would run in the fluid alone, in both:
 *          density rho_0 [1 + e cos(kx)], velocity e c cos(kx).  With w = c k and the complex
 *          amplitudes D_f, D_d of density over -i rho_0/c, V_f, V_d of velocity, for e^(ikx):
 *
 *     D_f' = w V_f,  V_f' = -w D_f - K/rho_f (V_f - V_d)
 *     D_d' = w V_d,  V_d' = K/rho_d (V_f - V_d)
 *
 *   of which the solution is the exponential of a real matrix. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>

#include "exact.h"
#include "gsl.h"

static int check(const char *what, double K, double rho_fluid, double rho_dust, double t,
                 sph_error *error)
{
  if (K >= 0 && isfinite(K) && rho_fluid > 0 && isfinite(rho_fluid) && rho_dust > 0 &&
      isfinite(rho_dust) && t >= 0 && isfinite(t))
    return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "dusty %s: K = %g kg/m^3/s, densities %g and %g kg/m^3, t = %g s must be "
                       "finite, with K >= 0, densities > 0, t >= 0",
                       what, K, rho_fluid, rho_dust, t);
}

int sph_exact_dusty_box_at(const sph_exact_dusty_box *box, double t, sph_exact_streams *streams,
                           sph_error *error)
{
  const sph_exact_stream *f = &box->fluid, *d = &box->dust;
  int status = check("box", box->K, f->rho, d->rho, t, error);
  if (status) return status;
  double rho = f->rho + d->rho, rate = box->K * rho / (f->rho * d->rho), dv = d->v - f->v;
  double mean = (f->rho * f->v + d->rho * d->v) / rho;
  streams->fluid = mean - d->rho / rho * dv * exp(-rate * t);
  streams->dust = mean + f->rho / rho * dv * exp(-rate * t);
  streams->u = box->u - d->rho / (2 * rho) * dv * dv * expm1(-2 * rate * t);
  return SPH_OK;
}

/* exp(M t) of the equations above, for D_f, V_f, V_d, D_d. */
static int propagator(const sph_exact_dusty_wave *wave, double t, double P[16], sph_error *error)
{
  double w = wave->c * wave->k, f = wave->K / wave->rho_fluid, d = wave->K / wave->rho_dust;
  double M[16] = {0, w * t, 0, 0, -w * t, -f * t, f * t, 0, 0, d * t, -d * t, 0, 0, 0, w * t, 0};
  gsl_matrix_view from = gsl_matrix_view_array(M, 4, 4), to = gsl_matrix_view_array(P, 4, 4);
  sph_gsl_begin();
  int failed = gsl_linalg_exponential_ss(&from.matrix, &to.matrix, GSL_PREC_DOUBLE);
  sph_gsl_end();
  return failed ? sph_error_set(error, SPH_ERR_ARGUMENT, "dusty wave: no solution at t = %g s: %s",
                                t, gsl_strerror(failed))
                : SPH_OK;
}

int sph_exact_dusty_wave_at(const sph_exact_dusty_wave *wave, double t, int dust, long n,
                            const double *x, double *rho, double *v, sph_error *error)
{
  double P[16];
  const double e = wave->amplitude, c = wave->c, k = wave->k;
  int status = check("wave", wave->K, wave->rho_fluid, wave->rho_dust, t, error);
  if (!status && !(c > 0 && isfinite(c) && k > 0 && isfinite(k) && isfinite(e)))
    status = sph_error_set(error, SPH_ERR_ARGUMENT,
                           "dusty wave: c = %g m/s, k = %g 1/m, amplitude = %g must be finite, "
                           "with c > 0, k > 0",
                           c, k, e);
  if (!status) status = propagator(wave, t, P, error);
  if (status) return status;
  /* At the start the D are i e c, the V are e c: imaginary parts and real parts apart. */
  const double *D = P + (dust ? 12 : 0), *V = P + (dust ? 8 : 4);
  const double rho0 = dust ? wave->rho_dust : wave->rho_fluid;
  for (long i = 0; i < n; i++) {
    double C = e * cos(k * x[i]), S = e * sin(k * x[i]);
    if (rho) rho[i] = rho0 * (1 + (D[0] + D[3]) * C + (D[1] + D[2]) * S);
    if (v) v[i] = c * ((V[1] + V[2]) * C - (V[0] + V[3]) * S);
  }
  return SPH_OK;
}
