#include "sphode/import.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "csv.h"
#include "memory.h"
#include "si_unit.h"
#include "sphode/sim.h"
#include "table.h"
#include "units.h"

/* What is taken of a file, component by component. */
static const struct {
  const char *field, *column;
  int component;
} wanted[] = {{"position", "x", 0},          {"position", "y", 1},
              {"position", "z", 2},          {"velocity", "velocity_x", 0},
              {"velocity", "velocity_y", 1}, {"velocity", "velocity_z", 2},
              {"density", "density", 0},     {"mass", "mass", 0},
              {"energy", "energy", 0}};
enum { WANTED = sizeof wanted / sizeof *wanted, POSITIONS = 3 };

typedef struct importer {
  sph_sim *sim;
  const sph_import_def *def;
  long n;
  double *value[WANTED]; /* [n]; NULL: not in the file */
  sph_error error;
} importer;

static int ends(const char *path, const char *end)
{
  size_t a = strlen(path), b = strlen(end);
  return a > b && !strcmp(path + a - b, end);
}

static int is_hdf5(const char *path) { return ends(path, ".hdf") || ends(path, ".hdf5"); }
static int is_vtk(const char *path) { return ends(path, ".vtu") || ends(path, ".vtp"); }

static const char *unit_of(const importer *m, const char *field)
{
  const sph_field_info *info;
  if (!strcmp(field, "mass")) return sph_units_get(SPH_UNIT_MASS, sph_sim_dim(m->sim));
  for (int k = 0; (info = sph_field_get(k)); k++)
    if (!strcmp(info->name, field)) return info->unit;
  return "";
}

static int parse_unit(const char *text, sph_si_unit *unit)
{
  const size_t n = sph_si_unit_parse(text, NULL, NULL, unit);
  return n > 0 && text[n + strspn(text + n, " \t")] == '\0';
}

/* The values of wanted[k], in a unit of the file, into SI. */
static int convert(importer *m, int k, const char *unit)
{
  const char *field = wanted[k].field, *right = unit_of(m, field);
  sph_si_unit from, to;
  if (!*unit || !strcmp(unit, right)) return SPH_OK;
  if (parse_unit(unit, &from) && parse_unit(right, &to) && sph_si_unit_same(from.power, to.power)) {
    for (long i = 0; i < m->n; i++) m->value[k][i] *= from.factor / to.factor;
    return SPH_OK;
  }
  return sph_error_set(&m->error, SPH_ERR_ARGUMENT, "%s: %s in %.60s; right is %s", m->def->path,
                       field, unit, right);
}

/* ---- CSV ---- */

/* The unit in "front [m]"; "": none. */
static void bracket(const char *title, char unit[128])
{
  const char *open = strchr(title, '['), *close = open ? strchr(open, ']') : NULL;
  unit[0] = '\0';
  if (close) snprintf(unit, 128, "%.*s", (int)(close - open - 1), open + 1);
}

/* Is it a field, or a component of one, that is taken or follows from what is? */
static int is_known(const sph_group *group, const char *name)
{
  static const char *const passed[] = {"group", "id", "smoothing_length"}; /* of exports */
  const sph_field_info *info;
  for (size_t k = 0; k < sizeof passed / sizeof *passed; k++)
    if (!strcmp(passed[k], name)) return 1;
  for (int k = 0; k < WANTED; k++)
    if (!strcmp(wanted[k].column, name)) return 1;
  for (int k = 0; (info = sph_group_field(group, k)); k++)
    if (!info->vector && !strcmp(info->name, name)) return 1;
  return 0;
}

/* What stands in a column that nobody takes would be lost without a word. */
static int check_columns(importer *m, const sph_group *group)
{
  char name[128];
  int there = 1;
  for (int k = 0; there == 1; k++) {
    there = sph_csv_name(m->def->path, k, name, &m->error);
    if (k == 0 && there == 1 && !*name) continue; /* numbers of rows, by pandas and R */
    if (there == 1 && !is_known(group, name))
      return sph_error_set(
          &m->error, SPH_ERR_ARGUMENT,
          "%s: column %d is \"%.60s\"; right are x, y, z, velocity_x, velocity_y, "
          "velocity_z, density, mass, energy (other fields of the group are passed "
          "over)",
          m->def->path, k + 1, name);
  }
  return there;
}

static int read_csv(importer *m, const sph_group *group)
{
  const int dim = sph_sim_dim(m->sim);
  int status = check_columns(m, group);
  for (int k = 0; k < WANTED && !status; k++) {
    char title[128], unit[128];
    long n = 0;
    if (wanted[k].component >= dim) continue;
    sph_error error = {0};
    status = sph_csv_read(m->def->path, wanted[k].column, 0, &m->value[k], &n, title, &error);
    if (status == SPH_ERR_ARGUMENT && k >= POSITIONS) { /* it need not have this column */
      status = SPH_OK;
      continue;
    }
    if (status) return sph_error_set(&m->error, status, "%s", error.text);
    bracket(title, unit);
    m->n = n; /* the same for all: a row without one is an error */
    status = convert(m, k, unit);
  }
  return status;
}

/* ---- HDF5, VTU ---- */

static int copy(importer *m, const sph_table *table, int k)
{
  const sph_table_field *f = sph_table_find(table, wanted[k].field);
  if (!f || wanted[k].component >= sph_sim_dim(m->sim)) return SPH_OK;
  if (wanted[k].component >= f->columns)
    return sph_error_set(&m->error, SPH_ERR_FILE, "%s: %s is no vector", m->def->path, f->name);
  m->value[k] = SPH_NEW(double, m->n, "particles of a file", &m->error);
  if (!m->value[k]) return SPH_ERR_MEMORY;
  for (long i = 0; i < m->n; i++) m->value[k][i] = f->data[i * f->columns + wanted[k].component];
  return convert(m, k, f->unit);
}

/* The mass that a header gives all particles of the part. */
static int one_mass(importer *m, double mass)
{
  const int k = WANTED - 2;
  if (m->value[k] || !(mass > 0)) return SPH_OK;
  m->value[k] = SPH_NEW(double, m->n, "particles of a file", &m->error);
  if (!m->value[k]) return SPH_ERR_MEMORY;
  for (long i = 0; i < m->n; i++) m->value[k][i] = mass;
  return SPH_OK;
}

static int read_table(importer *m)
{
  sph_table table;
  const char *path = m->def->path;
  int status = is_vtk(path)
                   ? sph_table_vtu_read(&table, path, "velocity density mass energy", &m->error)
                   : sph_table_read(&table, path, m->def->part, NULL, &m->error);
  if (status) return status;
  m->n = table.n;
  for (int k = 0; k < WANTED && !status && m->n > 0; k++) status = copy(m, &table, k);
  if (!status) status = one_mass(m, table.mass);
  sph_table_free(&table);
  return status;
}

/* ---- into the group ---- */

static int check_values(importer *m)
{
  for (int k = 0; k < WANTED; k++)
    for (long i = 0; m->value[k] && i < m->n; i++) {
      const int positive = !strcmp(wanted[k].field, "mass") || !strcmp(wanted[k].field, "density");
      const double value = m->value[k][i];
      if (!isfinite(value) || (positive && !(value > 0)))
        return sph_error_set(&m->error, SPH_ERR_ARGUMENT,
                             "%s: %s of particle %ld is %g; right is %s", m->def->path,
                             wanted[k].column, i, value, positive ? "finite and > 0" : "finite");
    }
  if (m->n > 0) return SPH_OK;
  return sph_error_set(&m->error, SPH_ERR_ARGUMENT,
                       is_hdf5(m->def->path) ? "%s: no particles of PartType%d"
                                             : "%s: no particles",
                       m->def->path, m->def->part);
}

static int fill(importer *m, sph_group *group)
{
  const double *const x[3] = {m->value[0], m->value[1], m->value[2]};
  const long before = sph_group_count(group);
  sph_group_add_points(group, m->n, x, m->def->rho0);
  if (sph_sim_status(m->sim)) return sph_sim_status(m->sim);
  for (int k = POSITIONS; k < WANTED; k++) {
    double *to = m->value[k] ? sph_group_write(group, wanted[k].field, wanted[k].component) : NULL;
    if (to) memcpy(to + before, m->value[k], (size_t)m->n * sizeof *to);
  }
  return SPH_OK;
}

void sph_import(sph_sim *sim, sph_group *group, const sph_import_def *def)
{
  importer m = {.sim = sim, .def = def};
  if (!sim || !group || sph_sim_status(sim)) return;
  int status = SPH_OK;
  if (!def || !def->path || !*def->path)
    status = sph_error_set(&m.error, SPH_ERR_ARGUMENT, "import: of no file");
  else if (ends(def->path, ".csv"))
    status = read_csv(&m, group);
  else if (is_hdf5(def->path) || is_vtk(def->path))
    status = read_table(&m);
  else
    status = sph_error_set(&m.error, SPH_ERR_ARGUMENT,
                           "%s: known are .csv, .hdf, .hdf5, .vtu, .vtp", def->path);
  if (!status) status = check_values(&m);
  if (status)
    sph_sim_fail(sim, status, "%s", m.error.text);
  else
    fill(&m, group);
  for (int k = 0; k < WANTED; k++) sph_memory_free(m.value[k]);
}
