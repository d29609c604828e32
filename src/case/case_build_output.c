/* Outputs of a case: snapshots, the time series and what its columns are, probes, events. */
#include <math.h>
#include <string.h>

#include "case_build.h"
#include "case_schema.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/case.h"

#define get_text sph_case_reader_text
#define get_number sph_case_reader_number
#define get_vector sph_case_reader_vector
#define child_of sph_case_reader_find

enum { MOST = 64 };

/* The outputs of a case being built. */
typedef struct builder {
  const sph_case *c;
  sph_sim *sim;
  const char *directory;
  int trial; /* frames of the start and the end alone */
} builder;

/* What is wrong with a node, told once the simulation is run. */
static void fail(const builder *b, const sph_case_node *node, const char *what)
{
  sph_error error = {0};
  sph_case_schema_fail(b->c, &error, node, 0, 0, "%s", what);
  sph_sim_fail(b->sim, SPH_ERR_PARSE, "%s", error.text);
}

static const sph_case_node *first_of(const sph_case_node *map, const char *key)
{
  const sph_case_node *list = child_of(map, key);
  return list ? list->first : NULL;
}

/* Between frames of a probe; NULL: of the series [s]. */
static double interval_of(const builder *b, const sph_case_node *probe)
{
  return b->trial ? INFINITY : sph_case_build_output_interval(b->c, probe);
}

static int monitors(const builder *b, const sph_case_node *output, sph_monitor to[MOST])
{
  int n = 0;
  for (const sph_case_node *node = first_of(output, "monitors"); node; node = node->next) {
    if (n == MOST) {
      fail(b, node, "more than 64 monitors");
      return n;
    }
    sph_monitor *m = &to[n++];
    *m = (sph_monitor){.name = node->key,
                       .type = get_text(node, "type", NULL),
                       .group = get_text(node, "group", NULL),
                       .axis = get_text(node, "axis", "x")[0] - 'x'};
    get_vector(node, "at", m->x);
    get_vector(node, "extent", m->extent);
  }
  return n;
}

static void add_series(const builder *b, const sph_case_node *output)
{
  sph_monitor monitor[MOST];
  sph_series_force force[MOST];
  sph_series_def def = {.directory = b->directory,
                        .interval = interval_of(b, NULL),
                        .monitors = monitors(b, output, monitor),
                        .monitor = monitor,
                        .force = force,
                        .powers = get_number(output, "powers", 0) != 0};
  for (const sph_case_node *node = first_of(output, "forces"); node; node = node->next) {
    if (def.forces == MOST)
      fail(b, node, "more than 64 forces");
    else {
      force[def.forces].wall = node->key;
      get_vector(node, "about", force[def.forces++].about);
    }
  }
  sph_sim_add_output(b->sim, sph_output_series_def(&def));
}

/* ---- probes */

static void set_line(const sph_case_node *line, sph_probe_def *def)
{
  get_vector(line, "from", def->from);
  get_vector(line, "to", def->along);
  for (int d = 0; d < 3; d++) def->along[d] -= def->from[d];
  def->n[0] = (long)get_number(line, "n", 2);
}

static void set_plane(const sph_case_node *plane, sph_probe_def *def)
{
  get_vector(plane, "corner", def->from);
  get_vector(plane, "along", def->along);
  get_vector(plane, "across", def->across);
  for (int d = 0; d < 3; d++) def->along[d] -= def->from[d], def->across[d] -= def->from[d];
  def->n[0] = (long)get_number(plane, "n_along", 2);
  def->n[1] = (long)get_number(plane, "n_across", 2);
}

/* [n][3] of a list of points, to be freed; NULL: told. */
static double *places(const builder *b, const sph_case_node *points, long *n)
{
  sph_error error = {0};
  *n = 0;
  for (const sph_case_node *point = points->first; point; point = point->next) ++*n;
  double *x = SPH_NEW(double, 3 * *n + 1, "points of a probe", &error), *to = x;
  for (const sph_case_node *point = points->first; x && point; point = point->next, to += 3)
    get_vector(point, "at", to);
  if (!x) sph_sim_fail(b->sim, error.status, "%s", error.text);
  return x;
}

static void add_probe(const builder *b, const sph_case_node *node)
{
  sph_probe_def def = {.directory = b->directory,
                       .name = node->key,
                       .interval = interval_of(b, node),
                       .fields = get_text(node, "fields", NULL),
                       .group = get_text(node, "group", NULL)};
  double *x = NULL;
  get_vector(node, "at", def.from);
  if (child_of(node, "line")) set_line(child_of(node, "line"), &def);
  if (child_of(node, "plane")) set_plane(child_of(node, "plane"), &def);
  if (child_of(node, "points")) def.x = x = places(b, child_of(node, "points"), &def.points);
  sph_sim_add_output(b->sim, sph_output_probe(&def));
  sph_memory_free(x);
}

int sph_case_build_output_fields(const sph_case *c, const sph_sim *sim, sph_error *error)
{
  const sph_case_node *fields = child_of(child_of(c->root, "output"), "fields");
  sph_error own = {0};
  if (!fields || !sph_snapshot_check_fields(sim, fields->text, &own)) return SPH_OK;
  return sph_case_schema_fail(c, error, fields, 1, 0, "%s", own.text);
}

void sph_case_build_outputs(const sph_case *c, sph_sim *sim, const char *directory,
                            const char *command)
{
  if (!c) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "outputs of no case (NULL)");
    return;
  }
  const sph_hdf5_def def = sph_case_build_output_hdf5(c, directory, command);
  sph_error error = {0};
  const int status = sph_case_build_output_fields(c, sim, &error);
  if (status) sph_sim_fail(sim, status, "%s", error.text);
  sph_sim_add_output(sim, sph_output_hdf5_def(&def));
  sph_case_build_series(c, sim, directory);
}

sph_hdf5_def sph_case_build_output_hdf5(const sph_case *c, const char *directory,
                                        const char *command)
{
  const sph_case_node *output = child_of(c->root, "output");
  const int compression = (int)get_number(output, "compression", 1);
  return (sph_hdf5_def){.directory = directory,
                        .interval = get_number(output, "snapshots", sph_case_end(c) / 20),
                        .case_text = sph_case_text(c),
                        .fields = get_text(output, "fields", NULL),
                        .single = !strcmp(get_text(output, "precision", "double"), "single"),
                        .compression = compression > 0 ? compression : -1,
                        .command = command};
}

double sph_case_build_output_interval(const sph_case *c, const sph_case_node *probe)
{
  const sph_case_node *output = child_of(c->root, "output");
  return get_number(probe, "interval", get_number(output, "series", sph_case_end(c) / 500));
}

static void build_small(const sph_case *c, sph_sim *sim, const char *directory, int trial)
{
  if (!c) {
    sph_sim_fail(sim, SPH_ERR_ARGUMENT, "outputs of no case (NULL)");
    return;
  }
  const sph_case_node *output = child_of(c->root, "output");
  const builder b = {.c = c, .sim = sim, .directory = directory, .trial = trial};
  add_series(&b, output);
  for (const sph_case_node *node = first_of(output, "probes"); node; node = node->next)
    add_probe(&b, node);
  if (child_of(c->root, "events")) sph_sim_add_output(sim, sph_output_events(directory));
}

void sph_case_build_series(const sph_case *c, sph_sim *sim, const char *directory)
{
  build_small(c, sim, directory, 0);
}

void sph_case_build_output_trial(const sph_case *c, sph_sim *sim, const char *directory)
{
  build_small(c, sim, directory, 1);
}
