/* sphode info: the lists of what there is. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"

enum { DETAILS = 12, COLUMNS = 100, INDENT = 2 };

/* One row of a list: names and texts of its columns. */
typedef struct row {
  const char *name, *formula;
  char detail[DETAILS][40];
} row;

typedef struct list {
  const char *name;
  const char *detail[DETAILS]; /* names of the columns between name and formula */
  const char *kinds;           /* a letter for each: n: number, t: text, y: yes or no */
  int (*get)(int k, row *r);
  const char *text; /* what the last column is */
} list;

static int kernel_row(int k, row *r)
{
  const sph_kernel *kernel = sph_kernel_get(k);
  if (!kernel) return 0;
  r->name = sph_kernel_name(kernel);
  r->formula = sph_kernel_formula(kernel, 2);
  double h_over_dx = sph_kernel_h_over_dx(kernel);
  snprintf(r->detail[0], sizeof r->detail[0], "%s", sph_kernel_smoothness(kernel));
  const double number[] = {sph_kernel_support(kernel),
                           h_over_dx,
                           sph_kernel_neighbors(kernel, 2, h_over_dx),
                           sph_kernel_neighbors(kernel, 3, h_over_dx),
                           sph_kernel_lattice_error(kernel, 2, h_over_dx),
                           sph_kernel_lattice_error(kernel, 3, h_over_dx),
                           sph_kernel_deviation(kernel, 2),
                           sph_kernel_deviation(kernel, 3),
                           sph_kernel_least_transform(kernel, 2),
                           sph_kernel_least_transform(kernel, 3),
                           sph_kernel_rate(kernel)};
  for (int d = 0; d < 11; d++) snprintf(r->detail[d + 1], sizeof *r->detail, "%.9g", number[d]);
  return 1;
}

static int eos_row(int k, row *r)
{
  r->name = sph_eos_name(k);
  if (r->name) r->formula = sph_eos_formula(r->name);
  return r->name != NULL;
}

/* "about; gamma 7 (source)" */
static void material_line(const char *name, const sph_material *m, char *line, size_t size)
{
  const struct {
    const char *name, *unit;
    double value;
  } constant[] = {{"gamma", "", m->eos.gamma},
                  {"p_inf", " Pa", m->eos.p_inf},
                  {"q", " J/kg", m->eos.q},
                  {"s", "", m->eos.slope},
                  {"Gamma0", "", m->eos.grueneisen}};
  snprintf(line, size, "%s", sph_material_about(name));
  for (size_t k = 0; k < sizeof constant / sizeof *constant; k++) {
    size_t n = strlen(line);
    if (constant[k].value != 0)
      snprintf(line + n, size - n, "; %s %g%s", constant[k].name, constant[k].value,
               constant[k].unit);
  }
  size_t n = strlen(line);
  snprintf(line + n, size - n, " (%s)", m->source);
}

static int material_row(int k, row *r)
{
  static char line[400];
  r->name = sph_material_name(k);
  if (!r->name) return 0;
  sph_material m = sph_material_preset(r->name, 0);
  if (!m.eos.name) m = sph_material_preset(r->name, 1), m.eos.c0 = 0; /* numerical only */
  material_line(r->name, &m, line, sizeof line);
  r->formula = line;
  snprintf(r->detail[0], sizeof r->detail[0], "%s", m.eos.name);
  const double number[] = {m.eos.rho0, m.eos.c0, m.eos.c_v, m.viscosity, m.conductivity};
  for (int d = 0; d < 5; d++)
    snprintf(r->detail[1 + d], sizeof r->detail[1 + d], number[d] > 0 ? "%g" : "-", number[d]);
  return 1;
}

static int term_row(int k, row *r)
{
  r->name = sph_term_name(k);
  if (r->name) r->formula = sph_term_formula(r->name);
  return r->name != NULL;
}

static int boundary_row(int k, row *r)
{
  r->name = sph_boundary_name(k);
  if (r->name) r->formula = sph_boundary_formula(r->name);
  return r->name != NULL;
}

/* Behind the integrators that there are, those that a newer SUNDIALS has. */
static int missing_row(int k, row *r)
{
  sph_integrator_info info;
  sph_integrator_missing missing;
  int rows = 0;
  while (sph_integrator_info_get(rows, &info)) rows++;
  if (k < rows || !sph_integrator_missing_get(k - rows, &missing)) return 0;
  r->name = missing.name;
  for (int d = 0; d < 5; d++) snprintf(r->detail[d], sizeof r->detail[d], "-");
  snprintf(r->detail[5], sizeof r->detail[5], "%.*s", (int)strcspn(missing.needs, "o") - 1,
           missing.needs); /* "SUNDIALS 7.2" */
  return 1;
}

static int integrator_row(int k, row *r)
{
  sph_integrator_info info;
  if (!sph_integrator_info_get(k, &info)) return missing_row(k, r);
  r->name = info.name;
  snprintf(r->detail[0], sizeof r->detail[0], "%d", info.order);
  snprintf(r->detail[1], sizeof r->detail[1], "%d", info.stages);
  snprintf(r->detail[2], sizeof r->detail[2], "%s", info.error_control ? "yes" : "no");
  snprintf(r->detail[3], sizeof r->detail[3], "%.3g", info.stability);
  snprintf(r->detail[4], sizeof r->detail[4], "%s",
           info.wants & SPH_WANTS_IMPLICIT    ? "implicit"
           : info.wants & SPH_WANTS_FAST      ? "fast"
           : info.wants & SPH_WANTS_SEPARABLE ? "separable"
           : info.wants & SPH_WANTS_DOMINANT  ? "eigenvalue"
                                              : "none");
  snprintf(r->detail[5], sizeof r->detail[5], "yes");
  return 1;
}

static int search_row(int k, row *r)
{
  r->name = sph_neighbors_search_name(k);
  if (r->name) r->formula = sph_neighbors_search_about(r->name);
  return r->name != NULL;
}

static const list lists[] = {
    {"kernels",
     {"smoothness", "support/h", "h/dx", "neighbors-2d", "neighbors-3d", "lattice-error-2d",
      "lattice-error-3d", "sigma-k-2d", "sigma-k-3d", "least-transform-2d", "least-transform-3d",
      "rate"},
     "tnnnnnnnnnnn",
     kernel_row,
     "formula"},
    {"eos", {NULL}, "", eos_row, "formula"},
    {"materials",
     {"eos", "density", "c0", "c_v", "viscosity", "conductivity"},
     "tnnnnn",
     material_row,
     "about"},
    {"terms", {NULL}, "", term_row, "formula"},
    {"integrators",
     {"order", "stages", "error-control", "stability", "wants", "built"},
     "nnyntt",
     integrator_row,
     "formula"},
    {"boundaries", {NULL}, "", boundary_row, "formula"},
    {"searches", {NULL}, "", search_row, "about"},
};

static void json_string(const char *text)
{
  putchar('"');
  for (const char *at = text; *at; at++) {
    if (*at == '"' || *at == '\\') putchar('\\');
    putchar(*at);
  }
  putchar('"');
}

static void json_value(char kind, const char *text)
{
  if (kind == 't')
    json_string(text);
  else if (kind == 'y')
    fputs(!strcmp(text, "yes") ? "true" : strcmp(text, "no") ? "null" : "false", stdout);
  else {
    char *end;
    double value = strtod(text, &end);
    fputs(end != text && isfinite(value) ? text : "null", stdout);
  }
}

static void print_json(const list *l)
{
  row r = {0};
  for (int k = 0; l->get(k, &r); k++) {
    fputs(k ? ",\n  {\"name\": " : "[\n  {\"name\": ", stdout);
    json_string(r.name);
    for (int d = 0; d < DETAILS && l->detail[d]; d++) {
      fputs(", ", stdout);
      json_string(l->detail[d]);
      fputs(": ", stdout);
      json_value(l->kinds[d], r.detail[d]);
    }
    if (r.formula) printf(", \"%s\": ", l->text);
    if (r.formula) json_string(r.formula);
    putchar('}');
  }
  puts("\n]");
}

/* Of column d; -1: of the names. */
static int width(const list *l, int d)
{
  row r = {0};
  size_t most = d < 0 ? 4 : strlen(l->detail[d]);
  for (int k = 0; l->get(k, &r); k++) {
    size_t n = strlen(d < 0 ? r.name : r.detail[d]);
    if (n > most) most = n;
  }
  return (int)most;
}

/* Where to break a text longer than room: at the last space that fits, or, where there is one past
 * the middle, at the last after a comma or before "or": formulas stay whole. */
static size_t line_end(const char *text, size_t room)
{
  size_t last = 0, good = 0;
  for (size_t n = 1; n <= room; n++) {
    if (text[n] != ' ') continue;
    last = n;
    if (strchr(",;", text[n - 1]) || !strncmp(text + n, " or ", 4)) good = n;
  }
  return good > room / 2 ? good : last ? last : strcspn(text, " ");
}

/* In lines of at most COLUMNS, indented. */
static void print_wrapped(const char *text)
{
  const size_t room = COLUMNS - INDENT;
  while (*text) {
    size_t n = strlen(text);
    if (n > room) n = line_end(text, room);
    printf("%*s%.*s\n", INDENT, "", (int)n, text);
    text += n;
    text += strspn(text, " ");
  }
}

static void print_list(const list *l)
{
  row r = {0};
  int first = width(l, -1), wide[DETAILS] = {0};
  for (int d = 0; d < DETAILS && l->detail[d]; d++) wide[d] = width(l, d);
  if (l->detail[0]) printf("%-*s", first, "name");
  for (int d = 0; d < DETAILS && l->detail[d]; d++) printf("  %*s", wide[d], l->detail[d]);
  if (l->detail[0]) putchar('\n');
  for (int k = 0; l->get(k, &r); k++) {
    if (l->detail[0])
      printf("%-*s", first, r.name);
    else
      fputs(r.name, stdout);
    for (int d = 0; d < DETAILS && l->detail[d]; d++) printf("  %*s", wide[d], r.detail[d]);
    putchar('\n');
    if (r.formula) print_wrapped(r.formula);
  }
}

static int print_manual(void)
{
  int n = sph_case_manual(NULL, 0);
  char *text = n > 0 ? malloc((size_t)n + 1) : NULL;
  if (!text) return sph_prog_error(PROG_FAILED, "out of memory");
  sph_case_manual(text, (size_t)n + 1);
  fputs(text, stdout);
  free(text);
  return PROG_OK;
}

int sph_prog_info(const prog_options *o)
{
  if (!strcmp(o->what, "case")) return print_manual();
  int kernels = !strcmp(o->what, "kernels");
  if ((o->csv || o->q) && !kernels)
    return sph_prog_error(PROG_USAGE, "--csv and --q belong to info kernels");
  if ((o->spacing || o->dim) && !kernels)
    return sph_prog_error(PROG_USAGE, "--spacing and --dim belong to info kernels");
  if (o->csv || o->q) return sph_prog_kernels_values(o);
  if (o->spacing || o->dim) return sph_prog_advice(o);
  if (kernels && !o->json) return sph_prog_kernels_table(), PROG_OK;
  for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
    if (strcmp(lists[k].name, o->what)) continue;
    (o->json ? print_json : print_list)(&lists[k]);
    return PROG_OK;
  }
  return sph_prog_error(
      PROG_USAGE,
      "info %s: known are kernels, eos, materials, terms, integrators, boundaries, "
      "searches, case",
      o->what);
}
