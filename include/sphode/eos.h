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
  const char *name; /* a built-in one's ("tait", ...) or the user's own; copied when attached */
  double rho0;      /* reference density [kg/m^3], > 0; gases: 0 where there is none */
  double c0;        /* sound speed at rho0 [m/s], > 0; gases: 0 where there is none */
  double gamma;     /* exponent: Tait 7 for water, Murnaghan's n; gases: ratio of specific heats */
  double p_background; /* pressure at rho0 [Pa] */
  double p_min;        /* cut-off: p = max(p, p_min) [Pa]; -INFINITY: none */
  double p_inf;        /* stiffened gas: its stiffness [Pa] */
  double q;            /* stiffened gas: its energy of formation [J/kg] */
  double slope;        /* Mie-Grueneisen: s of the shock speed c0 + s u_p [1] */
  double grueneisen;   /* Mie-Grueneisen: Gamma0 = (rho/rho0) (dp/du)_rho/rho [1] */
  double c_v;          /* specific heat at constant volume [J/(kg K)]; 0: unknown, no temperature */
  int thermal;         /* 1: p depends on the internal energy u, which is then integrated */
  int dust;            /* 1: no pressure; nothing of a fluid or a wall acts on it but drag */
  /* Called from several threads at once, on different particles: read ctx, do not write to it.
   * p[n] [Pa] and c[n] [m/s] of rho[n] [kg/m^3] > 0 and u[n] [J/kg] (u is NULL unless thermal).
   * c = NaN (or infinite) says that there is no such state: the step is tried again, smaller. */
  void (*pressure)(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                   double *c);
  /* rho [kg/m^3] at pressure p [Pa] for internal energy u [J/kg] (not read unless thermal); NaN or
   * not > 0: there is none. */
  double (*density)(const sph_eos *eos, double p, double u);
  /* Derivatives of p and c with respect to rho and u, [n] each; NULL: by differences, which are
   * right to about 1e-11 where p and c are smooth. */
  void (*slopes)(const sph_eos *eos, long n, const double *rho, const double *u, double *p_rho,
                 double *p_u, double *c_rho, double *c_u);
  /* Elastic energy [J/kg], zero at rho0 (polytropic: at zero density); NULL for a thermal one. */
  double (*elastic_energy)(const sph_eos *eos, double rho);
  /* u [J/kg] at density rho [kg/m^3] and pressure p [Pa], for thermal ones; NULL: found from
   * density, which takes longer and finds u > 0 only. */
  double (*energy_at)(const sph_eos *eos, double rho, double p);
  /* Temperature T[n] [K] of rho[n], u[n]; u[n] of rho[n], T[n]; T (dp/dT)_rho [Pa] of rho[n], T[n].
   * Called where c_v > 0 only; NULL: see sph_eos_temperature and its neighbours. */
  void (*temperature)(const sph_eos *eos, long n, const double *rho, const double *u, double *T);
  void (*energy)(const sph_eos *eos, long n, const double *rho, const double *T, double *u);
  void (*thermal_pressure)(const sph_eos *eos, long n, const double *rho, const double *T,
                           double *pT);
  void *ctx;            /* the user's; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx when the simulation lets go of it; may be NULL */
};

/* Tait-Cole: p = B [(rho/rho0)^gamma - 1] + p_b, B = rho0 c0^2/gamma,
 * c^2 = c0^2 (rho/rho0)^(gamma-1). */
SPH_API sph_eos sph_eos_tait(double rho0, double c0, double gamma);
/* Tait as stiff as another: rho0 c0^2/gamma and p_background are those of `other` (Tait, linear,
 * Murnaghan), so that fluids of different density share a simulation (Colagrossi & Landrini 2003).
 * NULL, or one without rho0, c0, gamma: refused where it is attached. */
SPH_API sph_eos sph_eos_tait_matched(const sph_eos *other, double rho0, double gamma);
/* Linear: p = max(c0^2 (rho - rho0) + p_b, p_min); c = c0, 0 on the cut.  p_min = -INFINITY: no
 * cut. */
SPH_API sph_eos sph_eos_linear(double rho0, double c0, double p_min);
/* Murnaghan: p = (K0/n) [(rho/rho0)^n - 1] + p_b, c^2 = (K0/rho0) (rho/rho0)^(n-1); K0: bulk
 * modulus at rho0 [Pa]. */
SPH_API sph_eos sph_eos_murnaghan(double rho0, double K0, double n);
/* Isothermal gas: p = c0^2 rho, c = c0.  rho0: where elastic energy is zero, and the scale of
 * errors. */
SPH_API sph_eos sph_eos_isothermal(double rho0, double c0);
/* Polytropic: p = K rho^gamma, c^2 = gamma p/rho; K [Pa (kg/m^3)^-gamma], gamma > 1.  rho0 gives c0
 * and the scale of errors. */
SPH_API sph_eos sph_eos_polytropic(double rho0, double K, double gamma);
/* Ideal gas: p = (gamma - 1) rho u, c^2 = gamma (gamma - 1) u.  Temperature: set c_v, or by the
 * molar mass M [kg/mol]: c_v = R/(M (gamma - 1)), so that p = rho R T/M. */
SPH_API sph_eos sph_eos_ideal_gas(double gamma);
SPH_API sph_eos sph_eos_ideal_gas_molar(double gamma, double M);
/* Stiffened gas: p = (gamma - 1) rho (u - q) - gamma p_inf, c^2 = gamma (p + p_inf)/rho,
 * c_v T = u - q - p_inf/rho.  rho0 gives c0, that at p = 0, which delta and the scales of errors
 * use. */
SPH_API sph_eos sph_eos_stiffened_gas(double rho0, double gamma, double p_inf, double q);
/* Mie-Grueneisen from the shock speed c0 + s u_p, Gamma rho = Gamma0 rho0, chi = 1 - rho0/rho:
 *   chi >= 0: p = p_H (1 - Gamma0 chi/2) + Gamma0 rho0 u, p_H = rho0 c0^2 chi/(1 - s chi)^2
 *   chi < 0:  p = c0^2 (rho - rho0) + Gamma0 rho0 u
 * No state at chi >= 1/s.  u = 0 at rho0 and 298.15 K. */
SPH_API sph_eos sph_eos_mie_grueneisen(double rho0, double c0, double slope, double grueneisen);
/* Dust: p = c = 0.  Its particles have a density of their own kind, fly freely through walls and
 * each other, feel body forces, and exchange momentum with fluids by drag (sph_term_drag). */
SPH_API sph_eos sph_eos_dust(void);

/* Has it a temperature (c_v > 0)?  NULL: 0. */
SPH_API int sph_eos_has_temperature(const sph_eos *eos);
/* T[n] [K] of rho[n] and u[n]; default: u/c_v.  Of a barotropic one u is the heat alone, without
 * elastic energy.  All NaN without a temperature. */
SPH_API void sph_eos_temperature(const sph_eos *eos, long n, const double *rho, const double *u,
                                 double *T);
/* u[n] [J/kg] of rho[n] and T[n]: the inverse; default: c_v T. */
SPH_API void sph_eos_energy(const sph_eos *eos, long n, const double *rho, const double *T,
                            double *u);
/* T (dp/dT)_rho [Pa] of rho[n] and T[n] > 0; default: 0 for a barotropic one, else by central
 * differences of p(rho, u(rho, T)) over T (1 +- 2^-17), to about 1e-10 of p. */
SPH_API void sph_eos_thermal_pressure(const sph_eos *eos, long n, const double *rho,
                                      const double *T, double *pT);

/* dp/drho [m^2/s^2], dp/du [kg/m^3], dc/drho, dc/du of rho[n], u[n] (not read unless thermal): for
 * Jacobians. */
SPH_API void sph_eos_slopes(const sph_eos *eos, long n, const double *rho, const double *u,
                            double *p_rho, double *p_u, double *c_rho, double *c_u);

/* Names of the built-in ones, NULL at the end of the list: for (k = 0; (name = sph_eos_name(k));
 * k++). */
SPH_API const char *sph_eos_name(int k);
/* One line: the formula of a built-in one; NULL for an unknown name. */
SPH_API const char *sph_eos_formula(const char *name);

#ifdef __cplusplus
}
#endif
#endif
