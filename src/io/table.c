#include "table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "h5.h"
#include "memory.h"
#include "snapshot.h"
#include "words.h"

typedef struct reader {
  sph_table *table;
  const char *path, *wanted;
  hid_t part; /* the group of one kind of particles */
  int number; /* its, of PartType0, ... */
  sph_error *error;
} reader;

int sph_table_listed(const char *list, const char *name)
{
  const size_t length = strlen(name);
  for (const char *at = list; *(at += strspn(at, " ,")); at += strcspn(at, " ,"))
    if (strcspn(at, " ,") == length && !strncmp(at, name, length)) return 1;
  return 0;
}

/* Sizes of a dataset of numbers; 0: it is none of particles. */
static int shape(hid_t set, hsize_t size[2], int *whole)
{
  hid_t space = H5Dget_space(set), type = H5Dget_type(set);
  const int rank = space >= 0 ? H5Sget_simple_extent_ndims(space) : 0;
  const H5T_class_t kind = type >= 0 ? H5Tget_class(type) : H5T_NO_CLASS;
  size[1] = 1;
  *whole = kind == H5T_INTEGER;
  int right = (rank == 1 || rank == 2) && (kind == H5T_INTEGER || kind == H5T_FLOAT) &&
              H5Sget_simple_extent_dims(space, size, NULL) >= 0;
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  return right && (size[1] == 1 || size[1] == 3);
}

static int take(reader *r, hid_t set, const char *name)
{
  sph_table *t = r->table;
  sph_table_field *field = &t->field[t->fields];
  hsize_t size[2];
  int whole;
  if (!shape(set, size, &whole)) return SPH_OK; /* a table of something else */
  if (t->fields > 0 && size[0] != (hsize_t)t->n)
    return sph_error_set(r->error, SPH_ERR_FILE, "%s: %s has %ld entries, other fields have %ld",
                         r->path, name, (long)size[0], t->n);
  if (t->fields == SPH_TABLE_FIELDS)
    return sph_error_set(r->error, SPH_ERR_FILE, "%s: more than %d fields", r->path,
                         SPH_TABLE_FIELDS);
  t->n = (long)size[0];
  *field = (sph_table_field){.columns = (int)size[1], .whole = whole};
  snprintf(field->name, sizeof field->name, "%s", name);
  if (sph_h5_read_string(set, "unit", field->unit, sizeof field->unit)) field->unit[0] = '\0';
  field->data = sph_memory_new((size_t)(size[0] * size[1]) + 1, sizeof(double), name, r->error);
  if (!field->data) return SPH_ERR_MEMORY;
  t->fields++;
  if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, field->data) >= 0)
    return SPH_OK;
  return sph_error_set(r->error, SPH_ERR_FILE, "%s: %s cannot be read", r->path, name);
}

static herr_t visit(hid_t part, const char *dataset, const H5L_info_t *info, void *ctx)
{
  reader *r = ctx;
  const char *name = sph_snapshot_field(dataset);
  (void)info;
  if (r->wanted && strcmp(name, "position") != 0 && !sph_table_listed(r->wanted, name)) return 0;
  hid_t set = H5Dopen2(part, dataset, H5P_DEFAULT);
  if (set < 0) return 0; /* a group */
  int status = take(r, set, name);
  H5Dclose(set);
  return status;
}

static int order(const void *a, const void *b)
{
  static const char *const first[] = {"position", "velocity"};
  const sph_table_field *x = a, *y = b;
  for (int k = 0; k < 2; k++) {
    const int one = !strcmp(x->name, first[k]), two = !strcmp(y->name, first[k]);
    if (one != two) return two - one;
  }
  return strcmp(x->name, y->name);
}

static herr_t add_word(hid_t part, const char *dataset, const H5L_info_t *info, void *words)
{
  (void)part, (void)info;
  sph_words_add(words, sph_snapshot_field(dataset));
  return 0;
}

int sph_table_unknown(hid_t part, const char *path, const char *field, sph_error *error)
{
  sph_words words = {.wanted = field};
  if (part >= 0) H5Literate(part, H5_INDEX_NAME, H5_ITER_INC, NULL, add_word, &words);
  return sph_error_set(error, SPH_ERR_ARGUMENT, "%s: no field \"%.60s\"; %sit has: %s", path, field,
                       words.nearest, words.known);
}

/* Which of the wanted fields is in none of the particles. */
static int missing(const reader *r)
{
  char word[SPH_TABLE_NAME];
  for (const char *at = r->wanted; at && *(at += strspn(at, " ,")); at += strcspn(at, " ,")) {
    snprintf(word, sizeof word, "%.*s", (int)strcspn(at, " ,"), at);
    if (!sph_table_find(r->table, word)) return sph_table_unknown(r->part, r->path, word, r->error);
  }
  return SPH_OK;
}

/* MassTable[part] of the header. */
static void read_mass(reader *r, hid_t header)
{
  double mass[6];
  hid_t attribute = H5Aopen(header, "MassTable", H5P_DEFAULT);
  hid_t space = attribute >= 0 ? H5Aget_space(attribute) : -1;
  if (space >= 0 && r->number < 6 && H5Sget_simple_extent_npoints(space) == 6 &&
      H5Aread(attribute, H5T_NATIVE_DOUBLE, mass) >= 0)
    r->table->mass = mass[r->number];
  if (space >= 0) H5Sclose(space);
  if (attribute >= 0) H5Aclose(attribute);
}

static void read_header(reader *r, hid_t file)
{
  hid_t header = H5Gopen2(file, "Header", H5P_DEFAULT);
  double time = 0, dim = 0;
  if (header >= 0) {
    sph_h5_read_real(header, "Time", &time);
    sph_h5_read_real(header, "Dimension", &dim);
    read_mass(r, header);
    H5Gclose(header);
  }
  r->table->time = time;
  r->table->dim = dim >= 1 && dim <= 3 ? (int)dim : 0;
}

static int read_part(reader *r, hid_t file, const char *name)
{
  read_header(r, file);
  if (H5Lexists(file, name, H5P_DEFAULT) <= 0) return SPH_OK;
  r->part = H5Gopen2(file, name, H5P_DEFAULT);
  if (r->part < 0) return sph_error_set(r->error, SPH_ERR_FILE, "%s: no group %s", r->path, name);
  H5Literate(r->part, H5_INDEX_NAME, H5_ITER_INC, NULL, visit, r);
  qsort(r->table->field, (size_t)r->table->fields, sizeof *r->table->field, order);
  if (!r->error->status) missing(r);
  H5Gclose(r->part);
  const sph_table_field *x = sph_table_find(r->table, "position");
  if (!r->error->status && (!x || x->columns != 3))
    return sph_error_set(r->error, SPH_ERR_FILE, "%s: %s has no Coordinates[n][3]", r->path, name);
  return r->error->status;
}

int sph_table_read(sph_table *table, const char *path, int part, const char *wanted,
                   sph_error *error)
{
  sph_h5 h5;
  sph_error own = {0};
  reader r = {.table = table, .path = path, .wanted = wanted, .number = part, .error = &own};
  char name[32];
  *table = (sph_table){0};
  snprintf(name, sizeof name, "PartType%d", part);
  sph_h5_enter(&h5);
  hid_t file = sph_h5_open(path, &own);
  if (file >= 0) {
    read_part(&r, file, name);
    H5Fclose(file);
  }
  sph_h5_leave(&h5);
  if (!own.status) return SPH_OK;
  sph_table_free(table);
  return sph_error_set(error, own.status, "%s", own.text);
}

const sph_table_field *sph_table_find(const sph_table *table, const char *name)
{
  for (int k = 0; k < table->fields; k++)
    if (!strcmp(table->field[k].name, name)) return &table->field[k];
  return NULL;
}

void sph_table_free(sph_table *table)
{
  for (int k = 0; k < table->fields; k++) sph_memory_free(table->field[k].data);
  *table = (sph_table){0};
}
