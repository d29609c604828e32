/* What a sweep tells: a table for people and one for programs, and how errors fall. */
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog_sweep.h"

enum { GREY = 7 }; /* of the palette of curves */

static int good(const sweep_run *r) { return r->done && (r->status == 0 || r->status == PROG_BAR); }

/* The first run that tells its comparisons: all have the same. */
static const sweep_run *model(const sweep *s)
{
  for (int k = 0; k < s->runs; k++)
    if (good(&s->run[k]) && s->run[k].compared) return &s->run[k];
  return NULL;
}

/* What errors are told over: the spacing where that changes, else the number that is varied. */
static int by_spacing(const sweep *s)
{
  double first = 0;
  for (int k = 0; k < s->runs; k++) {
    if (!good(&s->run[k])) continue;
    if (first > 0 && s->run[k].spacing != first) return 1;
    first = s->run[k].spacing;
  }
  return 0;
}

static double abscissa(const sweep *s, int k)
{
  char *end, *equal = strchr(s->run[k].set[0], '=');
  if (by_spacing(s)) return s->run[k].spacing;
  const double x = strtod(equal + 1, &end);
  return end == equal + 1 ? NAN : x;
}

/* log(e/e')/log(x/x') beside the good run before; NaN: there is none. */
static double order(const sweep *s, int k, int c)
{
  for (int before = k - 1; before >= 0 && s->keys == 1; before--) {
    if (!good(&s->run[before])) continue;
    return log(s->run[k].of[c].value / s->run[before].of[c].value) /
           log(abscissa(s, k) / abscissa(s, before));
  }
  return NAN;
}

int sph_prog_sweep_stopped(const sweep_run *r)
{
  return r->status == PROG_LIMIT || r->status == 128 + SIGINT || r->status == 128 + SIGTERM;
}

static const char *state(const sweep_run *r)
{
  return !r->done                    ? "not run"
         : r->status == 0            ? "done"
         : r->status == PROG_BAR     ? "misses a bar"
         : sph_prog_sweep_stopped(r) ? "stopped"
                                     : "failed";
}

void sph_prog_sweep_print(const sweep *s)
{
  const sweep_run *m = model(s);
  int width = 4;
  for (int k = 0; k < s->runs; k++)
    if ((int)strlen(s->run[k].name) > width) width = (int)strlen(s->run[k].name);
  printf("%-*s  %-12s  %9s  %7s  %8s", width, "run", "", "particles", "steps", "seconds");
  for (int c = 0; m && c < m->compared; c++) printf("  %12s %5s", c ? "" : "distance", "order");
  putchar('\n');
  for (int k = 0; k < s->runs; k++) {
    const sweep_run *r = &s->run[k];
    printf("%-*s  %-12s", width, r->name, state(r));
    if (good(r)) printf("  %9ld  %7ld  %8.3g", r->particles, r->steps, r->seconds);
    for (int c = 0; good(r) && c < r->compared; c++) {
      const double p = order(s, k, c);
      printf("  %12.4g", r->of[c].value);
      printf(isfinite(p) ? " %5.2f" : "      ", p);
    }
    putchar('\n');
  }
  for (int c = 0; m && c < m->compared; c++)
    printf("%s: %s (%s)\n", c ? "" : "distances, in their order", m->of[c].name, m->of[c].norm);
  printf("results      %s\n", s->directory);
}

/* Under another name until it is whole. */
static FILE *open_table(const sweep *s, const char *name)
{
  char path[4100];
  snprintf(path, sizeof path, "%s/%s.tmp", s->directory, name);
  FILE *file = fopen(path, "w");
  if (!file) sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno));
  return file;
}

/* A name as one cell. */
static void put_cell(FILE *file, const char *text)
{
  for (; *text; text++) fputc(*text == ',' ? ';' : *text, file);
}

static int close_table(const sweep *s, const char *name, FILE *file)
{
  char path[4100], part[4110];
  snprintf(path, sizeof path, "%s/%s", s->directory, name);
  snprintf(part, sizeof part, "%s.tmp", path);
  int bad = fflush(file) || ferror(file), why = bad ? errno : 0;
  if (fclose(file) && !bad) bad = 1, why = errno;
  if (!bad && !rename(part, path)) return PROG_OK;
  if (!bad) why = errno;
  unlink(part);
  return sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(why));
}

/* Comparison c as the name of a column: "NAME (NORM)", and its number where another has that. */
enum { COLUMN = 120 };
static void name_column(const sweep_run *m, int c, char name[COLUMN])
{
  int same = 0;
  for (int before = 0; before < c; before++)
    same |=
        !strcmp(m->of[before].name, m->of[c].name) && !strcmp(m->of[before].norm, m->of[c].norm);
  const int n = snprintf(name, COLUMN, "%s (%s)", m->of[c].name, m->of[c].norm);
  if (same) snprintf(name + n, COLUMN - (size_t)n, " %d", c);
  for (char *at = name; *at; at++)
    *at = *at == ',' ? ';' : *at == '[' ? '(' : *at == ']' ? ')' : *at;
}

static int write_runs(const sweep *s)
{
  const sweep_run *m = model(s);
  FILE *file = open_table(s, "sweep.csv");
  if (!file) return PROG_FAILED;
  fprintf(file, "run");
  for (int k = 0; k < s->keys; k++) fprintf(file, ",%s", s->key[k].key);
  fprintf(file, ",status,spacing [m],particles,steps,wall [s]");
  for (int c = 0; m && c < m->compared; c++) {
    char name[COLUMN];
    name_column(m, c, name);
    fprintf(file, ",%s,order %d", name, c);
  }
  fputc('\n', file);
  for (int k = 0; k < s->runs; k++) {
    const sweep_run *r = &s->run[k];
    put_cell(file, r->name);
    for (int j = 0; j < s->keys; j++) {
      fputc(',', file);
      put_cell(file, strchr(r->set[j], '=') + 1);
    }
    fprintf(file, ",%d,%.9g,%ld,%ld,%.6g", r->done ? r->status : -1, good(r) ? r->spacing : NAN,
            r->particles, r->steps, r->seconds);
    for (int c = 0; m && c < m->compared; c++) {
      const int there = good(r) && c < r->compared;
      fprintf(file, ",%.9g,%.4g", there ? r->of[c].value : NAN, there ? order(s, k, c) : NAN);
    }
    fputc('\n', file);
  }
  return close_table(s, "sweep.csv", file);
}

/* Those that can be drawn: errors > 0 of at least two runs. */
static int drawn(const sweep *s, int c)
{
  int n = 0;
  for (int k = 0; k < s->runs; k++) {
    if (!good(&s->run[k])) continue;
    if (c >= s->run[k].compared || !(s->run[k].of[c].value > 0) || !(abscissa(s, k) > 0)) return 0;
    n++;
  }
  return n > 1 && s->keys == 1;
}

/* The coarsest run, in which slopes begin; -1: errors are not told over the spacing. */
static int coarsest(const sweep *s)
{
  int found = -1;
  for (int k = 0; k < s->runs && by_spacing(s); k++)
    if (good(&s->run[k]) && (found < 0 || s->run[k].spacing > s->run[found].spacing)) found = k;
  return found;
}

/* The first curve and where it began, had it order p. */
static double slope(const sweep *s, int k, int p)
{
  const int begin = coarsest(s);
  int first = 0;
  while (!drawn(s, first)) first++;
  return s->run[begin].of[first].value * pow(s->run[k].spacing / s->run[begin].spacing, p);
}

static int write_errors(const sweep *s, const sweep_run *m)
{
  FILE *file = open_table(s, "convergence.csv");
  const int slopes = coarsest(s) >= 0;
  char name[COLUMN];
  if (!file) return PROG_FAILED;
  fprintf(file, "%s", by_spacing(s) ? "spacing [m]" : s->key[0].key);
  for (int c = 0; c < m->compared; c++) {
    name_column(m, c, name);
    if (drawn(s, c)) fprintf(file, ",%s", name);
  }
  fputs(slopes ? ",order 1,order 2\n" : "\n", file);
  for (int k = 0; k < s->runs; k++) {
    if (!good(&s->run[k])) continue;
    fprintf(file, "%.9g", abscissa(s, k));
    for (int c = 0; c < m->compared; c++)
      if (drawn(s, c)) fprintf(file, ",%.9g", s->run[k].of[c].value);
    for (int p = 1; slopes && p <= 2; p++) fprintf(file, ",%.9g", slope(s, k, p));
    fputc('\n', file);
  }
  return close_table(s, "convergence.csv", file);
}

/* What the curves fill. */
static void bounds(const sweep *s, const sweep_run *m, double lo[2], double hi[2])
{
  for (int c = 0; c < m->compared; c++)
    for (int k = 0; drawn(s, c) && k < s->runs; k++) {
      if (!good(&s->run[k])) continue;
      lo[0] = fmin(lo[0], abscissa(s, k)), hi[0] = fmax(hi[0], abscissa(s, k));
      lo[1] = fmin(lo[1], s->run[k].of[c].value), hi[1] = fmax(hi[1], s->run[k].of[c].value);
    }
}

static int draw(const sweep *s, const sweep_run *m)
{
  char csv[4000], png[4000], column[SWEEP_COMPARED][COLUMN];
  sph_plot_curve curve[SWEEP_COMPARED + 2]; /* and slopes */
  double lo[2] = {INFINITY, INFINITY}, hi[2] = {0, 0};
  int n = 0;
  const char *slash = strrchr(s->o->what, '/'), *x = by_spacing(s) ? "spacing" : s->key[0].key;
  snprintf(csv, sizeof csv, "%s/convergence.csv", s->directory);
  snprintf(png, sizeof png, "%s/convergence.png", s->directory);
  for (int p = 1; coarsest(s) >= 0 && p <= 2; p++) /* behind the curves */
    curve[n++] = (sph_plot_curve){.csv = csv,
                                  .x = x,
                                  .y = p == 1 ? "order 1" : "order 2",
                                  .label = p == 1 ? "orders 1 and 2" : "",
                                  .colour = GREY};
  for (int c = 0, colour = 0; c < m->compared; c++) {
    if (!drawn(s, c)) continue;
    name_column(m, c, column[c]);
    colour++;
    curve[n++] =
        (sph_plot_curve){.csv = csv, .x = x, .y = column[c], .points = 2, .colour = colour};
  }
  bounds(s, m, lo, hi);
  const sph_plot_def def = {.title = slash ? slash + 1 : s->o->what,
                            .x_label = by_spacing(s) ? "spacing [m]" : s->key[0].key,
                            .y_label = "distance from the reference",
                            .log_x = 1,
                            .log_y = 1,
                            .x_min = lo[0] / 1.2,
                            .x_max = hi[0] * 1.2,
                            .y_min = lo[1] / 1.5,
                            .y_max = hi[1] * 1.5};
  sph_error error = {0};
  const int status = sph_plot_series(curve, n, &def, png, &error);
  if (status)
    sph_prog_error(PROG_FAILED, "no picture: %s", error.text);
  else if (!s->o->quiet)
    printf("picture      %s\n", png);
  return status && status != SPH_ERR_UNBUILT ? PROG_FAILED : PROG_OK;
}

int sph_prog_sweep_write(const sweep *s)
{
  const sweep_run *m = model(s);
  int status = write_runs(s), curves = 0;
  for (int c = 0; m && c < m->compared; c++) curves += drawn(s, c);
  if (status || !curves) return status;
  status = write_errors(s, m);
  return status ? status : draw(s, m);
}
