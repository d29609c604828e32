/* libFuzzer: any text is an expression with a finite value and a unit, or refused with a problem
 * and a column of it; the same of expressions in space and time, which are then finite, or say so.
 */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "case_value.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static sph_case_name names[] = {{.name = (char[]){"H"}, .value = 0.6, .power = {0, 1, 0}},
                                {.name = (char[]){"g"}, .value = 9.81, .power = {0, 1, -2}},
                                {.name = (char[]){"n"}, .value = -3}};
enum { NAMES = sizeof names / sizeof *names, POINTS = 3 };

static void told(int status, const sph_case_value *v, const char *text)
{
  if (!status) return;
  if (!v->problem[0] || v->column < 0 || (size_t)v->column > strlen(text)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const double x[3][POINTS] = {{0, 1, -2}, {0, 0.5, 1e9}, {0, -1, 3}};
  const double *const at[3] = {x[0], x[1], x[2]};
  double out[POINTS];
  sph_case_value v;
  char *text = malloc(size + 1);
  if (!text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  int status = sph_case_value_evaluate(text, names, NAMES, &v);
  told(status, &v, text);
  if (!status && !isfinite(v.value)) abort();
  told(sph_case_value_field_unit(text, names, NAMES, 3, &v), &v, text);
  status = sph_case_value_field(text, names, NAMES, 3, POINTS, at, out, &v);
  told(status, &v, text);
  for (int k = 0; !status && k < POINTS; k++)
    if (!isfinite(out[k])) abort();
  sph_case_formula *formula = sph_case_value_formula_create(text, names, NAMES, 3, &v);
  told(!formula, &v, text);
  for (int k = 0; formula && k < 2; k++)
    if (!sph_case_value_formula_at(formula, POINTS, at, 0.3 * k, out) && !isfinite(out[0])) abort();
  sph_case_value_formula_free(formula);
  free(text);
  return 0;
}
