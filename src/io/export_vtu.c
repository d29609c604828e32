/* VTK's XML format with raw appended data: a head of text, then each array behind its length.  The
 * library that writes it is all of VTK, in C++; of its format a cloud of vertices needs this page.
 */
#include <stdint.h>
#include <string.h>

#include "export_format.h"

typedef struct writer {
  const sph_table *table;
  sph_text *text;
  uint64_t offset; /* of the next array in the appended data */
  int single;
} writer;

enum { CHUNK = 256 };

static void add_name(sph_text *text, const char *name)
{
  for (; *name; name++) {
    const char *as = *name == '&'   ? "&amp;"
                     : *name == '<' ? "&lt;"
                     : *name == '"' ? "&quot;"
                                    : NULL;
    if (as)
      sph_text_add(text, "%s", as);
    else
      sph_text_add(text, "%c", *name);
  }
}

static size_t bytes_of(const writer *w, const sph_table_field *f)
{
  size_t one = f->whole ? sizeof(int64_t) : w->single ? sizeof(float) : sizeof(double);
  return (size_t)w->table->n * (size_t)f->columns * one;
}

static void declare(writer *w, const char *type, const char *name, const char *unit, int columns,
                    size_t bytes)
{
  sph_text_add(w->text, "<DataArray type=\"%s\" Name=\"", type);
  add_name(w->text, name);
  if (unit[0]) {
    sph_text_add(w->text, " [");
    add_name(w->text, unit);
    sph_text_add(w->text, "]");
  }
  sph_text_add(w->text, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%llu\"/>\n",
               columns, (unsigned long long)w->offset);
  w->offset += sizeof(uint64_t) + bytes;
}

static const char *type_of(const writer *w, const sph_table_field *f)
{
  return f->whole ? "Int64" : w->single ? "Float32" : "Float64";
}

static void head(writer *w)
{
  const sph_table *t = w->table;
  const sph_table_field *x = sph_table_find(t, "position");
  const uint16_t one = 1;
  const size_t n = (size_t)t->n;
  sph_text_add(w->text,
               "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
               "byte_order=\"%s\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n"
               "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
               "format=\"ascii\">%.17g</DataArray>\n</FieldData>\n"
               "<Piece NumberOfPoints=\"%ld\" NumberOfCells=\"%ld\">\n<PointData>\n",
               *(const unsigned char *)&one ? "LittleEndian" : "BigEndian", t->time, t->n, t->n);
  for (int k = 0; k < t->fields; k++)
    if (&t->field[k] != x)
      declare(w, type_of(w, &t->field[k]), t->field[k].name, t->field[k].unit, t->field[k].columns,
              bytes_of(w, &t->field[k]));
  sph_text_add(w->text, "</PointData>\n<Points>\n");
  declare(w, type_of(w, x), "Points", "", 3, bytes_of(w, x));
  sph_text_add(w->text, "</Points>\n<Cells>\n");
  declare(w, "Int64", "connectivity", "", 1, n * sizeof(int64_t));
  declare(w, "Int64", "offsets", "", 1, n * sizeof(int64_t));
  declare(w, "UInt8", "types", "", 1, n);
  sph_text_add(w->text, "</Cells>\n</Piece>\n</UnstructuredGrid>\n"
                        "<AppendedData encoding=\"raw\">\n_");
}

static void add_length(writer *w, size_t bytes)
{
  const uint64_t length = bytes;
  sph_text_append(w->text, &length, sizeof length);
}

static void add_data(writer *w, const sph_table_field *f)
{
  const long n = w->table->n * f->columns;
  int64_t whole[CHUNK];
  float single[CHUNK];
  add_length(w, bytes_of(w, f));
  for (long i = 0; i < n; i += CHUNK) {
    const long some = n - i < CHUNK ? n - i : CHUNK;
    for (long k = 0; k < some && f->whole; k++) whole[k] = (int64_t)f->data[i + k];
    for (long k = 0; k < some && w->single; k++) single[k] = (float)f->data[i + k];
    const void *from = f->whole ? (const void *)whole : w->single ? (const void *)single : NULL;
    sph_text_append(w->text, from ? from : f->data + i, bytes_of(w, f) / (size_t)n * (size_t)some);
  }
}

/* Point i is cell i: its number, or one more; then VTK_VERTEX of each. */
static void add_cells(writer *w)
{
  const long n = w->table->n;
  for (int more = 0; more < 2; more++) {
    add_length(w, (size_t)n * sizeof(int64_t));
    for (int64_t i = more; i < n + more; i++) sph_text_append(w->text, &i, sizeof i);
  }
  add_length(w, (size_t)n);
  for (long i = 0; i < n; i++) sph_text_append(w->text, "\1", 1);
}

void sph_export_vtu(const sph_table *table, int single, sph_text *text)
{
  writer w = {.table = table, .text = text, .single = single};
  const sph_table_field *x = sph_table_find(table, "position");
  head(&w);
  for (int k = 0; k < table->fields; k++)
    if (&table->field[k] != x) add_data(&w, &table->field[k]);
  add_data(&w, x);
  add_cells(&w);
  sph_text_add(text, "\n</AppendedData>\n</VTKFile>\n");
}
