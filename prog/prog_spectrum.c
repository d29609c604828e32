/* sphode spectrum: eigenvalues of the Jacobian of a small case, and the longest steps that explicit
 * integrators can make of them. */
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog.h"

enum { CURVES = 8, RAYS = 90, TABLE = 64 };
static const char *const drawn[] = {"leapfrog", "erk:bogacki-shampine-4-2-3",
                                    "erk:dormand-prince-7-4-5", "erk:rdpk3sp49-9-3-4"};

typedef struct spectrum {
  const prog_options *o;
  sph_case *c;
  sph_sim *sim;
  sph_jacobian *J;
  char directory[4000];
  long n;          /* eigenvalues */
  double *re, *im; /* [n] [1/s] */
  double fastest;  /* max of c + |v| [m/s] */
  int methods;     /* of the table that have a region */
  sph_integrator_info method[TABLE];
  double step[TABLE]; /* [s] */
} spectrum;

/* ---- the eigenvalues ---- */

static int build(spectrum *s)
{
  sph_error error = {0};
  char until[200];
  const char *set[PROG_SETS + 1];
  int n = 0;
  for (; n < s->o->sets; n++) set[n] = s->o->set[n];
  if (s->o->until) {
    snprintf(until, sizeof until, "run.end=%s", s->o->until);
    set[n++] = until;
  }
  s->c = sph_case_read(s->o->what, n, set, &error);
  if (s->c) s->sim = sph_case_build(s->c, s->o->threads, &error);
  if (!s->sim) return sph_prog_error(PROG_FAILED, "%s", error.text);
  int status = s->o->until ? sph_sim_run(s->sim, sph_case_end(s->c)) : sph_sim_evaluate(s->sim);
  return status ? sph_prog_sim_error(s->c, s->sim, s->o->what) : PROG_OK;
}

static double fastest(const sph_sim *sim)
{
  double most = 0;
  const sph_group *group;
  for (int g = 0; (group = sph_sim_group_get(sim, g)); g++) {
    const double *c = sph_group_read(group, "sound_speed", 0), *v[3] = {NULL, NULL, NULL};
    if (strcmp(sph_group_kind(group), "fluid") || !c) continue;
    for (int d = 0; d < sph_sim_dim(sim); d++) v[d] = sph_group_read(group, "velocity", d);
    for (long i = 0; i < sph_group_count(group); i++) {
      double v2 = 0;
      for (int d = 0; d < 3; d++) v2 += v[d] ? v[d][i] * v[d][i] : 0;
      most = fmax(most, c[i] + sqrt(v2));
    }
  }
  return most;
}

/* The integrators whose regions are asked for; told before the work. */
static int check_names(const prog_options *o)
{
  char list[2000] = "", *rest = list, *word;
  int n = 0;
  if (!o->integrators) return PROG_OK;
  snprintf(list, sizeof list, "%s", o->integrators);
  for (; (word = strsep(&rest, ",")); n++)
    if (isnan(sph_stability_extent(word, acos(-1))))
      return sph_prog_error(PROG_USAGE,
                            "--integrators: \"%s\" is no explicit integrator; see sphode info "
                            "integrators",
                            word);
  if (n <= CURVES) return PROG_OK;
  return sph_prog_error(PROG_USAGE, "--integrators: %d of them; at most %d are drawn", n, CURVES);
}

/* What there would be to find; told before the work. */
static int check_size(spectrum *s)
{
  s->J = sph_jacobian_create(s->sim, NULL);
  if (!s->J) return sph_prog_sim_error(s->c, s->sim, s->o->what);
  long n = s->J->n;
  const sph_group *group;
  for (int g = 0; s->o->frozen && (group = sph_sim_group_get(s->sim, g)); g++)
    if (!strcmp(sph_group_kind(group), "fluid")) n -= sph_sim_dim(s->sim) * sph_group_count(group);
  if (n > SPH_EIGENVALUES_MAX)
    return sph_prog_error(PROG_FAILED,
                          "%s: %ld eigenvalues; at most %d can be found: a larger spacing, as "
                          "--set spacing=...%s",
                          s->o->what, n, SPH_EIGENVALUES_MAX,
                          s->o->frozen ? "" : ", or --frozen: particles that stay where they are");
  if (!s->o->quiet && n > 800)
    fprintf(stderr, "%ld eigenvalues: about %.0f s\n", n, 5 * pow((double)n / 1000, 3));
  return PROG_OK;
}

static int find(spectrum *s)
{
  sph_jacobian *J = s->J;
  s->re = malloc((size_t)J->n * sizeof *s->re);
  s->im = malloc((size_t)J->n * sizeof *s->im);
  if (!s->re || !s->im) return sph_prog_error(PROG_FAILED, "out of memory");
  if (!sph_jacobian_evaluate(J)) s->n = sph_jacobian_eigenvalues(J, s->o->frozen, s->re, s->im);
  if (!sph_sim_status(s->sim)) return PROG_OK;
  return sph_prog_sim_error(s->c, s->sim, s->o->what);
}

static void find_steps(spectrum *s)
{
  sph_integrator_info info;
  s->fastest = fastest(s->sim);
  for (int k = 0; s->methods < TABLE && sph_integrator_info_get(k, &info); k++) {
    double step = sph_stability_step(info.name, s->n, s->re, s->im);
    if (isnan(step)) continue; /* implicit, or made of others */
    s->method[s->methods] = info;
    s->step[s->methods++] = step;
  }
}

/* ---- the text ---- */

typedef struct pages {
  FILE *file[2]; /* the report, standard output; NULL: none */
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

typedef struct extremes {
  double growth, decay, oscillation, size, least; /* least: > 1e-6 of the largest */
} extremes;

static extremes look(const spectrum *s)
{
  extremes x = {-INFINITY, 0, 0, 0, INFINITY};
  for (long k = 0; k < s->n; k++) {
    x.growth = fmax(x.growth, s->re[k]);
    x.decay = fmax(x.decay, -s->re[k]);
    x.oscillation = fmax(x.oscillation, fabs(s->im[k]));
    x.size = fmax(x.size, hypot(s->re[k], s->im[k]));
  }
  for (long k = 0; k < s->n; k++) {
    double size = hypot(s->re[k], s->im[k]);
    if (size > 1e-6 * x.size) x.least = fmin(x.least, size);
  }
  return x;
}

static void put_head(const spectrum *s, const pages *to)
{
  const extremes x = look(s);
  const double h = sph_sim_h(s->sim), unit = h / s->fastest;
  put(to, "%s\n\n", sph_case_title(s->c));
  put(to, "case          %s", s->o->what);
  for (int k = 0; k < s->o->sets; k++) put(to, " --set %s", s->o->set[k]);
  put(to, "\nstate         t = %.6g s, %ld eigenvalues%s\n", sph_sim_time(s->sim), s->n,
      s->o->frozen ? ", positions held" : "");
  put(to, "oscillation   |Im| <= %.6g 1/s = %.4g (c + |v|)/h\n", x.oscillation,
      x.oscillation * unit);
  put(to, "decay         -Re <= %.6g 1/s = %.4g (c + |v|)/h\n", x.decay, x.decay * unit);
  put(to, "growth        Re <= %.6g 1/s, %.1e of the largest%s\n", x.growth, x.growth / x.size,
      x.growth > 1e-3 * x.size ? ": the state is not steady or not stable" : "");
  put(to, "stiffness     %.4g: the largest |lambda|, %.6g 1/s, over the least above 1e-6 of it\n",
      x.size / x.least, x.size);
  put(to, "h/(c + |v|)   %.6g s\n", unit);
}

static void put_steps(const spectrum *s, const pages *to)
{
  const double unit = sph_sim_h(s->sim) / s->fastest;
  put(to, "\n%-34s %12s %14s %6s %18s\n", "longest stable step", "dt [s]", "dt (c+|v|)/h", "S",
      "evaluations/(h/c)");
  for (int k = 0; k < s->methods; k++)
    put(to, "%-34s %12.4g %14.3f %6.2f %18.3g\n", s->method[k].name, s->step[k], s->step[k] / unit,
        s->method[k].stability, s->method[k].stages * unit / s->step[k]);
  put(to,
      "\nNo mode is amplified by more than 1.001 a step.  S: the limit that the library uses, as\n"
      "measured in runs.  imex, mri, sprk and lsrk schemes are not in this table.\n");
}

/* ---- files ---- */

static FILE *open_file(const spectrum *s, const char *name)
{
  char path[4200];
  snprintf(path, sizeof path, "%s/%s", s->directory, name);
  FILE *file = fopen(path, "wb");
  if (!file) sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno));
  return file;
}

static int close_file(const spectrum *s, FILE *file, const char *name)
{
  if (!file) return PROG_FAILED;
  int bad = ferror(file);
  bad = fclose(file) || bad;
  if (!bad) return PROG_OK;
  return sph_prog_error(PROG_FAILED, "cannot write %s/%s", s->directory, name);
}

static int write_values(const spectrum *s)
{
  FILE *file = open_file(s, "spectrum.csv");
  if (file) fprintf(file, "re [1/s],im [1/s]\n");
  for (long k = 0; file && k < s->n; k++) fprintf(file, "%.17g,%.17g\n", s->re[k], s->im[k]);
  return close_file(s, file, "spectrum.csv");
}

static int row_of(const spectrum *s, const char *name)
{
  for (int k = 0; k < s->methods; k++)
    if (!strcmp(s->method[k].name, name)) return k;
  return -1;
}

/* Which regions the picture shows: rows of the table. */
static int choose(const spectrum *s, int row[CURVES])
{
  int n = 0;
  char list[2000] = "", *rest = list, *word;
  if (!s->o->integrators) {
    for (size_t k = 0; k < sizeof drawn / sizeof *drawn; k++)
      if (row_of(s, drawn[k]) >= 0) row[n++] = row_of(s, drawn[k]);
    return n;
  }
  snprintf(list, sizeof list, "%s", s->o->integrators);
  while (n < CURVES && (word = strsep(&rest, ","))) row[n++] = row_of(s, word);
  return n;
}

/* The edges of their regions, for their longest steps: [1/s]. */
static int write_regions(const spectrum *s, const int *row, int n)
{
  FILE *file = open_file(s, "regions.csv");
  const double pi = acos(-1);
  if (file) fprintf(file, "integrator,re [1/s],im [1/s]\n");
  for (int k = 0; file && k < n; k++) {
    const char *name = s->method[row[k]].name;
    double r[RAYS + 1];
    if (!(s->step[row[k]] > 0 && s->step[row[k]] < INFINITY)) continue;
    for (int q = 0; q <= RAYS; q++)
      r[q] = sph_stability_extent(name, pi / 2 + pi / 2 * q / RAYS) / s->step[row[k]];
    for (int q = 0; q <= 2 * RAYS; q++) {
      double angle = pi / 2 + pi / 2 * q / RAYS, size = r[q <= RAYS ? q : 2 * RAYS - q];
      fprintf(file, "%s,%.9g,%.9g\n", name, size * cos(angle), size * sin(angle));
    }
  }
  return close_file(s, file, "regions.csv");
}

static int draw(const spectrum *s, const int *row, int n)
{
  char csv[2][4200], png[4200], title[400], label[CURVES][100];
  sph_plot_curve curve[CURVES + 1];
  int curves = 0;
  snprintf(csv[0], sizeof csv[0], "%s/spectrum.csv", s->directory);
  snprintf(csv[1], sizeof csv[1], "%s/regions.csv", s->directory);
  snprintf(png, sizeof png, "%s/spectrum.png", s->directory);
  snprintf(title, sizeof title, "%s: %ld eigenvalues at t = %.4g s", sph_case_title(s->c), s->n,
           sph_sim_time(s->sim));
  curve[curves++] = (sph_plot_curve){
      .csv = csv[0], .x = "re", .y = "im", .label = "eigenvalues", .points = 1, .colour = 1};
  for (int k = 0; k < n; k++) {
    const double step = s->step[row[k]];
    if (!(step > 0 && step < INFINITY)) continue;
    snprintf(label[k], sizeof label[k], "%s, dt = %.3g s", s->method[row[k]].name, step);
    curve[curves++] = (sph_plot_curve){.csv = csv[1],
                                       .x = "re",
                                       .y = "im",
                                       .where = "integrator",
                                       .is = s->method[row[k]].name,
                                       .label = label[k],
                                       .colour = 2 + k};
  }
  const sph_plot_def def = {.title = title, .x_label = "Re [1/s]", .y_label = "Im [1/s]"};
  sph_error error = {0};
  if (sph_plot_series(curve, curves, &def, png, &error))
    return sph_prog_error(PROG_FAILED, "no picture: %s", error.text);
  if (!s->o->quiet) printf("picture      %s\n", png);
  return PROG_OK;
}

static void name_directory(spectrum *s)
{
  const char *slash = strrchr(s->o->what, '/'), *name = slash ? slash + 1 : s->o->what;
  const char *dot = strrchr(name, '.');
  int length = dot && dot > name ? (int)(dot - name) : (int)strlen(name);
  if (s->o->output)
    snprintf(s->directory, sizeof s->directory, "%s", s->o->output);
  else
    snprintf(s->directory, sizeof s->directory, "%.*s-spectrum", length, name);
}

static int report(const spectrum *s)
{
  int row[CURVES], n = choose(s, row), status = write_values(s);
  if (!status) status = write_regions(s, row, n);
  if (status) return status;
  pages to = {{open_file(s, "spectrum.txt"), s->o->quiet ? NULL : stdout}};
  if (!to.file[0]) return PROG_FAILED;
  put_head(s, &to);
  put_steps(s, &to);
  status = close_file(s, to.file[0], "spectrum.txt");
  if (status) return status;
  if (!s->o->quiet) printf("\nresults      %s\n", s->directory);
  fflush(stdout);
  draw(s, row, n);
  return PROG_OK;
}

int sph_prog_spectrum(const prog_options *o)
{
  spectrum s = {.o = o};
  int held = -1, status = check_names(o);
  if (!status) status = build(&s);
  if (!status) status = check_size(&s);
  name_directory(&s);
  if (!status && (held = sph_prog_directory_take(s.directory, o->force)) < 0) status = PROG_FAILED;
  if (!status) status = find(&s);
  if (!status) find_steps(&s);
  if (!status) status = report(&s);
  sph_jacobian_free(s.J);
  sph_sim_free(s.sim);
  sph_case_free(s.c);
  free(s.re);
  free(s.im);
  if (held >= 0) close(held);
  return status;
}
