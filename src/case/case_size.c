/* What a run will write: how many frames, and how large one is, from one that is made. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_build.h"
#include "file.h"
#include "memory.h"
#include "sphode/case.h"
#include "sphode/checkpoint.h"

#define get_number sph_case_reader_number
#define child_of sph_case_reader_find

static const double MOST_FRAMES = 1e6; /* in one step, as in a run */

typedef struct writing {
  const sph_case *c;
  sph_sim *sim;
  const char *directory;
  sph_error *error;
} writing;

/* Frames of the whole run; node: what is blamed where they are too many. */
static int count(const writing *w, const sph_case_node *node, const char *key, sph_case_size *size)
{
  sph_sim_stats stats;
  sph_sim_get_stats(w->sim, &stats);
  const double step = stats.step.dt_largest;
  size->frames = floor(sph_case_end(w->c) / size->interval * (1 + 1e-12)) + 1;
  if (step <= MOST_FRAMES * size->interval) return SPH_OK;
  return sph_case_schema_fail(w->c, w->error, node, 1, 0,
                              "%s: %g s is too short for steps of %.3g s; right is at least %.2g s",
                              key, size->interval, step, step / MOST_FRAMES);
}

static int of_snapshots(const writing *w, sph_case_size *size)
{
  const sph_hdf5_def def = sph_case_build_output_hdf5(w->c, w->directory, NULL);
  const sph_case_node *output = child_of(w->c->root, "output");
  const sph_case_node *node = child_of(output, "snapshots");
  snprintf(size->name, sizeof size->name, "snapshots");
  size->interval = def.interval;
  int status = count(w, node ? node : output, "snapshots", size);
  size->bytes = NAN;
  if (!status) status = sph_case_build_output_fields(w->c, w->sim, w->error);
  if (!w->directory) return status;
  const long bytes = status ? status : sph_output_hdf5_size(w->sim, &def, w->error);
  size->bytes = (double)bytes;
  return bytes < 0 ? (int)bytes : SPH_OK;
}

/* Bytes of the last frame of a table: of the second half of its rows, where there are two. */
static double last_frame(const char *text, size_t size)
{
  long rows = -1, row = -1; /* the first line names the columns */
  size_t from = size;
  for (size_t k = 0; k < size; k++) rows += text[k] == '\n';
  for (size_t k = 0; k < size && from == size; k++)
    if (text[k] == '\n' && ++row == (rows > 1 ? rows / 2 : 0)) from = k + 1;
  return (double)(size - from);
}

/* probe: NULL: the series. */
static int of_table(const writing *w, const sph_case_node *probe, sph_case_size *size)
{
  const sph_case_node *output = child_of(w->c->root, "output");
  const sph_case_node *own = child_of(probe, "interval"), *series = child_of(output, "series");
  char path[SPH_PATH], *text = NULL;
  size_t length = 0;
  if (probe)
    snprintf(size->name, sizeof size->name, "probe_%.64s.csv", probe->key);
  else
    snprintf(size->name, sizeof size->name, "series.csv");
  size->interval = sph_case_build_output_interval(w->c, probe);
  int status = count(w, own ? own : series ? series : output, own ? "interval" : "series", size);
  size->bytes = NAN;
  if (!w->directory) return status;
  if (!status) status = sph_file_path(path, w->directory, size->name, w->error);
  if (!status) status = sph_file_read(path, &text, &length, w->error);
  if (!status) size->bytes = last_frame(text, length);
  sph_memory_free(text);
  return status;
}

/* The one that is being written stands beside those that stay. */
static int of_checkpoints(const writing *w, sph_case_size *size)
{
  const sph_case_node *map = child_of(w->c->root, "checkpoint");
  snprintf(size->name, sizeof size->name, "checkpoints");
  size->frames = get_number(map, "keep", 2);
  size->bytes = NAN;
  if (!w->directory) return SPH_OK;
  sph_case_build_checkpoints(w->c, w->sim, w->directory, NULL);
  const long bytes = sph_checkpoint_size(w->sim);
  size->bytes = (double)bytes;
  if (bytes >= 0) return SPH_OK;
  return sph_error_set(w->error, (int)bytes, "%s", sph_sim_error(w->sim));
}

int sph_case_size_get(const sph_case *c, sph_sim *sim, const char *directory, int k,
                      sph_case_size *size, sph_error *error)
{
  sph_error own = {0};
  sph_case_size unused;
  const writing w = {c, sim, directory, error ? error : &own};
  if (!c || !sim)
    return sph_error_set(w.error, SPH_ERR_ARGUMENT, "what a run writes: no %s (NULL)",
                         c ? "simulation" : "case");
  if (!size) size = &unused;
  *size = (sph_case_size){.name = ""};
  const sph_case_node *probes = child_of(child_of(c->root, "output"), "probes"), *probe = NULL;
  const int keep = get_number(child_of(c->root, "checkpoint"), "keep", 2) > 0;
  int n = 2, status;
  for (const sph_case_node *p = probes ? probes->first : NULL; p; p = p->next, n++)
    if (n == k) probe = p;
  if (k < 0 || k > n || (k == n && !keep)) return 0;
  if (k == 0)
    status = of_snapshots(&w, size);
  else if (k < n)
    status = of_table(&w, probe, size);
  else
    status = of_checkpoints(&w, size);
  return status ? status : 1;
}
