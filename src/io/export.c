#include "export_format.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "file.h"
#include "frames.h"
#include "memory.h"
#include "snapshot.h"
#include "words.h"

static const char *const formats[] = {"csv", "vtu", "gadget", "splash"};
static const char *const endings[] = {"csv", "vtu", "hdf5", "txt"};
enum { CSV, VTU, GADGET, SPLASH, FORMATS };
static void (*const write_table[FORMATS])(const sph_table *table, int single, sph_text *text) = {
    [CSV] = sph_export_csv, [VTU] = sph_export_vtu, [SPLASH] = sph_export_splash};
static const char *const parts[SPH_PARTS] = {"snapshot", "walls"};

typedef struct exporter {
  const sph_export_def *def;
  int format;
  sph_text index[SPH_PARTS]; /* entries of the .pvd; of CSV: times.csv, the first alone */
  sph_error *error;
} exporter;

const char *sph_export_format(int k) { return k >= 0 && k < FORMATS ? formats[k] : NULL; }

static int write_text(exporter *e, const char *name, sph_text *text)
{
  char path[SPH_PATH];
  int status = sph_error_set(e->error, text->error.status, "%s", text->error.text);
  if (!status) status = sph_file_path(path, e->def->directory, name, e->error);
  if (!status) status = sph_file_replace(path, text->data, text->length, e->error);
  sph_text_free(text);
  return status;
}

static void add_entry(exporter *e, int part, const char *name, double time)
{
  if (e->format == CSV) sph_text_add(&e->index[0], "%s,%.15g\n", name, time);
  if (e->format == VTU)
    sph_text_add(&e->index[part], "<DataSet timestep=\"%.17g\" file=\"%s\"/>\n", time, name);
}

static int write_tables(exporter *e, long number, const sph_table table[SPH_PARTS])
{
  int status = SPH_OK;
  for (int part = 0; part < SPH_PARTS && !status; part++) {
    char name[64];
    sph_text text = {0};
    if (table[part].n == 0) continue;
    snprintf(name, sizeof name, "%s_%04ld.%s", parts[part], number, endings[e->format]);
    write_table[e->format](&table[part], e->def->single, &text);
    status = write_text(e, name, &text);
    add_entry(e, part, name, table[part].time);
  }
  return status;
}

static int write_gadget(exporter *e, const char *path, long number,
                        const sph_table table[SPH_PARTS])
{
  char name[64], to[SPH_PATH];
  size_t size = 0;
  snprintf(name, sizeof name, "snapshot_%04ld.hdf5", number);
  int status = sph_file_path(to, e->def->directory, name, e->error);
  if (status) return status;
  void *image = sph_export_gadget(path, table, e->def->single, &size, e->error);
  status = image ? sph_file_replace(to, image, size, e->error) : e->error->status;
  sph_memory_free(image);
  return status;
}

/* Walls have fewer fields than fluids: what they lack of the wanted ones they do without. */
static int read_walls(const exporter *e, const char *path, sph_table *walls, sph_error *why)
{
  const char *wanted = e->def->fields;
  int status = sph_table_read(walls, path, SPH_WALLS, NULL, why), kept = 0;
  for (int k = 0; k < walls->fields; k++) {
    sph_table_field *f = &walls->field[k];
    if (!wanted || !strcmp(f->name, "position") || sph_table_listed(wanted, f->name))
      walls->field[kept++] = *f;
    else
      sph_memory_free(f->data);
  }
  walls->fields = kept;
  return status;
}

static int read_tables(const exporter *e, const char *path, sph_table table[SPH_PARTS],
                       sph_error *why)
{
  int status = sph_table_read(&table[SPH_FLUIDS], path, SPH_FLUIDS, e->def->fields, why);
  return status ? status : read_walls(e, path, &table[SPH_WALLS], why);
}

/* 1: it was exported; 0: it cannot be read, and is left out. */
static int export_one(exporter *e, const char *path, long number, const sph_left_out *left_out)
{
  sph_table table[SPH_PARTS] = {{0}};
  sph_error why = {0};
  int status = SPH_OK;
  const int bad = read_tables(e, path, table, &why);
  if (bad)
    status = sph_frames_leave(left_out, &why, e->error);
  else
    status = sph_file_make_directory(e->def->directory, e->error);
  if (!status && !bad && e->format == GADGET) status = write_gadget(e, path, number, table);
  if (!status && !bad && e->format != GADGET) status = write_tables(e, number, table);
  for (int part = 0; part < SPH_PARTS; part++) sph_table_free(&table[part]);
  return status ? status : !bad;
}

static int write_index(exporter *e, int part)
{
  sph_text text = {0}, *entries = &e->index[part];
  char name[64];
  if (!entries->length && !entries->error.status) return SPH_OK;
  if (e->format == CSV)
    sph_text_add(&text, "file,time [s]\n%s", entries->data ? entries->data : "");
  else
    sph_text_add(&text,
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n"
                 "<Collection>\n%s</Collection>\n</VTKFile>\n",
                 entries->data ? entries->data : "");
  snprintf(name, sizeof name, "%s.pvd", parts[part]);
  if (entries->error.status) text.error = entries->error;
  return write_text(e, e->format == CSV ? "times.csv" : name, &text);
}

static int export_all(exporter *e)
{
  long *number = NULL;
  char path[SPH_PATH];
  int count = sph_frames_list(e->def->path, &number, e->error), exported = 0;
  int status = count < 0 ? count : SPH_OK;
  if (count == 0)
    status = sph_error_set(e->error, SPH_ERR_FILE, "%s: no snapshots (snapshot_0000.hdf, ...)",
                           e->def->path);
  if (!status)
    status = sph_frames_missing(e->def->path, number, count, &e->def->left_out, e->error);
  for (int k = 0; k < count && status >= 0; k++) {
    status = sph_frames_path(path, e->def->path, number[k], e->error);
    if (!status) status = export_one(e, path, number[k], &e->def->left_out);
    if (status > 0) exported++;
  }
  sph_memory_free(number);
  if (status < 0) return status;
  return exported ? exported
                  : sph_error_set(e->error, SPH_ERR_FILE, "%s: none of its snapshots can be read",
                                  e->def->path);
}

static int check(exporter *e)
{
  const sph_export_def *def = e->def;
  if (!def) return sph_error_set(e->error, SPH_ERR_ARGUMENT, "export: no definition (NULL)");
  sph_words words = {.wanted = def->format ? def->format : ""};
  int known = 0;
  for (int k = 0; k < FORMATS; k++) {
    if (!strcmp(words.wanted, formats[k])) e->format = k, known = 1;
    sph_words_add(&words, formats[k]);
  }
  if (!known)
    return sph_error_set(e->error, SPH_ERR_ARGUMENT, "export: format \"%.60s\"; %sknown: %s",
                         words.wanted, words.nearest, words.known);
  if (!def->path || !*def->path)
    return sph_error_set(e->error, SPH_ERR_ARGUMENT, "export: of no file or directory");
  return SPH_OK;
}

int sph_export(const sph_export_def *def, sph_error *error)
{
  sph_error own = {0};
  exporter e = {.def = def, .error = error ? error : &own};
  struct stat info;
  int status = check(&e);
  if (status || !def) return status;
  const int folder = stat(def->path, &info) == 0 && S_ISDIR(info.st_mode);
  const long number = sph_frames_number(def->path);
  int count = folder ? export_all(&e) : export_one(&e, def->path, number > 0 ? number : 0, NULL);
  for (int part = 0; part < SPH_PARTS; part++) {
    status = count > 0 ? write_index(&e, part) : SPH_OK;
    if (status) count = status;
    sph_text_free(&e.index[part]);
  }
  return count;
}
