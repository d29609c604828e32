/* SPLASH's ASCII format: it knows columns by these names, without units, and finds the time in a
 * head as it writes one itself.  Of a CSV it reads 16 characters of a number and drops the exponent
 * behind them (version 3.6). */
#include <string.h>

#include "export_format.h"

static const char *title(const sph_table_field *f)
{
  static const char *const names[][2] = {{"position", ""},
                                         {"velocity", "v"},
                                         {"mass", "m"},
                                         {"smoothing_length", "h"},
                                         {"energy", "u"}};
  for (size_t k = 0; k < sizeof names / sizeof *names; k++)
    if (!strcmp(names[k][0], f->name)) return names[k][1];
  return f->name;
}

static int columns(const sph_table *table, const sph_table_field *f)
{
  return f->columns == 3 && table->dim ? table->dim : f->columns;
}

void sph_export_splash(const sph_table *table, int single, sph_text *text)
{
  sph_text_add(text, "# time: time unit (s)\n#  %.17g 1.0\n# SI units\n#", table->time);
  for (int k = 0; k < table->fields; k++)
    for (int d = 0; d < columns(table, &table->field[k]); d++)
      sph_text_add(text, "  %s%.*s", title(&table->field[k]), table->field[k].columns == 3,
                   &"xyz"[d]);
  sph_text_add(text, "\n");
  for (long i = 0; i < table->n && !text->error.status; i++) {
    for (int k = 0; k < table->fields; k++) {
      const sph_table_field *f = &table->field[k];
      for (int d = 0; d < columns(table, f); d++)
        sph_text_add(text, "%s%.*g", k + d ? " " : "", single && !f->whole ? 9 : 17,
                     f->data[i * f->columns + d]);
    }
    sph_text_add(text, "\n");
  }
}
