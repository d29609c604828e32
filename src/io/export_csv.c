#include <string.h>

#include "export_format.h"

static int dim_of(const sph_table *table) { return table->dim ? table->dim : 3; }

static int columns(const sph_table *table, const sph_table_field *field)
{
  return field->columns == 3 ? dim_of(table) : 1;
}

static void header(const sph_table *table, sph_text *text)
{
  for (int k = 0; k < table->fields; k++) {
    const sph_table_field *f = &table->field[k];
    for (int d = 0; d < columns(table, f); d++) {
      const char axis[2] = {"xyz"[d], 0};
      const int vector = f->columns == 3, place = !strcmp(f->name, "position");
      sph_text_add(text, "%s%s%s%s", k + d ? "," : "", place ? "" : f->name,
                   vector && !place ? "_" : "", vector ? axis : "");
      if (f->unit[0]) sph_text_add(text, " [%s]", f->unit);
    }
  }
  sph_text_add(text, "\n");
}

void sph_export_csv(const sph_table *table, int single, sph_text *text)
{
  header(table, text);
  for (long i = 0; i < table->n && !text->error.status; i++) {
    for (int k = 0; k < table->fields; k++) {
      const sph_table_field *f = &table->field[k];
      for (int d = 0; d < columns(table, f); d++)
        sph_text_add(text, "%s%.*g", k + d ? "," : "", single && !f->whole ? 8 : 15,
                     f->data[i * f->columns + d]);
    }
    sph_text_add(text, "\n");
  }
}
