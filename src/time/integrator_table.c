/* One table of integrators: our own schemes, and every explicit Butcher table of ARKODE.
 *
 * S, the stability limit dt <= S h/(c + |v|), was measured on a decaying Taylor-Green flow with delta-SPH for the rows
 * with a number.  Tables without one get an estimate: the largest |z| on the ray z = |z| (-0.05 + i) of weakly damped sound waves
 * for which |R(z)| <= 1, scaled so that Bogacki-Shampine's is its measured 2.14, times 0.8 for safety. */
#include "integrator_table.h"

#include <complex.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "stepper.h"

static const char DEFAULT[] = "erk:bogacki-shampine-4-2-3";

static const struct {
  const char *name;
  double stability; /* 0: estimated */
} rows[] = {
    {"leapfrog", 0.72},
    {"verlet", 0.72},
    {"erk:forward-euler-1-1", 0},
    {"erk:heun-euler-2-1-2", 1.33},
    {"erk:ralston-euler-2-1-2", 0},
    {"erk:explicit-midpoint-euler-2-1-2", 0},
    {"erk:knoth-wolke-3-3", 0},
    {"erk:shu-osher-3-2-3", 2.14},
    {"erk:bogacki-shampine-4-2-3", 2.14},
    {"erk:ark324l2sa-erk-4-2-3", 0},
    {"erk:zonneveld-5-3-4", 2.72},
    {"erk:sofroniou-spaletta-5-3-4", 2.72},
    {"erk:sayfy-aburub-6-3-4", 0},
    {"erk:ark436l2sa-erk-6-3-4", 0},
    {"erk:ark437l2sa-erk-7-3-4", 0},
    {"erk:cash-karp-6-4-5", 3.19},
    {"erk:fehlberg-6-4-5", 0},
    {"erk:dormand-prince-7-4-5", 2.94},
    {"erk:tsitouras-7-4-5", 3.02},
    {"erk:ark548l2sa-erk-8-4-5", 0},
    {"erk:ark548l2sab-erk-8-4-5", 0},
    {"erk:verner-8-5-6", 3.45},
    {"erk:verner-9-5-6", 0},
    {"erk:verner-10-6-7", 0},
    {"erk:verner-13-7-8", 0},
    {"erk:fehlberg-13-7-8", 0},
    {"erk:verner-16-8-9", 0},
};
enum { ROWS = sizeof rows / sizeof *rows };

/* "erk:cash-karp-6-4-5" is ARKODE_CASH_KARP_6_4_5; one table has a small letter in its name. */
static void table_name(const char *name, char *table, size_t size)
{
  snprintf(table, size, "ARKODE_%s", name + strlen("erk:"));
  for (char *c = table; *c; c++) *c = *c == '-' ? '_' : (char)toupper((unsigned char)*c);
  char *b = strstr(table, "L2SAB_ERK");
  if (b) b[4] = 'b';
}

/* |R(z)| of the table's stability function, by one step of y' = z y. */
static double amplification(ARKodeButcherTable B, double complex z)
{
  double complex k[64], y = 1;
  for (int i = 0; i < B->stages && i < 64; i++) {
    double complex stage = 1;
    for (int j = 0; j < i; j++) stage += z * B->A[i][j] * k[j];
    k[i] = stage;
    y += z * B->b[i] * k[i];
  }
  return cabs(y);
}

static double reach(ARKodeButcherTable B)
{
  const double step = 0.01;
  double r = step;
  while (r < 20 && amplification(B, r * (-0.05 + I)) <= 1) r += step;
  return r - step;
}

static double estimate(ARKodeButcherTable B)
{
  const double bogacki_shampine = 1.86, measured = 2.14;
  return 0.8 * measured * reach(B) / bogacki_shampine;
}

static int first_same_as_last(ARKodeButcherTable B)
{
  int last = B->stages - 1;
  if (B->c[last] != 1) return 0;
  for (int j = 0; j < B->stages; j++)
    if (B->A[last][j] != B->b[j]) return 0;
  return 1;
}

static int load(const char *name, double stability, sph_method *method)
{
  table_name(name, method->table, sizeof method->table);
  ARKodeButcherTable B = ARKodeButcherTable_LoadERKByName(method->table);
  if (!B) return 0;
  method->scheme = &sph_integrator_erk;
  method->order = B->q;
  method->stages = B->stages;
  method->fsal = first_same_as_last(B);
  method->evaluations = B->stages - method->fsal;
  method->error_control = B->d && B->p > 0;
  method->stability = stability > 0 ? stability : estimate(B);
  ARKodeButcherTable_Free(B);
  return 1;
}

static int find(const char *name, double stability, sph_method *method)
{
  *method = (sph_method){.order = 2, .stages = 1, .evaluations = 1, .stability = stability};
  snprintf(method->name, sizeof method->name, "%s", name);
  if (!strncmp(name, "erk:", 4)) return strlen(name) < 50 && load(name, stability, method);
  method->scheme = !strcmp(name, "leapfrog") ? &sph_integrator_leapfrog : &sph_integrator_verlet;
  return 1;
}

int sph_integrator_table_find(const char *name, sph_method *method, sph_error *error)
{
  if (!name) name = DEFAULT;
  char known[700] = "";
  for (int k = 0; k < ROWS; k++) {
    if (!find(rows[k].name, rows[k].stability, method)) continue;
    if (!strcmp(name, rows[k].name)) return SPH_OK;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", rows[k].name);
  }
  if (!strncmp(name, "erk:", 4) && find(name, 0, method))
    return SPH_OK; /* a newer ARKODE's table */
  return sph_error_set(error, SPH_ERR_ARGUMENT, "integrator \"%.60s\"; known with SUNDIALS %s: %s",
                       name, SUNDIALS_VERSION, known);
}

int sph_integrator_info_get(int k, sph_integrator_info *info)
{
  sph_method method;
  for (int row = 0; row < ROWS; row++) {
    if (!find(rows[row].name, rows[row].stability, &method) || k-- > 0) continue;
    *info = (sph_integrator_info){rows[row].name, method.order, method.evaluations,
                                  method.error_control, method.stability};
    return 1;
  }
  return 0;
}

const char *sph_bound_name(int bound)
{
  static const char *const names[SPH_BOUND_COUNT] = {
      [SPH_BOUND_CFL] = "cfl",     [SPH_BOUND_VISCOUS] = "viscous",
      [SPH_BOUND_FORCE] = "force", [SPH_BOUND_CONDUCTION] = "conduction",
      [SPH_BOUND_ERROR] = "error", [SPH_BOUND_STOP] = "stop",
      [SPH_BOUND_USER] = "user",   [SPH_BOUND_RETRY] = "retry"};
  return bound >= 0 && bound < SPH_BOUND_COUNT ? names[bound] : "";
}
