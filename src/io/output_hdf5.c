#include <stdio.h>
#include <string.h>

#include "file.h"
#include "memory.h"
#include "snapshot.h"
#include "sphode/output.h"
#include "text.h"

typedef struct context {
  sph_error error; /* of the constructor; told by open */
  char *directory, *case_text, *command;
  sph_text index[SPH_PARTS]; /* the entries of the .series files so far */
  long frames;
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
  (void)sim;
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: an HDF5 output");
  if (c->error.status != SPH_OK) return sph_error_set(error, c->error.status, "%s", c->error.text);
  int status = sph_file_make_directory(c->directory, error);
  for (int part = 0; status == SPH_OK && part < SPH_PARTS; part++)
    sph_file_remove_stale(c->directory, base[part]);
  c->frames = 0;
  return status;
}

/* ParaView's list of files with their times, written anew with every frame: always complete. */
static int write_index(context *c, int part, const char *name, double time, sph_error *error)
{
  char series[40], path[SPH_PATH];
  sph_text text = {0}, *entries = &c->index[part];
  snprintf(series, sizeof series, "%s.hdf.series", base[part]);
  sph_text_add(entries, "%s\n  {\"name\": \"%s\", \"time\": ", entries->length ? "," : "", name);
  sph_text_json_number(entries, time);
  sph_text_add(entries, "}");
  sph_text_add(&text, "{\n\"file-series-version\": \"1.0\",\n\"files\": [%s\n]\n}\n",
               entries->data ? entries->data : "");
  const sph_error *failure = entries->error.status != SPH_OK ? &entries->error : &text.error;
  int status = sph_error_set(error, failure->status, "%s", failure->text);
  if (status == SPH_OK) status = sph_file_path(path, c->directory, series, error);
  if (status == SPH_OK) status = sph_file_replace(path, text.data, text.length, error);
  sph_text_free(&text);
  return status;
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
  char name[SPH_PARTS][40];
  size_t size = 0;
  for (int part = 0; part < SPH_PARTS; part++)
    snprintf(name[part], sizeof name[part], "%s_%04ld.hdf", base[part], c->frames);
  void *image = sph_snapshot_image(name[0], sim, c->case_text, c->command, &size, error);
  int status = write_image(c, name[0], image, size, error);
  if (status == SPH_OK) status = write_index(c, SPH_FLUIDS, name[0], sph_sim_time(sim), error);
  if (status == SPH_OK && has_walls(sim)) {
    image = sph_snapshot_image_walls(name[0], &size, error);
    status = write_image(c, name[1], image, size, error);
    if (status == SPH_OK) status = write_index(c, SPH_WALLS, name[1], sph_sim_time(sim), error);
  }
  if (status == SPH_OK) c->frames++;
  return status;
}

static void free_hdf5(void *ctx)
{
  context *c = ctx;
  if (!c) return;
  for (int part = 0; part < SPH_PARTS; part++) sph_text_free(&c->index[part]);
  sph_memory_free(c->directory);
  sph_memory_free(c->case_text);
  sph_memory_free(c->command);
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
  }
  return (sph_output){.name = "hdf5",
                      .interval = def->interval,
                      .open = open_hdf5,
                      .frame = frame_hdf5,
                      .ctx = c,
                      .free = free_hdf5};
}

sph_output sph_output_hdf5(const char *directory, double interval)
{
  return sph_output_hdf5_def(&(sph_hdf5_def){.directory = directory, .interval = interval});
}
