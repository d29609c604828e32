/* From a checked case to a simulation, by the public interface only. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "case_build.h"
#include "case_event.h"
#include "case_material.h"
#include "case_path.h"
#include "case_scalar.h"
#include "case_schema.h"
#include "case_shape.h"
#include "case_source.h"
#include "memory.h"
#include "sphode/case.h"
#include "sphode/checkpoint.h"
#include "sphode/correction.h"
#include "sphode/import.h"
#include "sphode/kernel.h"

typedef struct builder {
  const sph_case *c;
  sph_sim *sim;
  sph_error *error;
  sph_case_motions motions;
} builder;

#define get_text sph_case_reader_text
#define get_number sph_case_reader_number
#define get_vector sph_case_reader_vector
#define child_of sph_case_reader_find

/* The first failure of the simulation, with the place in the file that led to it. */
static int told(const builder *b, const sph_case_node *node)
{
  if (b->error->status) return b->error->status;
  if (sph_sim_status(b->sim) == SPH_OK) return SPH_OK;
  return sph_case_schema_fail(b->c, b->error, node, 0, 0, "%s", sph_sim_error(b->sim));
}

static int fail(const builder *b, const sph_case_node *node, const char *what)
{
  return sph_case_schema_fail(b->c, b->error, node, 0, 0, "%s", what);
}

static int axis_of(const char *word) { return word[0] - 'x'; }

/* ---- groups */

/* "x- y+ ", of a list. */
static const char *open_sides(const sph_case_node *shape, char *text, size_t room)
{
  const sph_case_node *list = child_of(shape, "open"), *side = list ? list->first : NULL;
  for (size_t n = 0; side; side = side->next, n = strlen(text))
    snprintf(text + n, room - n, "%s ", side->text);
  return text;
}

static int is_mirror(const sph_case_node *group)
{
  return !strcmp(get_text(child_of(group, "boundary"), "model", "adami"), "mirror");
}

/* The planes of a mirror: from its shapes. */
static int add_planes(const builder *b, const sph_case_node *shape, sph_boundary *boundary)
{
  double one[3], other[3];
  char open[32] = "";
  const int plane = !strcmp(shape->key, "plane");
  if (!plane && strcmp(shape->key, "layers"))
    return fail(b, shape, "a mirror has planes: right are layers, the sides of a box, or plane");
  get_vector(shape, plane ? "point" : "lower", one);
  get_vector(shape, plane ? "normal" : "upper", other);
  if (plane)
    sph_boundary_mirror_plane(boundary, one, other, b->c->dim);
  else
    sph_boundary_mirror_box(boundary, one, other, open_sides(shape, open, sizeof open), b->c->dim);
  return SPH_OK;
}

/* An expression in t and the tables, for dim > 0 in x, y, z, too. */
static int set_formula(const builder *b, const sph_case_node *node, int dim, const char *what,
                       sph_case_formula **to)
{
  sph_case_value value;
  *to = sph_case_value_formula_create(node->text, b->c->timed, b->c->timed_n, dim, &value);
  if (*to) return SPH_OK;
  return sph_case_schema_fail(b->c, b->error, node, 1, value.column, "%s: %s", what, value.problem);
}

static int set_motion(const builder *b, const sph_case_node *motion, sph_case_motion *m)
{
  const sph_case_node *displacement = child_of(motion, "displacement");
  const sph_case_node *angle = child_of(child_of(motion, "rotation"), "angle");
  const sph_case_node *node = displacement ? displacement->first : NULL;
  int status = SPH_OK;
  get_vector(motion, "velocity", m->velocity);
  m->slide = get_number(motion, "slide", 0) != 0;
  m->rate = get_number(child_of(motion, "rotation"), "angular_velocity", 0);
  for (int d = 0; node && d < 3 && !status; node = node->next, d++) {
    status = set_formula(b, node, 0, "displacement", &m->formula[d]);
    sph_case_source_describe(b->c, "motion", "displacement", node, m->what[d]);
  }
  if (!status && angle) status = set_formula(b, angle, 0, "angle", &m->angle);
  if (angle) sph_case_source_describe(b->c, "rotation", "angle", angle, m->what[3]);
  if (status || sph_case_motion_begin(m, 1e-5 * sph_case_end(b->c)) == SPH_OK) return status;
  return displacement ? fail(b, displacement, "displacement: not finite at t = 0")
                      : fail(b, angle, "angle: not finite at t = 0");
}

/* A constant becomes a number, what changes a formula. */
static int set_heat(const builder *b, const sph_case_node *node, double *number,
                    sph_case_formula **formula)
{
  sph_case_value value;
  if (!node) return SPH_OK;
  if (sph_case_value_evaluate(node->text, b->c->names, b->c->n, &value))
    return set_formula(b, node, b->c->dim, node->key, formula);
  *number = value.value;
  return SPH_OK;
}

/* What the wall does over time; the boundary takes it along. */
static int add_motion(builder *b, const sph_group *group, const sph_case_node *map,
                      sph_boundary *boundary)
{
  const sph_case_node *motion = child_of(map, "motion"), *rotation = child_of(motion, "rotation");
  sph_case_motion *m = SPH_NEW(sph_case_motion, 1, "the motion of a wall", b->error);
  if (!m) return SPH_ERR_MEMORY;
  int status = set_heat(b, child_of(map, "temperature"), &boundary->temperature, &m->temperature);
  if (!status)
    status = set_heat(b, child_of(map, "heat_flux"), &boundary->heat_flux, &m->heat_flux);
  if (!status && motion) status = set_motion(b, motion, m);
  if (status) {
    sph_case_motion_free(m);
    return status;
  }
  get_vector(rotation, "centre", boundary->centre);
  get_vector(rotation, "axis", boundary->axis);
  sph_case_motion_set(boundary, m, motion != NULL, rotation != NULL);
  if (!motion) return SPH_OK;
  char name[80];
  snprintf(name, sizeof name, "motion.%.64s", sph_group_name(group));
  sph_sim_keep_add(b->sim, (sph_kept){.name = name, .keep = sph_case_motion_keep, .ctx = m});
  b->motions.of[b->motions.n].group = sph_group_name(group);
  b->motions.of[b->motions.n++].motion = m;
  return SPH_OK;
}

static int set_boundary(builder *b, sph_group *group, const sph_case_node *of)
{
  const sph_case_node *map = child_of(of, "boundary");
  const sph_case_node *shape = is_mirror(of) ? child_of(of, "shapes")->first : NULL;
  sph_boundary boundary = sph_boundary_adami();
  boundary.name = get_text(map, "model", "adami");
  for (int status; shape; shape = shape->next)
    if ((status = add_planes(b, shape->first, &boundary))) return status;
  boundary.no_slip = get_number(map, "no_slip", 0) != 0;
  boundary.tension = get_number(map, "tension", 0) != 0;
  if (child_of(map, "repulsion")) sph_group_set_repulsion(group, get_number(map, "repulsion", 0));
  if (child_of(map, "motion") || child_of(map, "temperature") || child_of(map, "heat_flux")) {
    int status = add_motion(b, group, map, &boundary);
    if (status) return status;
  }
  sph_group_set_boundary(group, boundary);
  return told(b, map ? map : of);
}

static int add_file(const builder *b, sph_group *group, const sph_case_node *file, double density)
{
  char path[SPH_CASE_PATH];
  const int wall = !strcmp(sph_group_kind(group), "wall");
  const sph_case_node *name = child_of(file, "path");
  if (sph_case_path(b->c, name->text, path, b->error)) return b->error->status;
  sph_import(b->sim, group,
             &(sph_import_def){.path = path,
                               .part = (int)get_number(file, "part", wall),
                               .rho0 = get_number(file, "density", density)});
  return told(b, file);
}

/* Of a box, a ball or layers on their own lattice. */
static int add_plain(const builder *b, sph_group *group, const sph_case_node *shape, double density)
{
  double lower[3], upper[3], centre[3];
  char open[32] = "";
  get_vector(shape, "lower", lower);
  get_vector(shape, "upper", upper);
  for (int d = 0; d < b->c->dim && strcmp(shape->key, "ball"); d++)
    if (!(upper[d] > lower[d]))
      return sph_case_schema_fail(b->c, b->error, child_of(shape, "upper"), 1, 0,
                                  "upper: found %c = %g m, with lower %g m; upper above lower is "
                                  "right",
                                  'x' + d, upper[d], lower[d]);
  if (!strcmp(shape->key, "ball")) {
    get_vector(shape, "centre", centre);
    sph_group_add_ball(group, centre, get_number(shape, "radius", 0), density);
  } else if (!strcmp(shape->key, "box")) {
    sph_group_add_box(group, lower, upper, density);
  } else {
    sph_group_add_layers(group, lower, upper, open_sides(shape, open, sizeof open), density);
  }
  return told(b, shape);
}

static int add_one_shape(const builder *b, sph_group *group, const sph_case_node *map,
                         const sph_case_node *shape)
{
  const double density = get_number(shape, "density", sph_case_material_density(map));
  if (!strcmp(shape->key, "plane"))
    return fail(b, shape, "a plane is a shape of walls with boundary: {model: mirror} alone");
  if (!strcmp(shape->key, "file")) return add_file(b, group, shape, density);
  if (!sph_case_shape_is(map, shape)) return add_plain(b, group, shape, density);
  int status = sph_case_shape_add(b->c, b->sim, group, map, shape, density, b->error);
  return status ? status : told(b, shape);
}

/* A shape that holds nothing is a mistake, and which one it is can be said. */
static int add_shape(const builder *b, sph_group *group, const sph_case_node *map,
                     const sph_case_node *shape)
{
  const long before = sph_group_count(group);
  int status = add_one_shape(b, group, map, shape);
  if (status || sph_group_count(group) > before) return status;
  if (!strcmp(shape->key, "layers"))
    return fail(b, shape, "layers: no particles; all sides are open");
  return sph_case_schema_fail(b->c, b->error, shape, 0, 0,
                              "%s: no particles; no place of the lattice (dx = %g m) lies in it: a "
                              "larger one, or a smaller spacing, is right",
                              shape->key, sph_sim_dx(b->sim));
}

static int set_scales(const builder *b, const sph_group *group, const sph_case_node *map)
{
  const sph_case_node *scales = child_of(map, "scales"), *one = scales ? scales->first : NULL;
  int status = SPH_OK;
  for (; one && !status; one = one->next) {
    sph_sim_set_scale(b->sim, group, one->key, one->number);
    status = told(b, one);
  }
  return status;
}

static int build_group(builder *b, const sph_case_node *map)
{
  const sph_case_node *eos = child_of(map, "eos"), *material = child_of(map, "material");
  const sph_case_node *boundary = child_of(map, "boundary");
  const sph_case_node *initial = child_of(map, "initial"), *shape = child_of(map, "shapes")->first;
  int wall = !strcmp(get_text(map, "kind", ""), "wall"), status;
  if (wall && initial) return fail(b, initial, "a wall has no initial state; see boundary: motion");
  if (!wall && boundary) return fail(b, boundary, "a fluid has no boundary; a wall has");
  if (wall && child_of(map, "scales"))
    return fail(b, child_of(map, "scales"), "a wall has no scales: it integrates nothing");
  sph_group *group = sph_group_create(b->sim, map->key, get_text(map, "kind", ""));
  if (!told(b, map)) sph_case_material_set(b->sim, group, map);
  status = told(b, material ? material : eos ? eos : map);
  if (!status && child_of(map, "energy")) {
    sph_group_set_energy(group, get_text(map, "energy", ""));
    status = told(b, child_of(map, "energy"));
  }
  for (; shape && !status && !(wall && is_mirror(map)); shape = shape->next)
    status = add_shape(b, group, map, shape->first);
  if (!status && get_number(map, "jitter", 0) > 0) {
    sph_group_jitter(group, get_number(map, "jitter", 0),
                     (unsigned long)get_number(map, "seed", 1));
    status = told(b, map);
  }
  if (!status && wall) status = set_boundary(b, group, map);
  if (!status) status = set_scales(b, group, map);
  if (!status && sph_group_count(group) == 0 && !(wall && is_mirror(map)))
    status = fail(b, map, "the group has no particles: its list of shapes is empty");
  return status;
}

/* ---- the state at the start */

/* The expression of a node at all particles of a group: [count], to be freed; NULL: told. */
static double *field_of(const builder *b, const sph_group *group, const sph_case_node *node)
{
  const double *x[3] = {NULL, NULL, NULL};
  sph_case_value value;
  long n = sph_group_count(group);
  double *field = SPH_NEW(double, n, "an initial field", b->error);
  if (!field) return NULL;
  for (int d = 0; d < b->c->dim; d++) x[d] = sph_group_read(group, "position", d);
  if (!sph_case_value_field(node->text, b->c->names, b->c->n, b->c->dim, n, x, field, &value))
    return field;
  sph_case_schema_fail(b->c, b->error, node, 1, value.column, "%s", value.problem);
  sph_memory_free(field);
  return NULL;
}

static int write_field(const builder *b, sph_group *group, const char *name, int component,
                       const sph_case_node *node)
{
  double *field = field_of(b, group, node), *to = sph_group_write(group, name, component);
  if (field && to) memcpy(to, field, (size_t)sph_group_count(group) * sizeof *to);
  if (field && !to)
    fail(b, node, "the group has no such field; its equation of state has no energy");
  sph_memory_free(field);
  return told(b, node);
}

static int set_hydrostatic(const builder *b, sph_group *group, const sph_case_node *map)
{
  const char *axis = get_text(map, "axis", NULL);
  int up = axis ? axis_of(axis) : b->c->dim - 1;
  double surface = get_number(map, "surface", 0), g = get_number(map, "gravity", 0);
  if (child_of(map, "pressure"))
    sph_group_set_column(group, up, surface, get_number(map, "pressure", 0), g);
  else
    sph_group_set_hydrostatic(group, up, surface, g);
  return told(b, map);
}

static int set_by(const builder *b, sph_group *group, const sph_case_node *node,
                  void (*set)(sph_group *group, const double *values))
{
  double *values = field_of(b, group, node);
  if (values) set(group, values);
  sph_memory_free(values);
  return told(b, node);
}

static int set_initial(const builder *b, const sph_case_node *map)
{
  const sph_case_node *initial = child_of(map, "initial"), *node;
  sph_group *group = sph_sim_group(b->sim, map->key);
  int status = SPH_OK, d = 0;
  if (!initial) return SPH_OK;
  int barotropic = !sph_group_thermal(group);
  if (!!child_of(initial, "pressure") + !!child_of(initial, "hydrostatic") +
          (!barotropic && (child_of(initial, "energy") || child_of(initial, "temperature"))) >
      1)
    return fail(b, initial, "only one of pressure, energy, temperature, hydrostatic can be given");
  if (child_of(initial, "energy") && child_of(initial, "temperature"))
    return fail(b, initial, "only one of energy, temperature can be given");
  if (barotropic && child_of(initial, "density") &&
      (child_of(initial, "pressure") || child_of(initial, "hydrostatic")))
    return fail(b, child_of(initial, "density"),
                "density and the pressure of a liquid follow from each other; only one of density, "
                "pressure, hydrostatic can be given");
  if ((node = child_of(initial, "velocity")))
    for (node = node->first; node && !status; node = node->next)
      status = write_field(b, group, "velocity", d++, node);
  if (!status && (node = child_of(initial, "density"))) /* others are at this density */
    status = set_by(b, group, node, sph_group_set_density);
  if (!status && (node = child_of(initial, "energy")))
    status = write_field(b, group, "energy", 0, node);
  if (!status && (node = child_of(initial, "hydrostatic")))
    status = set_hydrostatic(b, group, node);
  if (!status && (node = child_of(initial, "pressure")))
    status = set_by(b, group, node, sph_group_set_pressure);
  if (!status && (node = child_of(initial, "temperature")))
    status = set_by(b, group, node, sph_group_set_temperature);
  return status;
}

/* ---- terms, integrator */

static sph_term shifting(const sph_case_node *map)
{
  sph_term term = sph_term_shifting(get_text(map, "form", NULL), get_number(map, "speed", 0));
  term.strength = get_number(map, "strength", 1);
  term.crowding = get_number(map, "crowding", 0);
  term.surface = get_number(map, "surface", 1) != 0;
  term.advection = get_number(map, "advection", 1) != 0;
  term.steps = (long)get_number(map, "steps", 0);
  return term;
}

static sph_term transport(const sph_case_node *map)
{
  sph_term term =
      sph_term_transport_velocity(get_number(map, "background", 0), get_number(map, "time", 0));
  term.advection = get_number(map, "advection", 1) != 0;
  return term;
}

static sph_term switched(const sph_case_node *map, sph_term viscosity)
{
  return sph_term_switched(viscosity, get_text(map, "switch", NULL),
                           get_number(map, "alpha_min", 0));
}

static sph_term plain_term(const sph_case_node *map)
{
  const char *name = map->key, *form = get_text(map, "form", NULL);
  double alpha = get_number(map, "alpha", 0), g[3];
  if (!strcmp(name, "continuity")) {
    sph_term term = sph_term_continuity_form(form);
    term.exponent = get_number(map, "exponent", 1);
    return term;
  }
  if (!strcmp(name, "summation")) return sph_term_summation(get_number(map, "calibrate", 1) != 0);
  if (!strcmp(name, "viscosity-signal"))
    return switched(map, sph_term_viscosity_signal(alpha, get_number(map, "beta", 0)));
  if (!strcmp(name, "viscosity-laminar")) return sph_term_viscosity_laminar(form);
  if (!strcmp(name, "conduction")) return sph_term_conduction();
  if (!strcmp(name, "xsph")) return sph_term_xsph(get_number(map, "epsilon", 0));
  if (!strcmp(name, "shifting")) return shifting(map);
  if (!strcmp(name, "transport-velocity")) return transport(map);
  if (!strcmp(name, "stress-artificial"))
    return sph_term_stress_artificial(alpha, get_number(map, "beta", 0));
  if (!strcmp(name, "pressure")) return sph_term_pressure_form(form);
  if (!strcmp(name, "viscosity-artificial"))
    return switched(map, sph_term_viscosity_artificial(alpha, get_number(map, "beta", 0)));
  if (!strcmp(name, "conductivity-artificial")) return sph_term_conductivity_artificial(alpha);
  if (!strcmp(name, "delta"))
    return sph_term_delta(get_text(map, "model", NULL), get_number(map, "delta", 0));
  if (!strcmp(name, "drag"))
    return child_of(map, "coefficient") ? sph_term_drag(get_number(map, "coefficient", 0))
                                        : sph_term_drag_time(get_number(map, "stopping_time", 0));
  if (!strcmp(name, "harmonic")) return sph_term_harmonic(get_number(map, "omega", 0));
  get_vector(map, "acceleration", g);
  return sph_term_gravity(g);
}

sph_term sph_case_build_term(const sph_case_node *map)
{
  return sph_term_corrected(plain_term(map), get_text(map, "correction", NULL));
}

static int add_term(const builder *b, const sph_case_node *map)
{
  int status = SPH_OK;
  if (sph_case_source_is(map))
    status = sph_case_source_add(b->c, b->sim, map, b->error);
  else
    sph_sim_add_term(b->sim, sph_case_build_term(map));
  if (!status) status = told(b, map);
  if (status || !child_of(map, "part")) return status;
  sph_sim_set_part(b->sim, map->key, get_text(map, "part", NULL));
  return told(b, child_of(map, "part"));
}

/* Behind the terms: of each scale, does its group integrate that? */
static int check_scales(const builder *b, const sph_case_node *map)
{
  static const char *const energies[][2] = {{"energy", "u"},
                                            {"total_energy", "total"},
                                            {"entropic_function", "entropy"},
                                            {"temperature", "temperature"}};
  const sph_case_node *scales = child_of(map, "scales"), *one = scales ? scales->first : NULL;
  const char *energy = sph_group_energy(sph_sim_group(b->sim, map->key));
  const int summed = child_of(child_of(b->c->root, "terms"), "summation") != NULL;
  for (; one; one = one->next) {
    int right = !strcmp(one->key, "density") ? !summed : 1;
    for (int k = 0; k < 4; k++)
      if (!strcmp(one->key, energies[k][0])) right = !strcmp(energy, energies[k][1]);
    if (right) continue;
    return sph_case_schema_fail(b->c, b->error, one, 0, 0,
                                "%s: a scale of what %s does not integrate (its density is %s, its "
                                "energy: %s)",
                                one->key, map->key, summed ? "a sum" : "integrated", energy);
  }
  return SPH_OK;
}

static int add_reset(const builder *b, const sph_case_node *map)
{
  sph_sim_reset_density(b->sim, get_text(map, "kind", NULL), (long)get_number(map, "every", 0));
  return told(b, map);
}

static sph_integrator_def integrator_of(const sph_case_node *map)
{
  int control = get_number(map, "error_control", 1) != 0;
  const char *method = get_text(map, "method", NULL);
  int fast = method && !strncmp(method, "mri:", 4); /* it has a fast part, with errors of its own */
  return (sph_integrator_def){
      .method = method,
      .cfl = get_number(map, "cfl", 0),
      .tolerance = control ? get_number(map, "tolerance", 0) : -1,
      .controller = get_text(map, "controller", NULL),
      .stage_tolerance = get_number(map, "stage_tolerance", 0),
      .linear = get_text(map, "linear", NULL),
      .fast_method = get_text(map, "fast_method", NULL),
      .fast_step = get_number(map, "fast_step", 0),
      .fast_tolerance = get_number(map, "fast_tolerance", control || !fast ? 0 : -1),
      .relax = get_text(map, "relax", NULL),
      .dt_max = get_number(map, "dt_max", 0),
      .dt_min = get_number(map, "dt_min", 0),
      .dt_fixed = get_number(map, "dt_fixed", 0),
      .retries = (int)get_number(map, "retries", 0),
  };
}

void sph_case_build_integrator(const sph_case *c, sph_integrator_def *def)
{
  static const sph_integrator_def none;
  if (def) *def = c ? integrator_of(child_of(c->root, "integrator")) : none;
}

static int set_integrator(const builder *b, const sph_case_node *map)
{
  sph_integrator_def def = integrator_of(map);
  sph_sim_set_integrator(b->sim, &def);
  return told(b, map);
}

static sph_sim_def sim_def(const sph_case *c, int threads)
{
  const sph_case_node *kernel = child_of(c->root, "kernel"),
                      *periodic = child_of(c->root, "periodic");
  sph_sim_def def = {
      .dim = c->dim,
      .dx = get_number(c->root, "spacing", 0),
      .kernel = get_text(kernel, "name", NULL),
      .h_over_dx = get_number(kernel, "h_over_dx", 0),
      .search = get_text(c->root, "search", NULL),
      .precision = get_text(child_of(c->root, "run"), "precision", NULL),
      .threads = threads > 0 ? threads : (int)get_number(child_of(c->root, "run"), "threads", 1),
      .speed = get_number(c->root, "speed", 0),
  };
  if (!periodic) return def;
  double upper[3];
  get_vector(periodic, "lower", def.origin);
  get_vector(periodic, "upper", upper);
  for (int d = 0; d < 3; d++) def.length[d] = upper[d] - def.origin[d];
  for (const sph_case_node *axis = child_of(periodic, "axes")->first; axis; axis = axis->next)
    def.periodic[axis_of(axis->text)] = 1;
  return def;
}

static int build_parts(builder *b)
{
  const sph_case_node *root = b->c->root, *node;
  int status = told(b, child_of(root, "spacing"));
  for (node = child_of(root, "groups")->first; node && !status; node = node->next)
    status = build_group(b, node);
  for (node = child_of(root, "terms")->first; node && !status; node = node->next)
    status = add_term(b, node);
  if (!status) status = sph_case_scalar_add(b->c, b->sim, b->error);
  for (node = child_of(root, "groups")->first; node && !status; node = node->next)
    status = check_scales(b, node);
  if (!status && (node = child_of(root, "density_reset"))) status = add_reset(b, node);
  if (!status) status = set_integrator(b, child_of(root, "integrator"));
  for (node = child_of(root, "groups")->first; node && !status; node = node->next)
    status = set_initial(b, node);
  return status ? status : sph_case_event_add(b->c, b->sim, &b->motions, b->error);
}

sph_sim *sph_case_build(const sph_case *c, int threads, sph_error *error)
{
  sph_error own = {0};
  builder b = {.c = c, .error = error ? error : &own};
  if (!c) sph_error_set(b.error, SPH_ERR_ARGUMENT, "a simulation of no case (NULL)");
  if (!c || b.error->status) return NULL;
  sph_sim_def def = sim_def(c, threads);
  b.sim = sph_sim_create(&def);
  if (!b.sim)
    sph_error_set(b.error, SPH_ERR_MEMORY, "out of memory: the simulation of %s", c->path);
  if (b.sim && build_parts(&b) == SPH_OK) return b.sim;
  sph_sim_free(b.sim);
  return NULL;
}

/* ---- checkpoints */

void sph_case_build_checkpoints(const sph_case *c, sph_sim *sim, const char *directory,
                                const char *command)
{
  const sph_case_node *map = c ? child_of(c->root, "checkpoint") : NULL;
  const char *set[SPH_CASE_SETS];
  int sets = 0;
  if (!c) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "checkpoints of no case (NULL)");
    return;
  }
  if (get_number(map, "keep", 2) == 0) return;
  while (sets < SPH_CASE_SETS && sph_case_set(c, sets)) set[sets] = sph_case_set(c, sets), sets++;
  char *path = realpath(c->path, NULL); /* where the files of the case are, wherever we are then */
  const sph_checkpoint_def def = {.directory = directory,
                                  .steps = (long)get_number(map, "steps", 0),
                                  .interval = get_number(map, "interval", 0),
                                  .wall = get_number(map, "wall", 0),
                                  .keep = (int)get_number(map, "keep", 2),
                                  .case_path = path ? path : c->path,
                                  .case_text = sph_case_source(c),
                                  .command = command,
                                  .sets = sets,
                                  .set = set};
  sph_checkpoint_set(sim, &def);
  free(path);
}
