#include "case_value.h"

#include <ctype.h>
#include <math.h>
#include <muParserDLL.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "words.h"

/* Units are checked without a parser of our own: the expression is evaluated again with the
 * kilogram, the metre and the second made 4 times larger and smaller.  A value that grows as a
 * power of each has that dimension; one that does not adds what cannot be added. */

/* muParser keeps the text of an error in a buffer of the process. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

enum { TRANSLATED = 16 * SPH_CASE_VALUE_LENGTH, MOST_NAMES = 128 };

typedef struct formula {
  const char *text;
  const sph_case_name *names;
  int n;
  char translated[TRANSLATED];
  short origin[TRANSLATED]; /* where in text a character of translated comes from */
  size_t length;
  double values[MOST_NAMES];
  sph_case_value *result;
} formula;

static int problem(formula *f, size_t column, const char *format, ...) SPH_PRINTF(3, 4);
static int problem(formula *f, size_t column, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(f->result->problem, sizeof f->result->problem, format, arguments);
  va_end(arguments);
  f->result->column = (int)column;
  return SPH_ERR_PARSE;
}

static int put(formula *f, size_t origin, const char *text, size_t length)
{
  if (f->length + length + 1 > TRANSLATED) return problem(f, origin, "expression too long");
  memcpy(f->translated + f->length, text, length);
  for (size_t k = 0; k < length; k++) f->origin[f->length + k] = (short)origin;
  f->length += length;
  f->translated[f->length] = 0;
  f->origin[f->length] = (short)(origin + (length > 0));
  return SPH_OK;
}

static int is_name(void *ctx, const char *word, size_t length)
{
  const formula *f = ctx;
  for (int k = 0; k < f->n; k++)
    if (strlen(f->names[k].name) == length && !memcmp(f->names[k].name, word, length)) return 1;
  return 0;
}

static double scaling(const double power[SPH_SI_BASES], const double scale[SPH_SI_BASES])
{
  double s = 1;
  for (int b = 0; b < SPH_SI_BASES; b++) s *= pow(scale[b], power[b]);
  return s;
}

/* The numerator of a unit that has none, as in 0.2 1/s; its characters. */
static size_t unit_one(const char *text)
{
  const size_t n = text[0] == '1' ? 1 + strspn(text + 1, " \t") : 0;
  return n && text[n] == '/' ? n : 0;
}

/* A word behind a number that is no unit; 0. */
static size_t no_unit(formula *f, size_t k, const char *word)
{
  size_t n = 0;
  char text[42], meant[80];
  while (isalnum((unsigned char)word[n]) || word[n] == '_') n++;
  snprintf(text, sizeof text, "%.*s", (int)(n < 40 ? n : 40), word);
  if (is_name(f, text, strlen(text)))
    problem(f, k, "'%s' is not a unit; a product with a name needs *", text);
  else
    problem(f, k,
            "'%s' is not a unit; %sknown are kg, m, s, K, mol, N, Pa, J, W with their multiples as "
            "mm, kPa, deg, and products as m/s^2; a product with a name needs *",
            text, sph_si_unit_nearest(text, meant, sizeof meant));
  return 0;
}

/* "5*H 0.1*H", "1.0.0" */
static int is_behind_value(const formula *f, size_t k)
{
  while (k > 0 && (f->text[k - 1] == ' ' || f->text[k - 1] == '\t')) k--;
  const unsigned char before = k > 0 ? (unsigned char)f->text[k - 1] : '+';
  return isalnum(before) || strchr("_.)", before);
}

/* The number at text[k], with the unit behind it; the characters taken, 0: a problem. */
static size_t number(formula *f, size_t k, const double scale[SPH_SI_BASES])
{
  char piece[100], *end;
  const char *start = f->text + k;
  double v = strtod(start, &end);
  size_t digits = (size_t)(end - start), gap = strspn(end, " \t");
  sph_si_unit unit;
  const size_t one = gap ? unit_one(end + gap) : 0;
  if (!isfinite(v)) {
    problem(f, k, "'%.*s' is too large a number; the largest is 1.8e308",
            (int)fmin((double)digits, 40), start);
    return 0;
  }
  if (is_behind_value(f, k)) {
    problem(
        f, k,
        "a number right behind another value; between them belongs an operator, in a list a comma");
    return 0;
  }
  size_t taken = sph_si_unit_parse(end + gap + one, is_name, f, &unit);
  if (taken) {
    taken += one;
    snprintf(piece, sizeof piece, "(%.17g*%.17g)", v, unit.factor * scaling(unit.power, scale));
    return put(f, k, piece, strlen(piece)) ? 0 : digits + gap + taken;
  }
  if (isalpha((unsigned char)end[gap]) || end[gap] == '_')
    return no_unit(f, k + digits + gap, end + gap);
  if (gap && isdigit((unsigned char)end[gap])) {
    problem(f, k + digits + gap, "a number behind a number; a unit without a numerator is 1/s");
    return 0;
  }
  snprintf(piece, sizeof piece, "(%.17g)", v);
  return put(f, k, piece, strlen(piece)) ? 0 : digits;
}

/* Powers, degrees, dots, as they are printed. */
static int not_ascii(formula *f, size_t k)
{
  static const char *const right[][2] = {
      {"\xc2\xb2", "^2"},       {"\xc2\xb3", "^3"}, {"\xc2\xb0", "deg"},
      {"\xc2\xb7", "*"},        {"\xc3\x97", "*"},  {"\xc2\xb5", "u, as um"},
      {"\xce\xbc", "u, as um"}, {"\xcf\x80", "pi"}, {"\xe2\x88\x92", "-"},
  };
  for (size_t r = 0; r < sizeof right / sizeof *right; r++)
    if (!strncmp(f->text + k, right[r][0], strlen(right[r][0])))
      return problem(f, k, "found '%s'; right is %s", right[r][0], right[r][1]);
  return problem(f, k, "found a character that is not ASCII");
}

/* What muParser would take and nobody means: assignments, lists, strings. */
static int forbidden(formula *f)
{
  int depth = 0;
  for (size_t k = 0; f->text[k]; k++) {
    char c = f->text[k], before = k ? f->text[k - 1] : ' ';
    depth += (c == '(') - (c == ')');
    if (c == '=' && !strchr("<>!=", before) && f->text[k + 1] != '=')
      return problem(f, k, "found '='; a value is an expression, == compares");
    if (c == ',' && depth <= 0) return problem(f, k, "found ','; a value is one number");
    if (c == '"') return problem(f, k, "found '\"'; a value is a number or an expression");
    if ((unsigned char)c >= 128) return not_ascii(f, k);
  }
  return SPH_OK;
}

static int translate(formula *f, const double scale[SPH_SI_BASES])
{
  f->length = 0;
  f->translated[0] = 0;
  f->origin[0] = 0;
  for (size_t k = 0; f->text[k];) {
    unsigned char c = (unsigned char)f->text[k], next = (unsigned char)f->text[k + 1];
    size_t taken = 0;
    if (isdigit(c) || (c == '.' && isdigit(next))) {
      taken = number(f, k, scale);
      if (!taken) return SPH_ERR_PARSE;
    } else if (isalpha(c) || c == '_') {
      while (isalnum((unsigned char)f->text[k + taken]) || f->text[k + taken] == '_') taken++;
      if (put(f, k, f->text + k, taken)) return SPH_ERR_PARSE;
    } else {
      taken = 1;
      if (put(f, k, f->text + k, 1)) return SPH_ERR_PARSE;
    }
    k += taken;
  }
  return SPH_OK;
}

/* x, y, z, t where they are not known: what may stand here. */
static const char *expected(formula *f, char text[60])
{
  static const char *const place[] = {"", "x", "x, y", "x, y, z"};
  const int dim = is_name(f, "x", 1) + is_name(f, "y", 1) + is_name(f, "z", 1);
  const int timed = is_name(f, "t", 1);
  if (!dim && !timed) return "a number";
  snprintf(text, 60, "an expression in %s%s%s", place[dim], dim && timed ? ", " : "",
           timed ? "t" : "");
  return text;
}

static int unknown_word(formula *f, size_t k, const char *word)
{
  static const char *const functions[] = {"sin",   "cos",   "tan",   "asin", "acos", "atan",
                                          "atan2", "sinh",  "cosh",  "tanh", "exp",  "log",
                                          "ln",    "log2",  "log10", "sqrt", "sign", "rint",
                                          "abs",   "min",   "max",   "sum",  "avg",  "pi",
                                          "asinh", "acosh", "atanh"};
  sph_words w = {.wanted = word};
  for (size_t n = 0; n < sizeof functions / sizeof *functions && word[1]; n++)
    sph_words_add(&w, functions[n]);
  for (int n = 0; n < f->n && word[1]; n++) sph_words_add(&w, f->names[n].name);
  char meant[80]; /* m3 */
  if (isdigit((unsigned char)word[strlen(word) - 1]) &&
      strchr(sph_si_unit_nearest(word, meant, sizeof meant), '^'))
    snprintf(w.nearest, sizeof w.nearest, "%.60s", meant);
  const size_t n = strlen(w.nearest); /* with a space behind it */
  return problem(f, k, "'%s' is no parameter and no function, nor a table of tables%s%.*s", word,
                 n ? "; " : "", n ? (int)n - 1 : 0, w.nearest);
}

static int muparser_problem(formula *f, muParserHandle_t parser)
{
  int at = mupGetErrorPos(parser);
  if (at < 0 || (size_t)at > f->length) at = 0;
  char message[200], token[60], right[60]; /* muParser has one buffer for both */
  snprintf(message, sizeof message, "%s", mupGetErrorMsg(parser));
  snprintf(token, sizeof token, "%s", mupGetErrorToken(parser));
  if (isalpha((unsigned char)token[0]) && !is_name(f, token, strlen(token)))
    return strlen(token) == 1 && strchr("xyzt", token[0])
               ? problem(f, (size_t)f->origin[at], "'%s' is not known here; right is %s", token,
                         expected(f, right))
               : unknown_word(f, (size_t)f->origin[at], token);
  char *tail = strstr(message, " at position"); /* of the translated text: would mislead */
  if (tail) *tail = 0;
  return problem(f, (size_t)f->origin[at], "not an expression: %s", message);
}

static muParserHandle_t open_parser(formula *f, const double scale[SPH_SI_BASES])
{
  muParserHandle_t parser = mupCreate(0);
  if (!parser) {
    problem(f, 0, "out of memory");
    return NULL;
  }
  mupDefineConst(parser, "pi", M_PI);
  for (int k = 0; k < f->n; k++) {
    f->values[k] = f->names[k].value * scaling(f->names[k].power, scale);
    mupDefineVar(parser, f->names[k].name, &f->values[k]);
  }
  mupSetExpr(parser, f->translated);
  return parser;
}

/* The value with units scaled; the lock is held. */
static int evaluate(formula *f, const double scale[SPH_SI_BASES], double *value)
{
  if (translate(f, scale)) return SPH_ERR_PARSE;
  muParserHandle_t parser = open_parser(f, scale);
  if (!parser) return SPH_ERR_PARSE;
  *value = mupEval(parser);
  int status = mupError(parser) ? muparser_problem(f, parser) : SPH_OK;
  mupRelease(parser);
  return status;
}

/* The exponent of base b, from two ratios that must agree. */
static int exponent(formula *f, int b, double *power)
{
  double scale[SPH_SI_BASES] = {1, 1, 1, 1, 1}, more, less, value = f->result->value;
  scale[b] = 4;
  if (evaluate(f, scale, &more)) return SPH_ERR_PARSE;
  scale[b] = 0.25;
  if (evaluate(f, scale, &less)) return SPH_ERR_PARSE;
  double up = log(more / value) / log(4), down = log(value / less) / log(4);
  if (!(fabs(up - down) < 1e-6))
    return problem(f, 0,
                   "'%.60s' adds or compares quantities of different units, or takes a "
                   "function of one; functions are of plain numbers, as sin(t/(1 s))",
                   f->text);
  double nearest = round(12 * up) / 12;
  *power = fabs(up - nearest) < 1e-6 ? nearest : up;
  return SPH_OK;
}

static int prepare(formula *f, const char *text, const sph_case_name *names, int n,
                   sph_case_value *result)
{
  memset(result, 0, sizeof *result);
  f->text = text;
  f->names = names;
  f->n = n;
  f->result = result;
  if (n > MOST_NAMES) return problem(f, 0, "more than %d names", MOST_NAMES);
  if (strlen(text) > SPH_CASE_VALUE_LENGTH)
    return problem(f, 0, "expression longer than %d characters", SPH_CASE_VALUE_LENGTH);
  if (text[strspn(text, " \t\n")] == 0)
    return problem(f, 0, "found nothing; a number belongs here");
  return forbidden(f);
}

static const double si[SPH_SI_BASES] = {1, 1, 1, 1, 1};

static int dimensions(formula *f)
{
  f->result->any = f->result->value == 0;
  if (f->result->any) return SPH_OK;
  for (int b = 0; b < SPH_SI_BASES; b++)
    if (exponent(f, b, &f->result->power[b])) return SPH_ERR_PARSE;
  return SPH_OK;
}

int sph_case_value_evaluate(const char *text, const sph_case_name *names, int n,
                            sph_case_value *result)
{
  formula f;
  int status = prepare(&f, text, names, n, result);
  if (status) return status;
  pthread_mutex_lock(&lock);
  status = evaluate(&f, si, &result->value);
  if (!status && !isfinite(result->value))
    status = problem(&f, 0, "'%.60s' is %s; a finite number belongs here", text,
                     isnan(result->value) ? "not a number" : "infinite");
  if (!status) status = dimensions(&f);
  pthread_mutex_unlock(&lock);
  return status;
}

/* names[n], the coordinates and, if timed, the time behind them; power 1: in metres, seconds. */
static int with_coordinates(const sph_case_name *names, int n, int dim, int timed, double power,
                            sph_case_name all[MOST_NAMES])
{
  static char time[] = "t";
  static char *const word[] = {"x", "y", "z"};
  static const double point[] = {0.3711, 0.4127, 0.4391}; /* nowhere special [m] */
  int m = 0;
  for (int k = 0; k < n && m < MOST_NAMES - 4; k++) all[m++] = names[k];
  for (int d = 0; d < dim; d++)
    all[m++] = (sph_case_name){.name = word[d], .value = point[d], .power = {0, power, 0}};
  if (timed) all[m++] = (sph_case_name){.name = time, .value = 0.3319, .power = {0, 0, power}};
  return m;
}

static int field_unit(const char *text, const sph_case_name *names, int n, int dim, int timed,
                      double power, sph_case_value *result)
{
  sph_case_name all[MOST_NAMES];
  int m = with_coordinates(names, n, dim, timed, power, all);
  formula f;
  int status = prepare(&f, text, all, m, result);
  if (status) return status;
  pthread_mutex_lock(&lock);
  status = evaluate(&f, si, &result->value);
  if (!status && !isfinite(result->value)) result->value = 0; /* elsewhere it may be */
  if (!status) status = dimensions(&f);
  pthread_mutex_unlock(&lock);
  return status;
}

static int any_unit(const char *text, const sph_case_name *names, int n, int dim, int timed,
                    sph_case_value *result)
{
  int status = field_unit(text, names, n, dim, timed, 1, result);
  if (!status) return status;
  /* "sin(3*x)": fine where everything is a plain number. */
  sph_case_value plain;
  if (field_unit(text, names, n, dim, timed, 0, &plain)) return status;
  for (int b = 0; b < SPH_SI_BASES; b++)
    if (plain.power[b] != 0) return status;
  *result = plain;
  return SPH_OK;
}

int sph_case_value_field_unit(const char *text, const sph_case_name *names, int n, int dim,
                              sph_case_value *result)
{
  return any_unit(text, names, n, dim, 0, result);
}

int sph_case_value_formula_unit(const char *text, const sph_case_name *names, int n, int dim,
                                sph_case_value *result)
{
  return any_unit(text, names, n, dim, 1, result);
}

static int evaluate_points(formula *f, muParserHandle_t parser, int first, int dim, long count,
                           const double *const x[], double *out)
{
  for (long i = 0; i < count; i++) {
    for (int d = 0; d < dim; d++) f->values[first + d] = x[d][i];
    out[i] = mupEval(parser);
    if (mupError(parser)) return muparser_problem(f, parser);
    if (isfinite(out[i])) continue;
    return problem(f, 0, "'%.60s' is %s at x = %g m%s; it must be finite in the whole group",
                   f->text, isnan(out[i]) ? "not a number" : "infinite", x[0][i],
                   dim > 1 ? ", ..." : "");
  }
  return SPH_OK;
}

int sph_case_value_field(const char *text, const sph_case_name *names, int n, int dim, long count,
                         const double *const x[], double *out, sph_case_value *result)
{
  sph_case_name all[MOST_NAMES];
  int m = with_coordinates(names, n, dim, 0, 1, all);
  formula f;
  int status = prepare(&f, text, all, m, result);
  if (status) return status;
  pthread_mutex_lock(&lock);
  muParserHandle_t parser = translate(&f, si) ? NULL : open_parser(&f, si);
  status = parser ? evaluate_points(&f, parser, m - dim, dim, count, x, out) : SPH_ERR_PARSE;
  if (parser) mupRelease(parser);
  pthread_mutex_unlock(&lock);
  return status;
}

/* ---- formulas that are evaluated again and again ---- */

struct sph_case_formula {
  formula f;
  sph_case_name names[MOST_NAMES];
  sph_case_value result;
  muParserHandle_t parser;
  int names_n, first, dim; /* first: place of x among the values */
};

/* Evaluated once here: muParser makes its code at the first evaluation. */
static int open_formula(sph_case_formula *it, const char *text, int m)
{
  int status = prepare(&it->f, text, it->names, m, &it->result);
  if (status) return status;
  pthread_mutex_lock(&lock);
  it->parser = translate(&it->f, si) ? NULL : open_parser(&it->f, si);
  status = it->parser ? SPH_OK : SPH_ERR_PARSE;
  if (!status) (void)mupEval(it->parser);
  if (!status && mupError(it->parser)) status = muparser_problem(&it->f, it->parser);
  pthread_mutex_unlock(&lock);
  return status;
}

/* The case may be gone when the formula is evaluated. */
static int copy_tables(sph_case_formula *it)
{
  int status = SPH_OK;
  for (int k = 0; k < it->names_n; k++) {
    if (!it->names[k].table) continue;
    it->names[k].table = status ? NULL : sph_case_table_copy(it->names[k].table);
    if (!it->names[k].table) status = SPH_ERR_MEMORY;
  }
  if (status) snprintf(it->result.problem, sizeof it->result.problem, "out of memory: a formula");
  return status;
}

sph_case_formula *sph_case_value_formula_create(const char *text, const sph_case_name *names, int n,
                                                int dim, sph_case_value *result)
{
  sph_case_formula *it = sph_memory_new(1, sizeof *it, "a formula", NULL);
  memset(result, 0, sizeof *result);
  if (!it) {
    snprintf(result->problem, sizeof result->problem, "out of memory: a formula");
    return NULL;
  }
  it->names_n = with_coordinates(names, n, dim, 1, 1, it->names);
  it->dim = dim;
  it->first = it->names_n - dim - 1;
  int status = copy_tables(it);
  if (!status) status = open_formula(it, text, it->names_n);
  *result = it->result;
  it->f.text = ""; /* the text is borrowed until here */
  if (!status) return it;
  sph_case_value_formula_free(it);
  return NULL;
}

int sph_case_value_formula_at(sph_case_formula *it, long count, const double *const x[], double t,
                              double *out)
{
  return sph_case_value_formula_with(it, count, x, t, 0, NULL, out);
}

int sph_case_value_formula_with(sph_case_formula *it, long count, const double *const x[], double t,
                                int fields, const double *const field[], double *out)
{
  int status = SPH_OK;
  pthread_mutex_lock(&lock);
  it->f.values[it->first + it->dim] = t;
  for (int k = 0; k < it->names_n; k++)
    if (it->names[k].table) it->f.values[k] = sph_case_table_at(it->names[k].table, t);
  for (long i = 0; !status && i < count; i++) {
    for (int d = 0; d < it->dim; d++) it->f.values[it->first + d] = x[d][i];
    for (int k = 0; k < fields; k++) it->f.values[k] = field[k][i];
    out[i] = mupEval(it->parser);
    if (mupError(it->parser) || !isfinite(out[i])) status = SPH_ERR_ARGUMENT;
  }
  pthread_mutex_unlock(&lock);
  return status;
}

void sph_case_value_formula_free(void *formula_of)
{
  sph_case_formula *it = formula_of;
  if (!it) return;
  pthread_mutex_lock(&lock);
  if (it->parser) mupRelease(it->parser);
  pthread_mutex_unlock(&lock);
  for (int k = 0; k < it->names_n; k++) sph_case_table_free(it->names[k].table);
  sph_memory_free(it);
}
