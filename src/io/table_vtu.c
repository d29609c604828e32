/* VTK's XML files of unstructured grids and polygonal data, as ParaView and `sphode export` write
 * them: their points and what is wanted of the data at these, of all pieces.  Expat reads the XML
 * and tells where the arrays stand; behind <AppendedData> there is none. */
#include <limits.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config.h"
#include "file.h"
#include "memory.h"
#include "snapshot.h"
#include "table.h"
#include "vtu_array.h"

#ifdef SPH_HAVE_VTU
#include <expat.h>

enum { OUTSIDE, POINTS, DATA };
enum { CHUNK = 1 << 20, PACKED = 1100 }; /* zlib packs at most 1032 : 1 */

typedef struct array {
  long line;
  char name[SPH_TABLE_NAME], unit[SPH_TABLE_NAME];
  int type, columns, coding, appended;
  size_t from, to; /* in the file; appended: `from` in the data behind the XML */
  long first, n;   /* of the points of all pieces */
} array;

typedef struct reader {
  const char *path, *wanted;
  char *text; /* [size], a NUL behind */
  size_t size;
  XML_Parser parser;
  sph_vtu_head head;
  int head_read, inside;
  long first, n; /* points before the piece, and of it */
  array *open;   /* its contents have begun */
  size_t data;   /* where appended data begin; 0: not yet */
  int data_coding;
  array *list;
  int arrays, room;
  sph_error *error;
} reader;

/* ---- what the XML says ---- */

static int refuse(reader *r, const char *format, ...) SPH_PRINTF(2, 3);
static int refuse(reader *r, const char *format, ...)
{
  char why[300];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(why, sizeof why, format, arguments);
  va_end(arguments);
  XML_StopParser(r->parser, XML_FALSE);
  return sph_error_set(r->error, SPH_ERR_PARSE, "%s:%lu:%lu: %s", r->path,
                       (unsigned long)XML_GetCurrentLineNumber(r->parser),
                       (unsigned long)XML_GetCurrentColumnNumber(r->parser) + 1, why);
}

static const char *get(const char **attribute, const char *name, const char *otherwise)
{
  for (; *attribute; attribute += 2)
    if (!strcmp(attribute[0], name) && attribute[1]) return attribute[1];
  return otherwise;
}

/* A whole number >= 0. */
static int whole(reader *r, const char **attribute, const char *name, const char *otherwise,
                 long *value)
{
  char *end;
  const char *text = get(attribute, name, otherwise);
  if (!text) return refuse(r, "no %s", name);
  *value = strtol(text, &end, 10);
  if (end != text && !*end && *value >= 0 && *value < LONG_MAX) return SPH_OK;
  return refuse(r, "%s=\"%.60s\"; a whole number is right", name, text);
}

static void take_head(reader *r, const char *element, const char **attribute)
{
  const uint16_t one = 1;
  const int little = *(const unsigned char *)&one;
  const char *type = get(attribute, "type", ""), *order = get(attribute, "byte_order", NULL);
  const char *length = get(attribute, "header_type", "UInt32");
  const char *compressor = get(attribute, "compressor", "");
  if (strcmp(element, "VTKFile") != 0)
    refuse(r, "<%.60s>; <VTKFile> is right", element);
  else if (strcmp(type, "UnstructuredGrid") != 0 && strcmp(type, "PolyData") != 0)
    refuse(r, "type=\"%.60s\"; UnstructuredGrid and PolyData are known", type);
  else if (order && strcmp(order, "LittleEndian") != 0 && strcmp(order, "BigEndian") != 0)
    refuse(r, "byte_order=\"%.60s\"; LittleEndian and BigEndian are known", order);
  else if (strcmp(length, "UInt32") != 0 && strcmp(length, "UInt64") != 0)
    refuse(r, "header_type=\"%.60s\"; UInt32 and UInt64 are known", length);
  else if (*compressor && strcmp(compressor, "vtkZLibDataCompressor") != 0)
    refuse(r, "compressor=\"%.60s\"; vtkZLibDataCompressor is known, or none", compressor);
  r->head = (sph_vtu_head){.swap = order && (strcmp(order, "LittleEndian") == 0) != little,
                           .wide = !strcmp(length, "UInt64"),
                           .zlib = *compressor != '\0'};
}

static void take_piece(reader *r, const char **attribute)
{
  r->first += r->n;
  if (whole(r, attribute, "NumberOfPoints", NULL, &r->n)) return;
  if ((double)(r->first + r->n) > (double)r->size * PACKED)
    refuse(r, "%ld points in a file of %zu bytes", r->n, r->size);
}

/* "Velocities [m per s]": velocity, m/s. */
static void split(const char *title, array *a)
{
  char name[SPH_TABLE_NAME];
  const char *open = strchr(title, '['), *close = open ? strchr(open, ']') : NULL;
  int n = (int)(open ? (size_t)(open - title) : strlen(title));
  while (n > 0 && title[n - 1] == ' ') n--;
  snprintf(name, sizeof name, "%.*s", n, title);
  snprintf(a->name, sizeof a->name, "%s", sph_snapshot_field(name));
  for (char *to = a->unit; close && ++open < close && to + 1 < a->unit + sizeof a->unit;) {
    const int per = !strncmp(open, " per ", 5);
    *to++ = per ? '/' : *open;
    if (per) open += 4;
  }
}

static void take_coding(reader *r, const char **attribute, array *a)
{
  const char *format = get(attribute, "format", "ascii");
  long offset = 0;
  if (!strcmp(format, "appended")) {
    a->appended = 1;
    if (!whole(r, attribute, "offset", NULL, &offset)) a->from = (size_t)offset;
  } else if (!strcmp(format, "binary")) {
    a->coding = SPH_VTU_BASE64;
  } else if (strcmp(format, "ascii") != 0) {
    refuse(r, "format=\"%.60s\"; ascii, binary and appended are known", format);
  }
}

/* An array of points or of data at points, if it is wanted and there are any. */
static void take_array(reader *r, const char **attribute)
{
  array a = {.line = (long)XML_GetCurrentLineNumber(r->parser), .first = r->first, .n = r->n};
  const char *type = get(attribute, "type", "");
  long columns = 1;
  split(r->inside == POINTS ? "position" : get(attribute, "Name", ""), &a);
  if (a.n == 0 || (r->inside == DATA && !sph_table_listed(r->wanted, a.name))) return;
  if (whole(r, attribute, "NumberOfComponents", "1", &columns)) return;
  a.columns = columns == 3 ? 3 : 1;
  a.type = sph_vtu_array_type(type);
  if (columns != 1 && columns != 3) refuse(r, "%ld components; 1 and 3 are right", columns);
  if (a.type < 0) refuse(r, "type=\"%.60s\"; Float64, Float32, Int64, ... are known", type);
  take_coding(r, attribute, &a);
  for (int k = 0; k < r->arrays; k++)
    if (r->list[k].first == a.first && !strcmp(r->list[k].name, a.name))
      refuse(r, "%s a second time", a.name);
  if (r->arrays == r->room && !r->error->status) {
    const int more = 2 * r->room + 16;
    if (!sph_memory_grow((void **)&r->list, (size_t)r->room, (size_t)more, sizeof a, "arrays",
                         r->error))
      r->room = more;
  }
  if (r->error->status) return;
  r->list[r->arrays] = a;
  r->open = &r->list[r->arrays++];
  if (!a.appended)
    r->open->from =
        (size_t)XML_GetCurrentByteIndex(r->parser) + (size_t)XML_GetCurrentByteCount(r->parser);
}

/* The data begin behind "_"; what follows is no XML. */
static void take_appended(reader *r, const char **attribute)
{
  const char *encoding = get(attribute, "encoding", "raw");
  size_t at =
      (size_t)XML_GetCurrentByteIndex(r->parser) + (size_t)XML_GetCurrentByteCount(r->parser);
  if (strcmp(encoding, "raw") != 0 && strcmp(encoding, "base64") != 0) {
    refuse(r, "encoding=\"%.60s\"; raw and base64 are known", encoding);
    return;
  }
  r->data_coding = encoding[0] == 'r' ? SPH_VTU_RAW : SPH_VTU_BASE64;
  at += strspn(r->text + at, " \t\r\n");
  if (r->text[at] != '_') {
    refuse(r, "no _ before the appended data");
    return;
  }
  r->data = at + 1;
  XML_StopParser(r->parser, XML_FALSE);
}

/* What stands in an array ends where it ends or another element begins: VTK's notes about it. */
static void close_array(reader *r)
{
  if (r->open && !r->open->appended) r->open->to = (size_t)XML_GetCurrentByteIndex(r->parser);
  r->open = NULL;
}

static void XMLCALL start(void *ctx, const char *element, const char **attribute)
{
  reader *r = ctx;
  if (r->error->status) return;
  close_array(r);
  if (!r->head_read) {
    r->head_read = 1;
    take_head(r, element, attribute);
  } else if (!strcmp(element, "Piece")) {
    take_piece(r, attribute);
  } else if (!strcmp(element, "Points")) {
    r->inside = POINTS;
  } else if (!strcmp(element, "PointData")) {
    r->inside = DATA;
  } else if (!strcmp(element, "DataArray") && r->inside) {
    take_array(r, attribute);
  } else if (!strcmp(element, "AppendedData")) {
    take_appended(r, attribute);
  }
}

static void XMLCALL end(void *ctx, const char *element)
{
  reader *r = ctx;
  if (r->error->status) return;
  close_array(r);
  if (!strcmp(element, "Points") || !strcmp(element, "PointData")) r->inside = OUTSIDE;
}

/* Entities would be defined in one; nobody writes one. */
static void XMLCALL refuse_doctype(void *ctx, const char *name, const char *system,
                                   const char *public, int internal)
{
  (void)name, (void)system, (void)public, (void)internal;
  refuse(ctx, "a DOCTYPE has no place in a file of VTK");
}

static int read_xml(reader *r)
{
  enum XML_Status status = XML_STATUS_OK;
  r->parser = XML_ParserCreate(NULL);
  if (!r->parser) return sph_error_set(r->error, SPH_ERR_MEMORY, "out of memory: Expat's parser");
  XML_SetUserData(r->parser, r);
  XML_SetElementHandler(r->parser, start, end);
  XML_SetStartDoctypeDeclHandler(r->parser, refuse_doctype);
  for (size_t at = 0; status == XML_STATUS_OK && at <= r->size; at += CHUNK) {
    const size_t left = r->size - at;
    status = XML_Parse(r->parser, r->text + at, (int)(left < CHUNK ? left : CHUNK), left < CHUNK);
  }
  if (status != XML_STATUS_OK && !r->data && !r->error->status)
    refuse(r, "no XML: %s", XML_ErrorString(XML_GetErrorCode(r->parser)));
  XML_ParserFree(r->parser);
  return r->error->status;
}

/* ---- into the table ---- */

static sph_table_field *field_of(reader *r, sph_table *table, const array *a)
{
  for (int k = 0; k < table->fields; k++)
    if (!strcmp(table->field[k].name, a->name)) return &table->field[k];
  if (table->fields == SPH_TABLE_FIELDS) return NULL;
  sph_table_field *field = &table->field[table->fields];
  *field = (sph_table_field){.columns = a->columns};
  memcpy(field->name, a->name, sizeof field->name);
  memcpy(field->unit, a->unit, sizeof field->unit);
  field->data =
      sph_memory_new((size_t)table->n * (size_t)a->columns + 1, sizeof(double), a->name, r->error);
  if (field->data) table->fields++;
  return field->data ? field : NULL;
}

static int decode(reader *r, sph_table *table, const array *a)
{
  sph_error why = {0};
  sph_table_field *field = field_of(r, table, a);
  if (!field) return r->error->status;
  const int coding = a->appended ? r->data_coding : a->coding;
  const size_t from = a->appended ? r->data + a->from : a->from;
  const size_t to = a->appended ? r->size : a->to;
  int status = SPH_OK;
  if (a->columns != field->columns)
    status = sph_error_set(&why, SPH_ERR_FILE, "%d components, %d in the piece before", a->columns,
                           field->columns);
  else if ((a->appended && !r->data) || from > to)
    status = sph_error_set(&why, SPH_ERR_FILE, "its appended data are not in the file");
  else
    status = sph_vtu_array_read(&r->head, coding, a->type, r->text + from, to - from,
                                field->data + a->first * a->columns,
                                (size_t)a->n * (size_t)a->columns, &why);
  if (!status) return SPH_OK;
  return sph_error_set(r->error, status, "%s:%ld: %s (%s): %s", r->path, a->line, a->name,
                       sph_vtu_array_type_name(a->type), why.text);
}

/* Each field is in all pieces that hold points, and points are. */
static int check_pieces(reader *r, const sph_table *table)
{
  for (int k = 0; k < table->fields; k++) {
    long n = 0;
    for (int i = 0; i < r->arrays; i++)
      if (!strcmp(r->list[i].name, table->field[k].name)) n += r->list[i].n;
    if (n != table->n)
      return sph_error_set(r->error, SPH_ERR_FILE, "%s: %s of %ld of %ld points", r->path,
                           table->field[k].name, n, table->n);
  }
  const sph_table_field *x = sph_table_find(table, "position");
  if (table->n == 0 || (x && x->columns == 3)) return SPH_OK;
  return sph_error_set(r->error, SPH_ERR_FILE, "%s: no Points of three components", r->path);
}

int sph_table_vtu_read(sph_table *table, const char *path, const char *wanted, sph_error *error)
{
  sph_error own = {0};
  reader r = {.path = path, .wanted = wanted, .error = &own};
  *table = (sph_table){0};
  int status = sph_file_read(path, &r.text, &r.size, &own);
  if (!status) status = read_xml(&r);
  table->n = r.first + r.n;
  for (int k = 0; k < r.arrays && !status; k++) status = decode(&r, table, &r.list[k]);
  if (!status) status = check_pieces(&r, table);
  sph_memory_free(r.list);
  sph_memory_free(r.text);
  if (!status) return SPH_OK;
  sph_table_free(table);
  return sph_error_set(error, own.status, "%s", own.text);
}
#else
int sph_table_vtu_read(sph_table *table, const char *path, const char *wanted, sph_error *error)
{
  (void)wanted;
  *table = (sph_table){0};
  return sph_error_set(
      error, SPH_ERR_UNBUILT,
      "%s: this sphode was built without Expat and zlib, which VTU needs: install "
      "libexpat1-dev and zlib1g-dev (Debian, Ubuntu) or expat-devel and zlib-devel "
      "(Fedora), configure and build it again; or bring a .csv",
      path);
}
#endif
