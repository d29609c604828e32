#include "case_solution.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "exact.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text
#define get_number sph_case_reader_number

typedef sph_case_moment moment;

static int is(const char *field, const char *name) { return !strcmp(field, name); }

static sph_exact_gas gas_of(const sph_case_node *map)
{
  return (sph_exact_gas){.rho = get_number(map, "density", 0),
                         .u = get_number(map, "velocity", 0),
                         .p = get_number(map, "pressure", 0)};
}

static int riemann_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  double gamma = get_number(m->reference, "gamma", 1.4);
  sph_exact_riemann r = {.gamma = gamma,
                         .left = gas_of(child_of(m->reference, "left")),
                         .right = gas_of(child_of(m->reference, "right"))};
  int status = sph_exact_riemann_solve(&r, error);
  for (long i = 0; i < m->n && !status; i++) {
    double x = m->x[0][i], s = m->time > 0 ? x / m->time : copysign(HUGE_VAL, x);
    sph_exact_gas gas = sph_exact_riemann_at(&r, s);
    if (is(field, "density"))
      to[i] = gas.rho;
    else if (is(field, "velocity"))
      to[i] = c == 0 ? gas.u : 0;
    else if (is(field, "pressure"))
      to[i] = gas.p;
    else if (is(field, "energy"))
      to[i] = gas.p / ((gamma - 1) * gas.rho);
    else
      return SPH_CASE_NO_FIELD;
  }
  return status;
}

static int of_column(const moment *m, const sph_exact_column *column, const char *field, double *to,
                     sph_error *error)
{
  const double *z = m->x[m->dim - 1];
  if (is(field, "pressure")) return sph_exact_column_at(column, m->n, z, NULL, to, error);
  if (is(field, "density")) return sph_exact_column_at(column, m->n, z, to, NULL, error);
  return SPH_CASE_NO_FIELD;
}

static int column_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  (void)c;
  sph_exact_column column = {.eos = *sph_group_eos(m->group),
                             .surface = get_number(m->reference, "surface", 0),
                             .g = get_number(m->reference, "gravity", 0)};
  column.p_surface = column.eos.p_background;
  return of_column(m, &column, field, to, error);
}

/* The layer of a group that the reference names; the simulation knows the other one. */
static int layers_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  const char *name[2] = {get_text(m->reference, "lower", ""), get_text(m->reference, "upper", "")};
  const sph_group *group[2];
  sph_exact_column column;
  (void)c;
  for (int k = 0; k < 2; k++) {
    group[k] = sph_sim_group(m->sim, name[k]);
    if (!group[k] || !sph_group_eos(group[k]))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "layers: there is no fluid '%s'", name[k]);
  }
  int upper = m->group == group[1];
  if (!upper && m->group != group[0])
    return sph_error_set(error, SPH_ERR_ARGUMENT, "layers: fluid '%s' is in none of them",
                         sph_group_name(m->group));
  sph_exact_layers layers = {.lower = *sph_group_eos(group[0]),
                             .upper = *sph_group_eos(group[1]),
                             .meet = get_number(m->reference, "meet", 0),
                             .surface = get_number(m->reference, "surface", 0),
                             .p_surface = sph_group_eos(group[1])->p_background,
                             .g = get_number(m->reference, "gravity", 0)};
  int status = sph_exact_layers_column(&layers, upper, &column, error);
  return status ? status : of_column(m, &column, field, to, error);
}

static int channel_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_channel channel = {.width = get_number(m->reference, "width", 0),
                               .nu = get_number(m->reference, "nu", 0),
                               .speed = get_number(m->reference, "speed", 0),
                               .force = get_number(m->reference, "force", 0)};
  if (!is(field, "velocity")) return SPH_CASE_NO_FIELD;
  if (c == 0) return sph_exact_channel_at(&channel, m->time, m->n, m->x[m->dim - 1], to, error);
  memset(to, 0, (size_t)m->n * sizeof *to);
  return SPH_OK;
}

static const double pi = 3.14159265358979323846;

static int taylor_green_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_taylor_green vortices = {.speed = get_number(m->reference, "speed", 0),
                                     .k = 2 * pi / get_number(m->reference, "length", 0),
                                     .nu = get_number(m->reference, "nu", 0),
                                     .rho = get_number(m->reference, "density", 0)};
  int pressure = is(field, "pressure");
  if (!pressure && !is(field, "velocity")) return SPH_CASE_NO_FIELD;
  if (m->dim != 2)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "taylor-green: dimension %d; right is 2", m->dim);
  for (long i = 0; i < m->n; i++) {
    sph_exact_flow flow = sph_exact_taylor_green_at(&vortices, m->time, m->x[0][i], m->x[1][i]);
    to[i] = pressure ? flow.p : flow.v[c];
  }
  return SPH_OK;
}

static int square_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_square square = {.side = get_number(m->reference, "side", 0),
                             .omega = get_number(m->reference, "omega", 0),
                             .rho = get_number(m->reference, "density", 0)};
  (void)c;
  if (!is(field, "pressure")) return SPH_CASE_NO_FIELD;
  if (m->dim != 2)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "square: dimension %d; right is 2", m->dim);
  for (long i = 0; i < m->n; i++)
    to[i] = sph_exact_square_pressure(&square, m->time, m->x[0][i], m->x[1][i]);
  return SPH_OK;
}

static int wave_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_wave wave = {.rho = get_number(m->reference, "density", 0),
                         .p = get_number(m->reference, "pressure", 0),
                         .c = get_number(m->reference, "sound_speed", 0),
                         .amplitude = get_number(m->reference, "amplitude", 0),
                         .k = 2 * pi / get_number(m->reference, "length", 0),
                         .standing = get_number(m->reference, "standing", 0) != 0};
  (void)error;
  for (long i = 0; i < m->n; i++) {
    sph_exact_gas gas = sph_exact_wave_at(&wave, m->time, m->x[0][i]);
    if (is(field, "density"))
      to[i] = gas.rho;
    else if (is(field, "velocity"))
      to[i] = c == 0 ? gas.u : 0;
    else if (is(field, "pressure"))
      to[i] = gas.p;
    else
      return SPH_CASE_NO_FIELD;
  }
  return SPH_OK;
}

static sph_exact_medium medium_of(const sph_case_node *map)
{
  return (sph_exact_medium){.temperature = get_number(map, "temperature", 0),
                            .conductivity = get_number(map, "conductivity", 0),
                            .capacity = get_number(map, "density", 0) *
                                        get_number(map, "specific_heat", 0)};
}

static int heat_mode_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_heat_mode mode = {.medium = medium_of(m->reference),
                              .amplitude = get_number(m->reference, "amplitude", 0),
                              .k = 2 * pi / get_number(m->reference, "length", 0)};
  (void)c;
  if (!is(field, "temperature")) return SPH_CASE_NO_FIELD;
  return sph_exact_heat_mode_at(&mode, m->time, m->n, m->x[0], to, error);
}

static int heat_step_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_heat_step step = {.left = medium_of(child_of(m->reference, "left")),
                              .right = medium_of(child_of(m->reference, "right"))};
  (void)c;
  if (!is(field, "temperature")) return SPH_CASE_NO_FIELD;
  return sph_exact_heat_step_at(&step, m->time, m->n, m->x[0], to, error);
}

static int is_dust(const moment *m)
{
  const sph_eos *eos = sph_group_eos(m->group);
  return eos && eos->dust;
}

static sph_exact_stream stream_of(const sph_case_node *map)
{
  return (sph_exact_stream){.rho = get_number(map, "density", 0),
                            .v = get_number(map, "velocity", 0)};
}

static int dusty_box_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_dusty_box box = {.fluid = stream_of(child_of(m->reference, "fluid")),
                             .dust = stream_of(child_of(m->reference, "dust")),
                             .K = get_number(m->reference, "coefficient", 0)};
  sph_exact_streams streams;
  if (!is(field, "velocity")) return SPH_CASE_NO_FIELD;
  int status = sph_exact_dusty_box_at(&box, m->time, &streams, error);
  for (long i = 0; i < m->n && !status; i++)
    to[i] = c > 0 ? 0 : is_dust(m) ? streams.dust : streams.fluid;
  return status;
}

static int dusty_wave_at(const moment *m, const char *field, int c, double *to, sph_error *error)
{
  sph_exact_dusty_wave wave = {.rho_fluid = get_number(m->reference, "fluid_density", 0),
                               .rho_dust = get_number(m->reference, "dust_density", 0),
                               .c = get_number(m->reference, "sound_speed", 0),
                               .K = get_number(m->reference, "coefficient", 0),
                               .amplitude = get_number(m->reference, "amplitude", 0),
                               .k = 2 * pi / get_number(m->reference, "length", 0)};
  if (!is(field, "velocity")) return SPH_CASE_NO_FIELD;
  memset(to, 0, (size_t)m->n * sizeof *to);
  if (c > 0) return SPH_OK;
  return sph_exact_dusty_wave_at(&wave, m->time, is_dust(m), m->n, m->x[0], NULL, to, error);
}

static const sph_case_solution solutions[] = {
    {"riemann", "a Riemann problem has density, velocity, pressure, energy", 0, riemann_at},
    {"column", "a column at rest has pressure, density", SPH_CASE_ALONG_LAST, column_at},
    {"layers", "layers at rest have pressure, density", SPH_CASE_ALONG_LAST, layers_at},
    {"channel", "a channel has velocity", SPH_CASE_ALONG_LAST, channel_at},
    {"taylor-green", "these vortices have velocity, pressure", SPH_CASE_ALONG_NONE,
     taylor_green_at},
    {"square", "a square that begins to rotate has pressure", SPH_CASE_ALONG_NONE, square_at},
    {"heat-mode", "conduction has temperature", 0, heat_mode_at},
    {"heat-step", "conduction has temperature", 0, heat_step_at},
    {"wave", "a wave has density, velocity, pressure", 0, wave_at},
    {"dusty-box", "streams have velocity", SPH_CASE_ALONG_NONE, dusty_box_at},
    {"dusty-wave", "a wave in dusty gas has velocity", 0, dusty_wave_at},
};

const sph_case_solution *sph_case_solution_find(const char *reference)
{
  for (size_t k = 0; k < sizeof solutions / sizeof *solutions; k++)
    if (is(reference, solutions[k].reference)) return &solutions[k];
  return NULL;
}
