/* Murnaghan (1944), barotropic:
 *
 *   p = max((K0/n) [(rho/rho0)^n - 1] + p_b, p_min),  c^2 = (K0/rho0) (rho/rho0)^(n-1)
 *
 * K0: bulk modulus at rho0, n: its slope dK/dp.  It is Tait's with rho0 c0^2 = K0, gamma = n, and
 * computed there. */
#include <math.h>

#include "eos_table.h"

sph_eos sph_eos_murnaghan(double rho0, double K0, double n)
{
  sph_eos eos = sph_eos_tait(rho0, sqrt(K0 / rho0), n);
  eos.name = "murnaghan";
  return eos;
}

int sph_eos_murnaghan_check(const sph_eos *eos, sph_error *error)
{
  if (eos->gamma >= 1 && isfinite(eos->gamma)) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos murnaghan: n = gamma = %g must be 1 or more and finite (4 for metals)",
                       eos->gamma);
}
