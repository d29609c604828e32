/* Exact solution of the Riemann problem (Toro 2009, chapter 4): a left and a right wave, each a
 * shock or a rarefaction, and a contact between them.  For a side k with c_k^2 = gamma p_k/rho_k,
 *
 *   f_k(p) = (p - p_k) sqrt(A_k/(p + B_k)),  A_k = 2/((gamma+1) rho_k),
 *            B_k = p_k (gamma-1)/(gamma+1)                              p > p_k, shock
 *   f_k(p) = 2 c_k/(gamma-1) [(p/p_k)^((gamma-1)/(2 gamma)) - 1]        p <= p_k, rarefaction
 *
 *   f_left(p*) + f_right(p*) + u_right - u_left = 0,  u* = u_k -+ f_k(p*)
 *
 * The left side is written as the mirror image of the right one (u -> -u). */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_math.h>
#include <gsl/gsl_roots.h>
#include <stddef.h>

#include "exact.h"
#include "gsl.h"

static double sound_speed(double gamma, const sph_exact_gas *k)
{
  return sqrt(gamma * k->p / k->rho);
}

/* Velocity jump across the wave that takes side k to pressure p. */
static double jump(double gamma, const sph_exact_gas *k, double p)
{
  if (p > k->p) {
    double A = 2 / ((gamma + 1) * k->rho), B = k->p * (gamma - 1) / (gamma + 1);
    return (p - k->p) * sqrt(A / (p + B));
  }
  double exponent = (gamma - 1) / (2 * gamma);
  return 2 * sound_speed(gamma, k) / (gamma - 1) * (pow(p / k->p, exponent) - 1);
}

static double mismatch(double p, void *context)
{
  const sph_exact_riemann *r = context;
  return jump(r->gamma, &r->left, p) + jump(r->gamma, &r->right, p) + r->right.u - r->left.u;
}

/* The mismatch rises with p, is negative at 0 (no vacuum), and positive for p large enough. */
static int star_pressure(sph_exact_riemann *r)
{
  double lower = 0, upper = GSL_MAX_DBL(r->left.p, r->right.p);
  while (mismatch(upper, r) < 0 && isfinite(upper)) lower = upper, upper *= 4;
  gsl_function function = {mismatch, r};
  sph_gsl_begin();
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  int status = solver ? gsl_root_fsolver_set(solver, &function, lower, upper) : GSL_ENOMEM;
  for (int k = 0; !status && k < 1000; k++) {
    status = gsl_root_fsolver_iterate(solver);
    lower = gsl_root_fsolver_x_lower(solver), upper = gsl_root_fsolver_x_upper(solver);
    if (mismatch(gsl_root_fsolver_root(solver), r) == 0) break;
    if (upper - lower <= 4 * GSL_DBL_EPSILON * upper) break;
  }
  if (!status) r->p = gsl_root_fsolver_root(solver);
  if (solver) gsl_root_fsolver_free(solver);
  sph_gsl_end();
  return status;
}

/* Density behind the wave, and speeds of its head and tail for a wave running to the right. */
static double wave(double gamma, const sph_exact_gas *k, double u, double p_star, double u_star,
                   double *head, double *tail)
{
  double c = sound_speed(gamma, k), ratio = p_star / k->p, mu = (gamma - 1) / (gamma + 1);
  if (ratio > 1) {
    *head = *tail = u + c * sqrt((gamma + 1) / (2 * gamma) * ratio + (gamma - 1) / (2 * gamma));
    return k->rho * (ratio + mu) / (mu * ratio + 1);
  }
  *head = u + c;
  *tail = u_star + c * pow(ratio, (gamma - 1) / (2 * gamma));
  return k->rho * pow(ratio, 1 / gamma);
}

static int check(const sph_exact_riemann *r, sph_error *error)
{
  const sph_exact_gas *side[] = {&r->left, &r->right};
  if (!(r->gamma > 1 && isfinite(r->gamma)))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "Riemann problem: gamma = %g must be above 1",
                         r->gamma);
  for (int k = 0; k < 2; k++)
    if (!(side[k]->rho > 0 && side[k]->p > 0 && isfinite(side[k]->rho) && isfinite(side[k]->p) &&
          isfinite(side[k]->u)))
      return sph_error_set(
          error, SPH_ERR_ARGUMENT,
          "Riemann problem: %s state rho = %g, u = %g, p = %g must be finite, with "
          "rho > 0 and p > 0",
          k ? "right" : "left", side[k]->rho, side[k]->u, side[k]->p);
  double apart = r->right.u - r->left.u;
  double limit =
      2 / (r->gamma - 1) * (sound_speed(r->gamma, side[0]) + sound_speed(r->gamma, side[1]));
  if (apart < limit) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "Riemann problem: the states part with %g m/s; from %g m/s on they leave a "
                       "vacuum, which is not solved",
                       apart, limit);
}

int sph_exact_riemann_solve(sph_exact_riemann *r, sph_error *error)
{
  int status = check(r, error);
  if (status) return status;
  status = star_pressure(r);
  if (status)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "Riemann problem: no root: %s",
                         gsl_strerror(status));
  double left = jump(r->gamma, &r->left, r->p), right = jump(r->gamma, &r->right, r->p);
  r->u = 0.5 * (r->left.u + r->right.u) + 0.5 * (right - left);
  r->rho_right = wave(r->gamma, &r->right, r->right.u, r->p, r->u, &r->right_head, &r->right_tail);
  r->rho_left = wave(r->gamma, &r->left, -r->left.u, r->p, -r->u, &r->left_head, &r->left_tail);
  r->left_head = -r->left_head;
  r->left_tail = -r->left_tail;
  return SPH_OK;
}

/* Inside a rarefaction that runs to the right: c = c_k + (gamma-1)/2 (u - u_k), u + c = s. */
static sph_exact_gas fan(double gamma, const sph_exact_gas *k, double u_k, double s)
{
  double c_k = sound_speed(gamma, k), u = 2 / (gamma + 1) * (s - c_k + 0.5 * (gamma - 1) * u_k);
  double ratio = (s - u) / c_k;
  return (sph_exact_gas){.rho = k->rho * pow(ratio, 2 / (gamma - 1)),
                         .u = u,
                         .p = k->p * pow(ratio, 2 * gamma / (gamma - 1))};
}

sph_exact_gas sph_exact_riemann_at(const sph_exact_riemann *r, double s)
{
  if (s <= r->left_head) return r->left;
  if (s >= r->right_head) return r->right;
  if (s < r->left_tail) {
    sph_exact_gas mirror = fan(r->gamma, &r->left, -r->left.u, -s);
    mirror.u = -mirror.u;
    return mirror;
  }
  if (s > r->right_tail) return fan(r->gamma, &r->right, r->right.u, s);
  return (sph_exact_gas){s < r->u ? r->rho_left : r->rho_right, r->u, r->p};
}
