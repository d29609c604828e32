#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "file.h"
#include "keep.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/output.h"
#include "text.h"

typedef struct context {
  sph_error error; /* of the constructor; told by open */
  char *directory, *case_text, *command, *fields;
  int single, compression;
  sph_text index[SPH_PARTS]; /* the entries of the .series files so far */
  long frames, room;
  double *time; /* [room] of the frames [s] */
} context;

static const char *const base[SPH_PARTS] = {"snapshot", "walls"};

static char *copy(const char *text, sph_error *error)
{
  return text ? sph_memory_string(text, error) : NULL;
}

static int has_walls(const sph_sim *sim)
{
  const sph_group *group;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (!strcmp(sph_group_kind(group), "wall") && sph_group_count(group) > 0) return 1;
  return 0;
}

static int open_hdf5(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: an HDF5 output");
  if (c->error.status != SPH_OK) return sph_error_set(error, c->error.status, "%s", c->error.text);
  int status = sph_snapshot_check_fields(sim, c->fields, error);
  if (!status) status = sph_file_make_directory(c->directory, error);
  for (int part = 0; status == SPH_OK && part < SPH_PARTS; part++)
    sph_file_remove_stale(c->directory, base[part]);
  c->frames = 0;
  return status;
}

static void file_name(char name[40], int part, long frame)
{
  snprintf(name, 40, "%s_%04ld.hdf", base[part], frame);
}

static void add_entry(context *c, int part, long frame, double time)
{
  char name[40];
  sph_text *entries = &c->index[part];
  file_name(name, part, frame);
  sph_text_add(entries, "%s\n  {\"name\": \"%s\", \"time\": ", entries->length ? "," : "", name);
  sph_text_json_number(entries, time);
  sph_text_add(entries, "}");
}

/* ParaView's list of files with their times, written anew with every frame: always complete. */
static int write_index(context *c, int part, sph_error *error)
{
  char series[40], path[SPH_PATH];
  sph_text text = {0}, *entries = &c->index[part];
  snprintf(series, sizeof series, "%s.hdf.series", base[part]);
  sph_text_add(&text, "{\n\"file-series-version\": \"1.0\",\n\"files\": [%s\n]\n}\n",
               entries->data ? entries->data : "");
  const sph_error *failure = entries->error.status != SPH_OK ? &entries->error : &text.error;
  int status = sph_error_set(error, failure->status, "%s", failure->text);
  if (status == SPH_OK) status = sph_file_path(path, c->directory, series, error);
  if (status == SPH_OK) status = sph_file_replace(path, text.data, text.length, error);
  sph_text_free(&text);
  return status;
}

static int note_time(context *c, double time, sph_error *error)
{
  if (c->frames == c->room) {
    long room = 2 * c->room + 64;
    if (sph_memory_grow((void **)&c->time, (size_t)c->room, (size_t)room, sizeof *c->time,
                        "times of snapshots", error))
      return SPH_ERR_MEMORY;
    c->room = room;
  }
  c->time[c->frames] = time;
  return SPH_OK;
}

/* Writes an image, frees it. */
static int write_image(context *c, const char *name, void *image, size_t size, sph_error *error)
{
  char path[SPH_PATH];
  int status = image ? sph_file_path(path, c->directory, name, error) : SPH_ERR_MEMORY;
  if (status == SPH_OK) status = sph_file_replace(path, image, size, error);
  sph_memory_free(image);
  return status;
}

static int frame_hdf5(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  const double time = sph_sim_time(sim);
  char name[SPH_PARTS][40];
  size_t size = 0;
  for (int part = 0; part < SPH_PARTS; part++) file_name(name[part], part, c->frames);
  const sph_hdf5_def def = {.case_text = c->case_text,
                            .command = c->command,
                            .single = c->single,
                            .compression = c->compression,
                            .fields = c->fields};
  if (note_time(c, time, error)) return SPH_ERR_MEMORY;
  void *image = sph_snapshot_image(name[0], sim, &def, &size, error);
  int status = write_image(c, name[0], image, size, error);
  if (status == SPH_OK) {
    add_entry(c, SPH_FLUIDS, c->frames, time);
    status = write_index(c, SPH_FLUIDS, error);
  }
  if (status == SPH_OK && has_walls(sim)) {
    image = sph_snapshot_image_walls(name[0], &size, error);
    status = write_image(c, name[1], image, size, error);
    add_entry(c, SPH_WALLS, c->frames, time);
    if (status == SPH_OK) status = write_index(c, SPH_WALLS, error);
  }
  if (status == SPH_OK) c->frames++;
  return status;
}

/* Frames from `first` on, written behind the checkpoint that the run goes on from, will be written
 * again. */
static void remove_from(const context *c, int part, long first)
{
  char name[40], path[SPH_PATH];
  for (long k = first;; k++) {
    file_name(name, part, k);
    if (sph_file_path(path, c->directory, name, NULL) || unlink(path) != 0) return;
  }
}

static int is_there(const context *c, int part, long k)
{
  char name[40], path[SPH_PATH];
  file_name(name, part, k);
  return !sph_file_path(path, c->directory, name, NULL) && access(path, F_OK) == 0;
}

static int go_on(context *c, const sph_sim *sim, sph_keep *keep, sph_error *error)
{
  int status = SPH_OK;
  long gone = 0;
  for (int part = 0; !status && part < SPH_PARTS; part++) {
    sph_file_remove_stale(c->directory, base[part]);
    sph_text_free(&c->index[part]);
    if (part == SPH_WALLS && !has_walls(sim)) continue;
    for (long k = 0; k < c->frames; k++)
      if (is_there(c, part, k))
        add_entry(c, part, k, c->time[k]);
      else
        gone += part == SPH_FLUIDS;
    remove_from(c, part, c->frames);
    if (c->frames) status = write_index(c, part, error);
  }
  if (gone)
    sph_keep_tell(keep, "%ld of %ld snapshots of %s are gone: %s.series names the others", gone,
                  c->frames, c->directory ? c->directory : ".", base[SPH_FLUIDS]);
  return status;
}

static int keep_hdf5(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  context *c = ctx;
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: an HDF5 output");
  int status = sph_error_set(error, c->error.status, "%s", c->error.text);
  if (!status) status = sph_keep_integer(keep, "written", 1, &c->frames);
  if (sph_keep_reading(keep)) {
    if (!status && c->frames < 0) status = sph_error_set(error, SPH_ERR_FILE, "frames < 0");
    if (status) return status;
    sph_memory_free(c->time);
    c->room = c->frames + 64;
    c->time = SPH_NEW(double, c->room, "times of snapshots", error);
    if (!c->time) return SPH_ERR_MEMORY;
  }
  if (!status) status = sph_keep_real(keep, "times", c->frames, c->time);
  return status || !sph_keep_reading(keep) ? status : go_on(c, sim, keep, error);
}

static void free_hdf5(void *ctx)
{
  context *c = ctx;
  if (!c) return;
  for (int part = 0; part < SPH_PARTS; part++) sph_text_free(&c->index[part]);
  sph_memory_free(c->time);
  sph_memory_free(c->directory);
  sph_memory_free(c->case_text);
  sph_memory_free(c->command);
  sph_memory_free(c->fields);
  sph_memory_free(c);
}

sph_output sph_output_hdf5_def(const sph_hdf5_def *def)
{
  static const sph_hdf5_def nothing;
  context *c = sph_memory_take(1, sizeof *c);
  if (c && !def)
    sph_error_set(&c->error, SPH_ERR_ARGUMENT, "an HDF5 output without a definition (NULL)");
  if (!def) def = &nothing;
  if (c) {
    c->directory = copy(def->directory, &c->error);
    c->case_text = copy(def->case_text, &c->error);
    c->command = copy(def->command, &c->error);
    c->fields = copy(def->fields, &c->error);
    c->single = def->single != 0;
    c->compression = def->compression;
    if (def->compression < -1 || def->compression > 9)
      sph_error_set(&c->error, SPH_ERR_ARGUMENT,
                    "an HDF5 output: compression %d; right is 1 to 9, 0 (1), -1 (none)",
                    def->compression);
  }
  return (sph_output){.name = "hdf5",
                      .interval = def->interval,
                      .open = open_hdf5,
                      .frame = frame_hdf5,
                      .keep = keep_hdf5,
                      .ctx = c,
                      .free = free_hdf5};
}

sph_output sph_output_hdf5(const char *directory, double interval)
{
  return sph_output_hdf5_def(&(sph_hdf5_def){.directory = directory, .interval = interval});
}

long sph_output_hdf5_size(sph_sim *sim, const sph_hdf5_def *def, sph_error *error)
{
  static const sph_hdf5_def nothing;
  char name[40];
  size_t size = 0, walls = 0;
  if (!sim)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "the size of a snapshot: no simulation (NULL)");
  if (!def) def = &nothing;
  int status = sph_snapshot_check_fields(sim, def->fields, error);
  if (status) return status;
  file_name(name, SPH_FLUIDS, 0);
  void *image = sph_snapshot_image(name, sim, def, &size, error);
  status = image ? SPH_OK : SPH_ERR_MEMORY;
  sph_memory_free(image);
  if (!status && has_walls(sim)) {
    image = sph_snapshot_image_walls(name, &walls, error);
    status = image ? SPH_OK : SPH_ERR_MEMORY;
    sph_memory_free(image);
  }
  return status ? status : (long)(size + walls);
}
