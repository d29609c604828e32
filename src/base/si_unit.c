#include "si_unit.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "words.h"

static const struct {
  const char *name;
  sph_si_unit unit;
} known[] = {
    {"kg", {1, {1, 0, 0}}},        {"g", {1e-3, {1, 0, 0}}},
    {"m", {1, {0, 1, 0}}},         {"km", {1e3, {0, 1, 0}}},
    {"dm", {0.1, {0, 1, 0}}},      {"cm", {1e-2, {0, 1, 0}}},
    {"mm", {1e-3, {0, 1, 0}}},     {"um", {1e-6, {0, 1, 0}}},
    {"in", {0.0254, {0, 1, 0}}},   {"ft", {0.3048, {0, 1, 0}}},
    {"s", {1, {0, 0, 1}}},         {"ms", {1e-3, {0, 0, 1}}},
    {"us", {1e-6, {0, 0, 1}}},     {"min", {60, {0, 0, 1}}},
    {"h", {3600, {0, 0, 1}}},      {"Hz", {1, {0, 0, -1}}},
    {"kHz", {1e3, {0, 0, -1}}},    {"N", {1, {1, 1, -2}}},
    {"kN", {1e3, {1, 1, -2}}},     {"Pa", {1, {1, -1, -2}}},
    {"hPa", {1e2, {1, -1, -2}}},   {"kPa", {1e3, {1, -1, -2}}},
    {"MPa", {1e6, {1, -1, -2}}},   {"GPa", {1e9, {1, -1, -2}}},
    {"bar", {1e5, {1, -1, -2}}},   {"mbar", {1e2, {1, -1, -2}}},
    {"J", {1, {1, 2, -2}}},        {"kJ", {1e3, {1, 2, -2}}},
    {"MJ", {1e6, {1, 2, -2}}},     {"W", {1, {1, 2, -3}}},
    {"kW", {1e3, {1, 2, -3}}},     {"mPa", {1e-3, {1, -1, -2}}},
    {"mW", {1e-3, {1, 2, -3}}},    {"K", {1, {0, 0, 0, 1}}},
    {"mol", {1, {0, 0, 0, 0, 1}}}, {"deg", {0.017453292519943295, {0}}},
};

static const sph_si_unit *find(const char *word, size_t length)
{
  for (size_t k = 0; k < sizeof known / sizeof *known; k++)
    if (strlen(known[k].name) == length && !memcmp(known[k].name, word, length))
      return &known[k].unit;
  return NULL;
}

int sph_si_unit_same(const double a[SPH_SI_BASES], const double b[SPH_SI_BASES])
{
  int same = 1;
  for (int k = 0; k < SPH_SI_BASES; k++) same &= a[k] == b[k];
  return same;
}

int sph_si_unit_known(const char *word, size_t length) { return find(word, length) != NULL; }

const char *sph_si_unit_nearest(const char *word, char *text, size_t size)
{
  sph_words w = {.wanted = word};
  size_t letters = strlen(word);
  while (letters > 0 && isdigit((unsigned char)word[letters - 1])) letters--;
  if (word[letters] && find(word, letters)) { /* m3 */
    snprintf(text, size, "did you mean %.*s^%s? ", (int)letters, word, word + letters);
    return text;
  }
  for (size_t k = 0; k < sizeof known / sizeof *known && word[1]; k++)
    if (strlen(known[k].name) > 1) sph_words_add(&w, known[k].name);
  snprintf(text, size, "%s", w.nearest);
  return text;
}

static size_t word_length(const char *text)
{
  size_t n = 0;
  while (isalnum((unsigned char)text[n]) || text[n] == '_') n++;
  return n;
}

static size_t spaces(const char *text) { return strspn(text, " \t"); }

/* One unit with its power, "s^2", times sign; the characters taken. */
static size_t factor(const char *text, double sign, sph_si_unit *unit)
{
  size_t n = word_length(text);
  const sph_si_unit *one = find(text, n);
  if (!one || text[n] == '(') return 0;
  double power = 1;
  if (text[n] == '^') {
    char *end;
    long p = strtol(text + n + 1, &end, 10);
    if (end == text + n + 1 || labs(p) > 9) return 0;
    power = (double)p;
    n = (size_t)(end - text);
  }
  double times = pow(one->factor, power);
  unit->factor = sign > 0 ? unit->factor * times : unit->factor / times;
  for (int b = 0; b < SPH_SI_BASES; b++) unit->power[b] += sign * power * one->power[b];
  return n;
}

size_t sph_si_unit_parse(const char *text, int (*is_name)(void *ctx, const char *word, size_t),
                         void *ctx, sph_si_unit *unit)
{
  *unit = (sph_si_unit){.factor = 1};
  size_t start = text[0] == '/' ? 1 + spaces(text + 1) : 0; /* "1/s" */
  if (start && is_name && is_name(ctx, text + start, word_length(text + start))) return 0;
  size_t taken = factor(text + start, start ? -1 : 1, unit);
  if (taken) taken += start;
  while (taken) {
    size_t n = taken + spaces(text + taken);
    double sign = text[n] == '/' ? -1 : 1;
    if (text[n] == '/' || text[n] == '*') n += 1 + spaces(text + n + 1);
    if (is_name && is_name(ctx, text + n, word_length(text + n))) break;
    size_t more = factor(text + n, sign, unit);
    if (!more) break;
    taken = n + more;
  }
  return taken;
}

static void add(char *text, size_t size, const char *name, double power)
{
  size_t n = strlen(text);
  if (power == 1)
    snprintf(text + n, size - n, "%s%s", n ? " " : "", name);
  else
    snprintf(text + n, size - n, "%s%s^%.3g", n ? " " : "", name, power);
}

static int same(const double *a, const double *b)
{
  int equal = 1;
  for (int k = 0; k < SPH_SI_BASES; k++) equal = equal && a[k] == b[k];
  return equal;
}

void sph_si_unit_write(const double power[SPH_SI_BASES], char *text, size_t size)
{
  static const char *const base[] = {"kg", "m", "s", "K", "mol"};
  text[0] = 0;
  for (size_t k = 0; k < sizeof known / sizeof *known; k++) { /* Pa, N, J, W before kg/m/s^2 */
    const sph_si_unit *unit = &known[k].unit;
    if (unit->factor == 1 && same(unit->power, power) && power[0] == 1) {
      snprintf(text, size, "%s", known[k].name);
      return;
    }
  }
  for (int b = 0; b < SPH_SI_BASES; b++)
    if (power[b] > 0) add(text, size, base[b], power[b]);
  if (!text[0]) snprintf(text, size, "1");
  for (int b = 0; b < SPH_SI_BASES; b++) {
    size_t n = strlen(text);
    if (power[b] == -1) snprintf(text + n, size - n, "/%s", base[b]);
    if (power[b] < 0 && power[b] != -1)
      snprintf(text + n, size - n, "/%s^%.3g", base[b], -power[b]);
  }
}
