/* sphode/eos.h -- equations of state p(rho, u), c(rho, u); docs/theory.md, Equations of state.
 *
 * A built-in one and a user's own are the same struct, returned and copied by value; it is checked
 * where it is attached (sph_group_set_eos), so that the error sticks to the simulation. */
#ifndef SPHODE_EOS_H
#define SPHODE_EOS_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_eos sph_eos;
struct sph_eos {
  const char *name;    /* "tait", "linear", "ideal-gas" or the user's own; copied when attached */
  double rho0;         /* reference density [kg/m^3], > 0; ideal gas: not used */
  double c0;           /* sound speed at rho0 [m/s], > 0; ideal gas: not used */
  double gamma;        /* exponent; Tait 7 for water; ideal gas: ratio of specific heats, > 1 */
  double p_background; /* pressure at rho0 [Pa] */
  double p_min;        /* cut-off: p = max(p, p_min) [Pa]; -INFINITY: none */
  int thermal;         /* 1: p depends on the internal energy u, which is then integrated */
  /* Called from several threads at once, on different particles: read ctx, do not write to it.
   * p[n] [Pa] and c[n] [m/s] of rho[n] [kg/m^3] and u[n] [J/kg] (u is NULL unless thermal). */
  void (*pressure)(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                   double *c);
  /* rho [kg/m^3] at pressure p [Pa] for internal energy u [J/kg] (not read unless thermal). */
  double (*density)(const sph_eos *eos, double p, double u);
  /* Elastic energy [J/kg], zero at rho0; NULL for a thermal one. */
  double (*elastic_energy)(const sph_eos *eos, double rho);
  void *ctx;            /* the user's; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx when the simulation lets go of it; may be NULL */
};

/* Tait-Cole: p = B [(rho/rho0)^gamma - 1] + p_b, B = rho0 c0^2/gamma,
 * c^2 = c0^2 (rho/rho0)^(gamma-1). */
SPH_API sph_eos sph_eos_tait(double rho0, double c0, double gamma);
/* Linear: p = max(c0^2 (rho - rho0) + p_b, p_min); c = c0, 0 on the cut.  p_min = -INFINITY: no
 * cut. */
SPH_API sph_eos sph_eos_linear(double rho0, double c0, double p_min);
/* Ideal gas: p = (gamma - 1) rho u, c^2 = gamma (gamma - 1) u. */
SPH_API sph_eos sph_eos_ideal_gas(double gamma);

/* Names of the built-in ones, NULL at the end of the list: for (k = 0; (name = sph_eos_name(k));
 * k++). */
SPH_API const char *sph_eos_name(int k);
/* One line: the formula of a built-in one; NULL for an unknown name. */
SPH_API const char *sph_eos_formula(const char *name);

#ifdef __cplusplus
}
#endif
#endif
