/* eos_table.h -- the built-in equations of state, and the check of any one where it is attached.
 *
 * Built-in ones are known by their names: a user's own with such a name is checked as the
 * built-in one. */
#ifndef SPH_EOS_TABLE_H
#define SPH_EOS_TABLE_H
#include "sphode/eos.h"

/* Refuses what cannot be run: SPH_ERR_ARGUMENT with the member, its value, what would be right. */
int sph_eos_check(const sph_eos *eos, sph_error *error);

/* What the built-in ones ask for beyond that. */
int sph_eos_tait_check(const sph_eos *eos, sph_error *error);
int sph_eos_linear_check(const sph_eos *eos, sph_error *error);
int sph_eos_murnaghan_check(const sph_eos *eos, sph_error *error);
int sph_eos_isothermal_check(const sph_eos *eos, sph_error *error);
int sph_eos_polytropic_check(const sph_eos *eos, sph_error *error);
int sph_eos_ideal_gas_check(const sph_eos *eos, sph_error *error);
int sph_eos_stiffened_gas_check(const sph_eos *eos, sph_error *error);
int sph_eos_mie_grueneisen_check(const sph_eos *eos, sph_error *error);
int sph_eos_dust_check(const sph_eos *eos, sph_error *error); /* of a user's own, too */

/* ... and what several of them share: rho0, c0 positive; thermal, without p_background and p_min;
 * gases whose pressure at rho0 is p0. */
int sph_eos_check_reference(const sph_eos *eos, sph_error *error);
int sph_eos_check_thermal(const sph_eos *eos, sph_error *error);
int sph_eos_power_check_gas(const sph_eos *eos, double p0, sph_error *error);

/* Index of the first of n states that does not exist (c NaN or infinite), -1: none; u as for
 * pressure. */
long sph_eos_find_bad(const sph_eos *eos, long n, const double *rho, const double *u);

/* Of p - p_b = (rho0 c0^2/gamma) [(rho/rho0)^gamma - 1], gamma >= 1 (the linear one: 1). */
double sph_eos_power_density(const sph_eos *eos, double gamma, double p);          /* [kg/m^3] */
double sph_eos_power_elastic_energy(const sph_eos *eos, double gamma, double rho); /* [J/kg] */
void sph_eos_slopes_power(const sph_eos *eos, long n, const double *rho, const double *u,
                          double *p_rho, double *p_u, double *c_rho, double *c_u);
/* Of p = (gamma - 1) rho (u - q) - gamma p_inf, c^2 = gamma (p + p_inf)/rho. */
void sph_eos_stiffened_gas_slopes(const sph_eos *eos, long n, const double *rho, const double *u,
                                  double *p_rho, double *p_u, double *c_rho, double *c_u);

/* Derivatives of T with respect to rho and u (0 without a temperature), and of T (dp/dT)_rho with
 * respect to rho and T. */
void sph_eos_slopes_temperature(const sph_eos *eos, long n, const double *rho, const double *u,
                                double *T_rho, double *T_u);
void sph_eos_slopes_thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                                     double *pT_rho, double *pT_T);

#endif
