/* Equations of state that are refused, with a text. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "eos_table.h"

static void refuse(sph_eos eos, const char *word)
{
  sph_error error = {0};
  assert_int_equal(sph_eos_check(&eos, &error), SPH_ERR_ARGUMENT);
  if (!strstr(error.text, word)) fail_msg("\"%s\" does not tell of \"%s\"", error.text, word);
  assert_true(strlen(error.text) > 20);
}

static void refusals(void **state)
{
  (void)state;
  const double bad[] = {0, -1, NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 5; k++) {
    refuse(sph_eos_tait(bad[k], 40, 7), "rho0");
    refuse(sph_eos_tait(1000, bad[k], 7), "c0");
    refuse(sph_eos_tait(1000, 40, bad[k]), "gamma");
    refuse(sph_eos_linear(bad[k], 40, 0), "rho0");
    refuse(sph_eos_linear(1000, bad[k], 0), "c0");
    refuse(sph_eos_ideal_gas(bad[k]), "gamma");
  }
  for (int k = 0; k < 5; k++) {
    refuse(sph_eos_isothermal(bad[k], 300), "rho0");
    refuse(sph_eos_isothermal(1, bad[k]), "c0");
    refuse(sph_eos_polytropic(bad[k], 1, 1.4), "rho0");
    refuse(sph_eos_polytropic(1, bad[k], 1.4), "c0");
    refuse(sph_eos_polytropic(1, 1, bad[k]), "eos polytropic");
    refuse(sph_eos_murnaghan(bad[k], 1e9, 4), "rho0");
    refuse(sph_eos_murnaghan(1000, bad[k], 4), "c0");
    refuse(sph_eos_murnaghan(1000, 1e9, bad[k]), "gamma");
    refuse(sph_eos_stiffened_gas(bad[k], 4.4, 6e8, 0), "rho0");
    refuse(sph_eos_stiffened_gas(1000, bad[k], 6e8, 0), "gamma");
    if (k) refuse(sph_eos_stiffened_gas(1000, 4.4, bad[k], 0), "p_inf");
    if (k > 1) refuse(sph_eos_stiffened_gas(1000, 4.4, 6e8, bad[k]), "q");
    refuse(sph_eos_mie_grueneisen(bad[k], 3940, 1.49, 2), "rho0");
    refuse(sph_eos_mie_grueneisen(8930, bad[k], 1.49, 2), "c0");
    if (k) refuse(sph_eos_mie_grueneisen(8930, 3940, bad[k], 2), "slope");
    refuse(sph_eos_mie_grueneisen(8930, 3940, 1.49, bad[k]), "grueneisen");
    refuse(sph_eos_ideal_gas_molar(1.4, bad[k]), "c_v");
  }
  refuse(sph_eos_tait_matched(NULL, 1, 1.4), "c0");
  sph_eos other = sph_eos_ideal_gas(1.4);
  refuse(sph_eos_tait_matched(&other, 1, 1.4), "c0");
  refuse(sph_eos_polytropic(1, 1, 1), "gamma");
  refuse(sph_eos_polytropic(1, 1, 0.5), "gamma");
  refuse(sph_eos_tait(1000, 40, 0.99), "gamma");
  refuse(sph_eos_ideal_gas(1), "gamma");
  refuse(sph_eos_linear(1000, 40, NAN), "p_min");
  refuse(sph_eos_linear(1000, 40, INFINITY), "p_min");
  refuse(sph_eos_linear(1000, 1, -1000), "p_min"); /* cut at rho = 0 */
  sph_eos eos = sph_eos_tait(1000, 40, 7);
  eos.p_background = NAN, refuse(eos, "p_background"), eos.p_background = 0;
  eos.pressure = NULL, refuse(eos, "pressure"), eos = sph_eos_tait(1000, 40, 7);
  eos.density = NULL, refuse(eos, "density"), eos = sph_eos_tait(1000, 40, 7);
  eos.thermal = 2, refuse(eos, "thermal"), eos = sph_eos_tait(1000, 40, 7);
  eos.name = NULL, refuse(eos, "name");
  eos = sph_eos_ideal_gas(1.4), eos.p_background = 5, refuse(eos, "p_background");
  eos = sph_eos_ideal_gas(1.4), eos.p_inf = 5, refuse(eos, "p_inf");
  eos = sph_eos_ideal_gas(1.4), eos.thermal = 0, eos.rho0 = eos.c0 = 1, refuse(eos, "thermal");
  eos = sph_eos_isothermal(1, 300), eos.p_background = 0, refuse(eos, "p_background");
  eos = sph_eos_polytropic(1, 2, 1.4), eos.p_min = 1, refuse(eos, "p_min");
  eos = sph_eos_mie_grueneisen(1, 1, 1, 1), eos.p_background = 2, refuse(eos, "p_background");
  eos = sph_eos_tait(1000, 40, 7), eos.c_v = -1, refuse(eos, "c_v");
  eos = sph_eos_dust(), eos.dust = 2, refuse(eos, "dust = 2");
  eos = sph_eos_dust(), eos.dust = 0, refuse(eos, "rho0"); /* else one like any other */
  eos = sph_eos_dust(), eos.thermal = 1, refuse(eos, "thermal = 1");
  eos = sph_eos_dust(), eos.rho0 = 3, refuse(eos, "rho0 = 3");
  eos = sph_eos_dust(), eos.c0 = 3, refuse(eos, "c0 = 3");
  eos = sph_eos_dust(), eos.c_v = 3, refuse(eos, "c_v = 3");
  eos = sph_eos_tait(1000, 40, 7), eos.c_v = -1;
  eos.c_v = NAN, refuse(eos, "c_v"), eos.c_v = INFINITY, refuse(eos, "c_v");
  assert_int_equal(sph_eos_check(NULL, NULL), SPH_ERR_ARGUMENT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(refusals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
