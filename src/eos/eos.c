#include "sphode/eos.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "eos_table.h"

static const struct {
  const char *name, *formula;
  int (*check)(const sph_eos *eos, sph_error *error);
} table[] = {
    {"tait",
     "p = B [(rho/rho0)^gamma - 1] + p_b, B = rho0 c0^2/gamma, c = c0 (rho/rho0)^((gamma-1)/2)",
     sph_eos_tait_check},
    {"linear", "p = max(c0^2 (rho - rho0) + p_b, p_min), c = c0, 0 on the cut",
     sph_eos_linear_check},
    {"murnaghan", "p = (K0/n) [(rho/rho0)^n - 1] + p_b, c^2 = (K0/rho0) (rho/rho0)^(n-1)",
     sph_eos_murnaghan_check},
    {"isothermal", "p = c0^2 rho, c = c0", sph_eos_isothermal_check},
    {"polytropic", "p = K rho^gamma, c^2 = gamma p/rho", sph_eos_polytropic_check},
    {"ideal-gas", "p = (gamma - 1) rho u, c^2 = gamma (gamma - 1) u, c_v T = u",
     sph_eos_ideal_gas_check},
    {"stiffened-gas",
     "p = (gamma - 1) rho (u - q) - gamma p_inf, c^2 = gamma (p + p_inf)/rho, "
     "c_v T = u - q - p_inf/rho",
     sph_eos_stiffened_gas_check},
    {"mie-grueneisen",
     "p = rho0 c0^2 chi (1 - Gamma0 chi/2)/(1 - s chi)^2 + Gamma0 rho0 u, chi = 1 - rho0/rho; "
     "chi < 0: c0^2 (rho - rho0) + Gamma0 rho0 u",
     sph_eos_mie_grueneisen_check},
    {"dust", "p = 0, c = 0", sph_eos_dust_check},
};
enum { ROWS = sizeof table / sizeof table[0] };

static int row(const char *name)
{
  for (int k = 0; name && k < ROWS; k++)
    if (!strcmp(name, table[k].name)) return k;
  return -1;
}

const char *sph_eos_name(int k) { return k >= 0 && k < ROWS ? table[k].name : NULL; }

const char *sph_eos_formula(const char *name)
{
  int k = row(name);
  return k < 0 ? NULL : table[k].formula;
}

int sph_eos_has_temperature(const sph_eos *eos) { return eos && eos->c_v > 0; }

void sph_eos_temperature(const sph_eos *eos, long n, const double *rho, const double *u, double *T)
{
  if (sph_eos_has_temperature(eos) && eos->temperature)
    eos->temperature(eos, n, rho, u, T);
  else
    for (long i = 0; i < n; i++) T[i] = sph_eos_has_temperature(eos) ? u[i] / eos->c_v : NAN;
}

void sph_eos_energy(const sph_eos *eos, long n, const double *rho, const double *T, double *u)
{
  if (sph_eos_has_temperature(eos) && eos->energy)
    eos->energy(eos, n, rho, T, u);
  else
    for (long i = 0; i < n; i++) u[i] = sph_eos_has_temperature(eos) ? T[i] * eos->c_v : NAN;
}

/* p at T (1 + e). */
static double pressure_beside(const sph_eos *eos, double rho, double T, double e)
{
  double beside = T * (1 + e), u, p, c;
  sph_eos_energy(eos, 1, &rho, &beside, &u);
  eos->pressure(eos, 1, &rho, &u, &p, &c);
  return p;
}

void sph_eos_thermal_pressure(const sph_eos *eos, long n, const double *rho, const double *T,
                              double *pT)
{
  const double e = 0x1p-17;
  int known = sph_eos_has_temperature(eos);
  if (known && eos->thermal_pressure) {
    eos->thermal_pressure(eos, n, rho, T, pT);
    return;
  }
  for (long i = 0; i < n; i++) {
    pT[i] = known ? 0 : NAN;
    if (known && eos->thermal)
      pT[i] = (pressure_beside(eos, rho[i], T[i], e) - pressure_beside(eos, rho[i], T[i], -e)) /
              (2 * e);
  }
}

long sph_eos_find_bad(const sph_eos *eos, long n, const double *rho, const double *u)
{
  enum { CHUNK = 256 };
  double p[CHUNK], c[CHUNK];
  for (long i = 0; i < n; i += CHUNK) {
    long some = n - i < CHUNK ? n - i : CHUNK;
    eos->pressure(eos, some, rho + i, u ? u + i : NULL, p, c);
    for (long k = 0; k < some; k++)
      if (!(c[k] < INFINITY)) return i + k;
  }
  return -1;
}

static int check_positive(const sph_eos *eos, const char *what, double value, const char *unit,
                          sph_error *error)
{
  if (value > 0 && isfinite(value)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "eos %s: %s = %g %s must be positive and finite",
                       eos->name, what, value, unit);
}

int sph_eos_check_reference(const sph_eos *eos, sph_error *error)
{
  int status = check_positive(eos, "rho0", eos->rho0, "kg/m^3", error);
  return status ? status : check_positive(eos, "c0", eos->c0, "m/s", error);
}

int sph_eos_check_thermal(const sph_eos *eos, sph_error *error)
{
  if (!eos->thermal)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "eos %s: thermal = 0 must be 1", eos->name);
  if (eos->p_background == 0 && !(eos->p_min > 0)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos %s: p_background = %g Pa, p_min = %g Pa are not used: leave them 0 and "
                       "-INFINITY",
                       eos->name, eos->p_background, eos->p_min);
}

/* Barotropic: walls and starts need rho(p), step limits and error weights c0 at rho0. */
static int check_barotropic(const sph_eos *eos, sph_error *error)
{
  int status = sph_eos_check_reference(eos, error);
  if (!status && !isfinite(eos->p_background))
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "eos %s: p_background = %g Pa must be finite",
                           eos->name, eos->p_background);
  return status;
}

int sph_eos_check(const sph_eos *eos, sph_error *error)
{
  if (!eos || !eos->name || !eos->name[0])
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos: has no name; the built-in ones come from "
                         "sph_eos_tait, sph_eos_ideal_gas and their neighbours");
  if (!eos->pressure || !eos->density)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "eos %s: function %s is NULL; it is required",
                         eos->name, eos->pressure ? "density" : "pressure");
  if (eos->thermal != 0 && eos->thermal != 1)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "eos %s: thermal = %d must be 0 or 1", eos->name,
                         eos->thermal);
  if (isnan(eos->p_min) || eos->p_min == INFINITY)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos %s: p_min = %g Pa must be a pressure, or -INFINITY for no cut-off",
                         eos->name, eos->p_min);
  if (!(eos->c_v >= 0 && isfinite(eos->c_v)))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "eos %s: c_v = %g J/(kg K) must be positive and finite, or 0 for unknown",
                         eos->name, eos->c_v);
  if (eos->dust) return sph_eos_dust_check(eos, error);
  int status = eos->thermal ? SPH_OK : check_barotropic(eos, error), k = row(eos->name);
  return status || k < 0 ? status : table[k].check(eos, error);
}
