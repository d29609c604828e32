#include "integrator_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "integrator_data.h"
#include "integrator_rdpk.h"
#include "name.h"

/* The staggered leapfrog and the velocity Verlet scheme are one scheme in two notations. */
static const struct {
  const char *name;
  const sph_scheme *scheme;
} own[] = {
    {"leapfrog", &sph_integrator_leapfrog},
    {"verlet", &sph_integrator_leapfrog},
    {"dkd", &sph_integrator_dkd},
    {"predictor-corrector", &sph_integrator_predictor_corrector},
    {"midpoint", &sph_integrator_midpoint},
    {"verlet-dual", &sph_integrator_verlet_dual},
    {"symplectic", &sph_integrator_symplectic},
};
enum { OWN = sizeof own / sizeof *own };

static const struct {
  const char *name;
  double stability;
} erk[] = {
#define X(name, stability) {"erk:" name, stability},
#include "integrator_table.def"
#undef X
};

/* Those that this SUNDIALS has. */
static int arkode_rows(void)
{
  int listed = sizeof erk / sizeof *erk, built = ARKODE_MAX_ERK_NUM + 1;
  return listed < built ? listed : built;
}

/* Number of the pair in integrator_rdpk.c, < 0: another kind of row. */
static int rdpk(int k) { return k - OWN - arkode_rows(); }

const char *sph_integrator_table_name(int k)
{
  if (k < 0) return NULL;
  if (rdpk(k) >= 0) return sph_integrator_rdpk_name(rdpk(k));
  return k < OWN ? own[k].name : erk[k - OWN].name;
}

const sph_scheme *sph_integrator_table_scheme(int k)
{
  return k >= 0 && k < OWN ? own[k].scheme : NULL;
}

ARKodeButcherTable sph_integrator_table_butcher(int k)
{
  if (k < OWN || !sph_integrator_table_name(k)) return NULL;
  if (rdpk(k) >= 0) return sph_integrator_rdpk_table(rdpk(k));
  return ARKodeButcherTable_LoadERK((ARKODE_ERKTableID)(ARKODE_MIN_ERK_NUM + k - OWN));
}

const double *sph_integrator_table_control(int k)
{
  return rdpk(k) >= 0 ? sph_integrator_rdpk_control(rdpk(k)) : NULL;
}

int sph_integrator_table_fsal(const struct ARKodeButcherTableMem *table)
{
  int last = table->stages - 1;
  for (int j = 0; j <= last; j++)
    if (table->A[last][j] != table->b[j]) return 0;
  return fabs(table->c[last] - 1) < 1e-14;
}

sph_integrator_info sph_integrator_table_scheme_info(const sph_scheme *scheme)
{
  return (sph_integrator_info){.name = scheme->name,
                               .order = scheme->order,
                               .stages = scheme->stages,
                               .stability = scheme->stability};
}

int sph_integrator_table_info(int k, sph_integrator_info *info)
{
  if (!sph_integrator_table_name(k)) return 0;
  if (k < OWN) {
    *info = sph_integrator_table_scheme_info(own[k].scheme);
    info->name = own[k].name;
    return 1;
  }
  ARKodeButcherTable table = sph_integrator_table_butcher(k);
  if (!table) return 0;
  *info = (sph_integrator_info){.name = sph_integrator_table_name(k),
                                .order = table->q,
                                .stages = table->stages - sph_integrator_table_fsal(table),
                                .error_control = table->d != NULL && table->p > 0,
                                .stability = rdpk(k) < 0 ? erk[k - OWN].stability
                                                         : sph_integrator_rdpk_stability(rdpk(k))};
  ARKodeButcherTable_Free(table);
  return 1;
}

static int unknown(const char *name, sph_error *error)
{
  char known[800] = "";
  const char *nearest = own[0].name;
  const char *row;
  for (int k = 0; (row = sph_integrator_table_name(k)); k++) {
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", k ? ", " : "", row);
    if (sph_name_distance(name, row) < sph_name_distance(name, nearest)) nearest = row;
  }
  sph_error_set(error, SPH_ERR_ARGUMENT,
                "integrator \"%.60s\" is unknown; the nearest is \"%s\", known are %s", name,
                nearest, known);
  return -1;
}

int sph_integrator_table_find(const char *name, sph_error *error)
{
  if (!name) name = "erk:bogacki-shampine-4-2-3";
  const char *row;
  for (int k = 0; (row = sph_integrator_table_name(k)); k++)
    if (!strcmp(name, row)) return k;
  return unknown(name, error);
}
