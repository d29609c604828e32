/* What work-precision tells: a table for people, one for programs, two pictures. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "prog_work.h"

static const double levels[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
enum { LEVELS = sizeof levels / sizeof *levels };
static const double ASTRAY = 10; /* such an error is none of its steps' size */

/* ---- what a run needed */

typedef struct cost {
  const char *title, *name; /* in the text; in the CSV file */
} cost;

static const cost costs[] = {
    {"steps", "steps"},
    {"rejected", "rejected"},
    {"evaluations", "evaluations"},
    {"fast", "fast"},
    {"implicit", "implicit"},
    {"solves", "solves"},
    {"iterations", "iterations"},
};
enum { COSTS = sizeof costs / sizeof *costs, EVALUATIONS = 2, IMPLICIT = 4 };

static long cost_of(const work_run *r, int k)
{
  const sph_step_stats *s = &r->stats.step;
  const long value[COSTS] = {s->steps,
                             s->rejected + s->retries,
                             s->rhs_evaluations,
                             s->fast_evaluations,
                             s->implicit_evaluations,
                             s->solves,
                             s->solve_iterations};
  return value[k];
}

/* Is that a column of the text?  What only some methods have is left out where none has it. */
static int is_told(const work *w, int k)
{
  for (int r = 0; k > EVALUATIONS && r < w->runs; r++)
    if (cost_of(&w->run[r], k)) return 1;
  return k <= EVALUATIONS;
}

/* Those of f and of its implicit part. */
static double evaluations(const work_run *r)
{
  return (double)(cost_of(r, EVALUATIONS) + cost_of(r, IMPLICIT));
}

static double seconds(const work_run *r) { return r->cpu; }

/* The least cost of an integrator for an error of at most `error`, between two of its runs by
 * straight lines in the diagram; NaN: none of its runs is as good. */
static double needed(const work *w, int method, double error, double (*of)(const work_run *r))
{
  double least = INFINITY, x0 = NAN, y0 = NAN;
  for (int k = 0; k < w->runs; k++) {
    const work_run *r = &w->run[k];
    if (r->method != method) continue;
    double x = log(of(r)), y = log(r->error[w->shown]);
    if (y <= log(error)) least = fmin(least, x);
    double part = (log(error) - y0) / (y - y0);
    if (part >= 0 && part <= 1) least = fmin(least, x0 + part * (x - x0));
    x0 = x, y0 = y;
  }
  return least < INFINITY ? exp(least) : NAN;
}

/* ---- the table for people, to a file and to standard output */

typedef struct pages {
  FILE *file[2];
} pages;

static void put(const pages *to, const char *format, ...) SPH_PRINTF(2, 3);
static void put(const pages *to, const char *format, ...)
{
  for (int k = 0; k < 2; k++) {
    if (!to->file[k]) continue;
    va_list arguments;
    va_start(arguments, format);
    vfprintf(to->file[k], format, arguments);
    va_end(arguments);
  }
}

/* Is a field a column of the text?  One that no run changes is left out. */
static int differs(const work *w, int f)
{
  for (int k = 0; k < w->runs; k++)
    if (w->run[k].error[f] > 0) return 1;
  return f == w->shown;
}

static void put_head(const work *w, const pages *to)
{
  const work_fields *fields = &w->fields;
  const work_run *best = &w->best;
  put(to, "%s\n\n", sph_case_title(w->reference.c));
  put(to, "case         %s", w->o->what);
  for (int k = 0; k < w->o->sets; k++) put(to, " --set %s", w->o->set[k]);
  put(to, "\nend          t = %.6g s, %ld particles\n", w->end, fields->particles);
  put(to, "errors       root mean squares over particles, in");
  for (int f = 0; f < fields->n; f++)
    put(to, "%s %s %.4g %s", f ? "," : "", fields->name[f], fields->scale[f], fields->unit[f]);
  put(to, "\nreference    %s in steps of %.4g s (halved %d times, %ld evaluations)\n",
      w->reference.label, best->dt_fixed, w->halvings, best->stats.step.rhs_evaluations);
  put(to, "its error   ");
  for (int f = 0, n = 0; f < fields->n; f++)
    if (differs(w, f)) put(to, "%s %s %.1e", n++ ? "," : "", fields->name[f], w->floor_of[f]);
  put(to, "%s\n%-12s ~ where an error is less than ten times that\n",
      w->poor ? ": MORE than a tenth of the least below" : ", from halving its steps", "");
}

static void put_run(const work *w, const work_run *r, const pages *to)
{
  char what[40];
  snprintf(what, sizeof what, "%s %.4g", r->setting, r->value);
  put(to, "  %-16s", what);
  if (r->status) {
    put(to, "  failed: %s\n", r->reason);
    return;
  }
  for (int k = 0; k < COSTS; k++)
    if (is_told(w, k)) put(to, " %11ld", cost_of(r, k));
  put(to, " %9.3g ", r->cpu);
  for (int f = 0; f < w->fields.n; f++)
    if (differs(w, f))
      put(to, " %c%8.2e", r->error[f] < 10 * w->floor_of[f] ? '~' : ' ', r->error[f]);
  put(to, "\n");
}

static void put_runs(const work *w, const pages *to)
{
  put(to, "\n%-18s", "");
  for (int k = 0; k < COSTS; k++)
    if (is_told(w, k)) put(to, " %11s", costs[k].title);
  put(to, " %9s ", "CPU [s]");
  for (int f = 0; f < w->fields.n; f++)
    if (differs(w, f)) put(to, " %9.9s", w->fields.name[f]);
  put(to, "\n");
  for (int k = 0, method = -1; k < w->runs; k++) {
    if (w->run[k].method != method) put(to, "%s\n", w->method[w->run[k].method].label);
    method = w->run[k].method;
    put_run(w, &w->run[k], to);
  }
}

/* The longest label, and no less than is usual. */
static int label_width(const work *w)
{
  int width = 34;
  for (int m = 0; m < w->methods; m++)
    if ((int)strlen(w->method[m].label) > width) width = (int)strlen(w->method[m].label);
  return width;
}

static void put_needed(const work *w, const pages *to, const char *what,
                       double (*of)(const work_run *r))
{
  const int width = label_width(w);
  put(to, "\n%s for an error of %s of\n%-*s", what, w->fields.name[w->shown], width, "");
  for (int k = 0; k < LEVELS; k++) put(to, " %9.0e", levels[k]);
  put(to, "\n");
  for (int m = 0; m < w->methods; m++) {
    put(to, "%-*s", width, w->method[m].label);
    for (int k = 0; k < LEVELS; k++) {
      double value = needed(w, m, levels[k], of);
      if (isnan(value))
        put(to, " %9s", "-");
      else
        put(to, " %9.3g", value);
    }
    put(to, "\n");
  }
}

static FILE *create(const work *w, const char *name, char path[4096])
{
  snprintf(path, 4096, "%s/%s", w->directory, name);
  FILE *file = fopen(path, "w");
  if (!file) sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno));
  return file;
}

static int finish(FILE *file, const char *path)
{
  int bad = ferror(file);
  if (!fclose(file) && !bad) return PROG_OK;
  return sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno));
}

static int write_text(const work *w)
{
  char path[4096];
  FILE *file = create(w, "work-precision.txt", path);
  if (!file) return PROG_FAILED;
  pages to = {{file, w->o->quiet ? NULL : stdout}};
  put_head(w, &to);
  put_runs(w, &to);
  put_needed(w, &to, "Evaluations", evaluations);
  put_needed(w, &to, "CPU seconds", seconds);
  return finish(file, path);
}

/* ---- for programs */

static void write_row(const work *w, const work_run *r, FILE *file)
{
  fprintf(file, "%s,%s,%.6g,%.6g", w->method[r->method].label, r->setting, r->value,
          r->stats.step.steps ? w->end / (double)r->stats.step.steps : NAN);
  for (int k = 0; k < COSTS; k++) fprintf(file, ",%ld", cost_of(r, k));
  fprintf(file, ",%.4g,%.4g", r->cpu, r->wall);
  for (int f = 0; f < w->fields.n; f++) fprintf(file, ",%.4e", r->error[f]);
  char reason[sizeof r->reason];
  snprintf(reason, sizeof reason, "%s", r->status ? r->reason : "done");
  for (char *c = reason; *c; c++)
    if (*c == ',') *c = ';';
  fprintf(file, ",%s\n", reason);
}

static int write_csv(const work *w)
{
  char path[4096];
  FILE *file = create(w, "work-precision.csv", path);
  if (!file) return PROG_FAILED;
  pages to = {{file, NULL}};
  fprintf(file, "# %s\n# %s\n# reference: %s in steps of %.6g s; its error:", w->o->command,
          sph_case_title(w->reference.c), w->reference.label, w->best.dt_fixed);
  for (int f = 0; f < w->fields.n; f++)
    put(&to, "%s %s %.2e", f ? "," : "", w->fields.name[f], w->floor_of[f]);
  fprintf(file, "\n# errors: root mean squares over particles; in units of");
  for (int f = 0; f < w->fields.n; f++)
    put(&to, "%s %s %.6g %s", f ? "," : "", w->fields.name[f], w->fields.scale[f],
        w->fields.unit[f]);
  fprintf(file, "\nintegrator,setting,value,dt [s]");
  for (int k = 0; k < COSTS; k++) fprintf(file, ",%s", costs[k].name);
  fprintf(file, ",cpu [s],wall [s]");
  for (int f = 0; f < w->fields.n; f++) fprintf(file, ",%s", w->fields.name[f]);
  fprintf(file, ",outcome\n");
  for (int k = 0; k < w->runs; k++) write_row(w, &w->run[k], file);
  return finish(file, path);
}

/* ---- pictures */

typedef struct span {
  double low, high;
} span;

static void widen(span *s, double value)
{
  if (!(value > 0 && isfinite(value))) return;
  s->low = fmin(s->low, value);
  s->high = fmax(s->high, value);
}

/* Powers of ten around the errors, costs with a margin; runs that went astray stay outside. */
static void range(const work *w, sph_plot_def *def, double (*of)(const work_run *r))
{
  span error = {INFINITY, 0}, needs = {INFINITY, 0};
  for (int k = 0; k < w->runs; k++) {
    const work_run *r = &w->run[k];
    if (!(r->error[w->shown] > 0 && r->error[w->shown] < ASTRAY)) continue;
    widen(&error, r->error[w->shown]);
    widen(&needs, of(r));
  }
  if (!(error.low < INFINITY)) return;
  def->y_min = pow(10, floor(log10(error.low)));
  def->y_max = fmax(pow(10, ceil(log10(error.high))), 10 * def->y_min);
  def->x_min = needs.low / 1.25;
  def->x_max = needs.high * 1.25;
}

static int draw(const work *w, const char *column, double (*of)(const work_run *r),
                const char *label, const char *name)
{
  char csv[4096], png[4096], x_label[120], y_label[120];
  sph_plot_curve curve[WORK_METHODS];
  int n = 0;
  snprintf(csv, sizeof csv, "%s/work-precision.csv", w->directory);
  snprintf(png, sizeof png, "%s/%s.png", w->directory, name);
  snprintf(x_label, sizeof x_label, "%s, to t = %.4g s", label, w->end);
  snprintf(y_label, sizeof y_label, "error of %s / %.4g %s", w->fields.name[w->shown],
           w->fields.scale[w->shown], w->fields.unit[w->shown]);
  sph_plot_def def = {.title = sph_case_title(w->reference.c),
                      .x_label = x_label,
                      .y_label = y_label,
                      .log_x = 1,
                      .log_y = 1};
  range(w, &def, of);
  for (int m = 0; m < w->methods; m++) {
    int good = 0;
    for (int k = 0; k < w->runs; k++)
      good += w->run[k].method == m && w->run[k].error[w->shown] > 0;
    if (good)
      curve[n++] = (sph_plot_curve){.csv = csv,
                                    .x = column,
                                    .y = w->fields.name[w->shown],
                                    .where = "integrator",
                                    .is = w->method[m].label,
                                    .label = w->method[m].label,
                                    .points = 2};
  }
  sph_error error = {0};
  if (!n) return PROG_OK;
  if (sph_plot_series(curve, n, &def, png, &error))
    return sph_prog_error(PROG_FAILED, "no picture: %s", error.text);
  if (!w->o->quiet) printf("picture      %s\n", png);
  return PROG_OK;
}

int sph_prog_work_report(work *w)
{
  int status = write_csv(w);
  if (!status) status = write_text(w);
  if (status) return status;
  if (!w->o->quiet) printf("\nresults      %s\n", w->directory);
  fflush(stdout);
  if (!draw(w, "evaluations", evaluations,
            "evaluations of the right-hand side (and of its implicit part)", "evaluations"))
    draw(w, "cpu", seconds, "CPU time [s]", "seconds");
  return PROG_OK;
}
