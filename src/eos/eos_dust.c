/* Dust: grains far apart, without pressure.
 *
 *   p = 0,  c = 0;  no density follows from a pressure */
#include <math.h>
#include <string.h>

#include "eos_table.h"

static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)eos, (void)rho, (void)u;
  memset(p, 0, (size_t)n * sizeof *p);
  memset(c, 0, (size_t)n * sizeof *c);
}

static double density(const sph_eos *eos, double p, double u)
{
  (void)eos, (void)p, (void)u;
  return NAN;
}

sph_eos sph_eos_dust(void)
{
  return (sph_eos){
      .name = "dust", .dust = 1, .p_min = -INFINITY, .pressure = pressure, .density = density};
}

int sph_eos_dust_check(const sph_eos *eos, sph_error *error)
{
  if (eos->dust == 1 && !eos->thermal && eos->rho0 == 0 && eos->c0 == 0 && eos->c_v == 0)
    return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "eos %s: dust = %d, thermal = %d, rho0 = %g kg/m^3, c0 = %g m/s, c_v = %g "
                       "J/(kg K) must be 1, 0, 0, 0, 0: it has neither pressure nor heat",
                       eos->name, eos->dust, eos->thermal, eos->rho0, eos->c0, eos->c_v);
}
