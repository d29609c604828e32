#include "integrator_table.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "integrator_data.h"
#include "integrator_kinds.h"
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
  int needs;
} erk[] = {
#define X(name, stability, needs) {"erk:" name, stability, needs},
#include "integrator_table.def"
#undef X
};
enum { ERK = sizeof erk / sizeof *erk };

#if SPH_SUNDIALS_NUMBER >= 60600
#define ARK2 ARKODE_ARK2_ERK_3_1_2, ARKODE_ARK2_DIRK_3_1_2
#else /* only to be told of */
#define ARK2 ARKODE_ERK_NONE, ARKODE_DIRK_NONE
#endif

/* Pairs of one explicit and one implicit table of the same nodes and weights: Kennedy & Carpenter
 * (2003, 2019), and Giraldo, Kelly & Constantinescu (2013). */
static const struct {
  const char *name;
  ARKODE_ERKTableID explicit;
  ARKODE_DIRKTableID implicit;
  int needs;
} imex[] = {
    {"imex:ark324l2sa-4-2-3", ARKODE_ARK324L2SA_ERK_4_2_3, ARKODE_ARK324L2SA_DIRK_4_2_3, 60401},
    {"imex:ark436l2sa-6-3-4", ARKODE_ARK436L2SA_ERK_6_3_4, ARKODE_ARK436L2SA_DIRK_6_3_4, 60401},
    {"imex:ark437l2sa-7-3-4", ARKODE_ARK437L2SA_ERK_7_3_4, ARKODE_ARK437L2SA_DIRK_7_3_4, 60401},
    {"imex:ark548l2sa-8-4-5", ARKODE_ARK548L2SA_ERK_8_4_5, ARKODE_ARK548L2SA_DIRK_8_4_5, 60401},
    {"imex:ark548l2sab-8-4-5", ARKODE_ARK548L2SAb_ERK_8_4_5, ARKODE_ARK548L2SAb_DIRK_8_4_5, 60401},
    {"imex:ark2-3-1-2", ARK2, 60600},
};
enum { IMEX = sizeof imex / sizeof *imex };

static const char *own_name(int k) { return k < OWN ? own[k].name : NULL; }

static int own_info(int k, sph_integrator_info *info)
{
  *info = sph_integrator_table_scheme_info(own[k].scheme);
  return 1;
}

static const char *erk_known(int k, int *needs)
{
  if (k >= ERK) return NULL;
  *needs = erk[k].needs;
  return erk[k].name;
}

static ARKodeButcherTable erk_table(int k)
{
  return ARKodeButcherTable_LoadERK((ARKODE_ERKTableID)(ARKODE_MIN_ERK_NUM + k));
}

static int butcher_info(ARKodeButcherTable table, double stability, sph_integrator_info *info)
{
  if (!table) return 0;
  *info = (sph_integrator_info){.order = table->q,
                                .stages = table->stages - sph_integrator_table_fsal(table),
                                .error_control = table->d != NULL && table->p > 0,
                                .stability = stability};
  ARKodeButcherTable_Free(table);
  return 1;
}

static int erk_info(int k, sph_integrator_info *info)
{
  return butcher_info(erk_table(k), erk[k].stability, info);
}

static int rdpk_info(int k, sph_integrator_info *info)
{
  return butcher_info(sph_integrator_rdpk_table(k), sph_integrator_rdpk_stability(k), info);
}

static const char *imex_known(int k, int *needs)
{
  if (k >= IMEX) return NULL;
  *needs = imex[k].needs;
  return imex[k].name;
}

static int imex_info(int k, sph_integrator_info *info)
{
  int done = erk_info(imex[k].explicit - ARKODE_MIN_ERK_NUM, info);
  info->wants = SPH_WANTS_IMPLICIT;
  return done;
}

/* A kind of rows, k = 0, 1, ... of its own. */
typedef struct family {
  const char *(*name)(int k);                    /* NULL behind the last */
  int (*info)(int k, sph_integrator_info *info); /* all but the name; 0: out of memory */
  const sph_stepper *stepper;
  const char *(*known)(int k, int *needs); /* instead of name: integrator_kinds.h */
} family;

static const family families[] = {
    {own_name, own_info, &sph_ode_stepper, NULL},
    {NULL, erk_info, &sph_integrator_erk, erk_known},
    {sph_integrator_rdpk_name, rdpk_info, &sph_integrator_erk, NULL},
    {NULL, imex_info, &sph_integrator_imex, imex_known},
    {NULL, sph_integrator_mri_info, &sph_integrator_mri, sph_integrator_mri_known},
    {NULL, sph_integrator_sprk_info, &sph_integrator_sprk, sph_integrator_sprk_known},
    {NULL, sph_integrator_lsrk_info, &sph_integrator_lsrk, sph_integrator_lsrk_known},
};
enum { FAMILIES = sizeof families / sizeof *families };

static const char *name_in(const family *f, int k)
{
  int needs = 0;
  if (f->name) return f->name(k);
  const char *name = f->known(k, &needs);
  return needs <= SPH_SUNDIALS_NUMBER ? name : NULL;
}

/* The family of row *k, which becomes its number there; NULL: no row. */
static const family *family_of(int *k)
{
  for (int f = 0; f < FAMILIES && *k >= 0; f++) {
    int rows = 0;
    while (name_in(&families[f], rows)) rows++;
    if (*k < rows) return &families[f];
    *k -= rows;
  }
  return NULL;
}

const char *sph_integrator_table_name(int k)
{
  const family *f = family_of(&k);
  return f ? name_in(f, k) : NULL;
}

const sph_stepper *sph_integrator_table_stepper(int k)
{
  const family *f = family_of(&k);
  return f ? f->stepper : &sph_ode_stepper;
}

const sph_scheme *sph_integrator_table_scheme(int k)
{
  return k >= 0 && k < OWN ? own[k].scheme : NULL;
}

ARKodeButcherTable sph_integrator_table_butcher(int k)
{
  const family *f = family_of(&k);
  if (!f) return NULL;
  if (f->info == erk_info) return erk_table(k);
  return f->info == rdpk_info ? sph_integrator_rdpk_table(k) : NULL;
}

int sph_integrator_table_pair(int k, ARKodeButcherTable pair[2])
{
  const family *f = family_of(&k);
  pair[0] = pair[1] = NULL;
  if (!f || f->info != imex_info) return 0;
  pair[0] = ARKodeButcherTable_LoadERK(imex[k].explicit);
  pair[1] = ARKodeButcherTable_LoadDIRK(imex[k].implicit);
  if (pair[0] && pair[1]) return 1;
  ARKodeButcherTable_Free(pair[0]);
  ARKodeButcherTable_Free(pair[1]);
  return 0;
}

const double *sph_integrator_table_control(int k)
{
  const family *f = family_of(&k);
  return f && f->info == rdpk_info ? sph_integrator_rdpk_control(k) : NULL;
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
  const family *f = family_of(&k);
  if (!f || !f->info(k, info)) return 0;
  info->name = name_in(f, k);
  return 1;
}

int sph_integrator_table_missing(int k, sph_integrator_missing *missing)
{
  for (int f = 0; f < FAMILIES && k >= 0; f++)
    for (int row = 0, needs = 0; families[f].known; row++) {
      missing->name = families[f].known(row, &needs);
      if (!missing->name) break;
      if (needs <= SPH_SUNDIALS_NUMBER || k-- > 0) continue;
      snprintf(missing->needs, sizeof missing->needs,
               "SUNDIALS %d.%d or later; this library has " SUNDIALS_VERSION, needs / 10000,
               needs / 100 % 100);
      return 1;
    }
  return 0;
}

/* Letters of "erk:" and the like; 0: none. */
static size_t prefix(const char *name)
{
  const char *colon = strchr(name, ':');
  return colon ? (size_t)(colon - name) + 1 : 0;
}

static int same_kind(const char *a, const char *b)
{
  size_t n = prefix(a);
  return n == prefix(b) && !strncmp(a, b, n);
}

/* Is it "erk:..." or the like, with that beginning known? */
static int kind_is_known(const char *name)
{
  const char *row;
  for (int k = 0; prefix(name) && (row = sph_integrator_table_name(k)); k++)
    if (same_kind(name, row)) return 1;
  return 0;
}

/* Tells the rows of its kind; without a known one all kinds, each but our own by its beginning. */
static int unknown(const char *name, sph_error *error)
{
  char known[800] = "";
  const char *row, *last = "", *nearest = NULL;
  int kind = kind_is_known(name);
  for (int k = 0; (row = sph_integrator_table_name(k)); last = row, k++) {
    size_t used = strlen(known);
    const char *comma = used ? ", " : "";
    if (kind && !same_kind(name, row)) continue;
    if (!nearest || sph_name_distance(name, row) < sph_name_distance(name, nearest)) nearest = row;
    if (kind || !prefix(row))
      snprintf(known + used, sizeof known - used, "%s%s", comma, row);
    else if (!same_kind(row, last))
      snprintf(known + used, sizeof known - used, "%s%.*s...", comma, (int)prefix(row), row);
  }
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "integrator \"%.60s\" is unknown; the nearest is \"%s\", known are %s", name,
                       nearest, known);
}

/* Has a newer SUNDIALS that row, or all of its kind? */
static int unbuilt(const char *name, sph_error *error)
{
  sph_integrator_missing row;
  int kind = prefix(name) && !kind_is_known(name);
  for (int k = 0; sph_integrator_table_missing(k, &row); k++)
    if (!strcmp(name, row.name) || (kind && same_kind(name, row.name)))
      return sph_error_set(error, SPH_ERR_UNBUILT, "integrator %.60s needs %s", name, row.needs);
  return SPH_OK;
}

int sph_integrator_table_find(const char *name, sph_error *error)
{
  if (!name) name = "erk:bogacki-shampine-4-2-3";
  const char *row;
  for (int k = 0; (row = sph_integrator_table_name(k)); k++)
    if (!strcmp(name, row)) return k;
  int status = unbuilt(name, error);
  return status ? status : unknown(name, error);
}
