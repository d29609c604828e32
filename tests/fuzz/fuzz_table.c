/* libFuzzer: any bytes are a table over time, with a number at every time, or refused with a
 * message that names the case and the table.  The first byte chooses how it is read. */
#include "fuzz_file.h"

#include <math.h>
#include <string.h>

#include "case_schema.h"

static const char form[] =
    "dimension: 1\nspacing: 0.1\ntables: {a: {file: %s, outside: %s, interpolation: %s%s}}\n"
    "groups: {w: {kind: fluid, density: 1, eos: {linear: {sound_speed: 1}}, shapes: [{box: {lower: "
    "[0], upper: [1]}}]}}\nterms: {continuity: , pressure: }\nrun: {end: 1}\n";

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const double at[] = {-1e9, -1, 0, 0.3, 1, 2.5, 1e12};
  char text[1000];
  sph_error error = {0};
  if (!size) return 0;
  const char *path = fuzz_file("a.csv", data + 1, size - 1);
  snprintf(text, sizeof text, form, path, data[0] & 1 ? "repeat" : "hold",
           data[0] & 2 ? "linear" : "cubic", data[0] & 4 ? ", t: t, column: x, unit: 1 mm" : "");
  sph_case *c = sph_case_read_text("/fuzz.yml", text, strlen(text), 0, NULL, &error);
  if (!c && (!error.status || !strstr(error.text, "fuzz.yml:3:") || !strstr(error.text, path)))
    abort();
  for (int k = 0; c && k < (int)(sizeof at / sizeof *at); k++)
    if (isnan(sph_case_table_at(c->timed[0].table, at[k]))) abort();
  sph_case_free(c);
  return 0;
}
