/* plot_geometry.c -- the groups of a simulation, before it runs. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "gnuplot.h"
#include "sphode/output.h"
#include "sphode/sim.h"

static const char *const colours[] = {"#31688e", "#35b779", "#d95f02",
                                      "#7570b3", "#e7298a", "#a6761d"};
static const char *const walls[] = {"#8a8a8a", "#bdbdbd", "#5c5c5c", "#a89f91", "#d8cfc0"};

static const double half_slice = 0.75; /* of its thickness in 3D, in spacings */

typedef struct view {
  const sph_sim *sim;
  int dim, across, up, slice; /* directions; slice: looked along in 3D, else -1 */
  double at;                  /* of the slice [m] */
  double lo[3], hi[3];        /* of all particles [m] */
} view;

static void bounds(view *v)
{
  const sph_group *group;
  for (int d = 0; d < 3; d++) v->lo[d] = INFINITY, v->hi[d] = -INFINITY;
  for (int k = 0; (group = sph_sim_group_get(v->sim, k)); k++)
    for (int d = 0; d < v->dim; d++) {
      const double *x = sph_group_read(group, "position", d);
      for (long i = 0; x && i < sph_group_count(group); i++) {
        v->lo[d] = fmin(v->lo[d], x[i]);
        v->hi[d] = fmax(v->hi[d], x[i]);
      }
    }
}

/* In 3D a slice across the thinner horizontal direction, z up, as pictures of runs are. */
static void choose(view *v)
{
  v->dim = sph_sim_dim(v->sim);
  bounds(v);
  v->across = 0;
  v->up = v->dim - 1;
  v->slice = -1;
  if (v->dim < 3) return;
  v->slice = v->hi[1] - v->lo[1] <= v->hi[0] - v->lo[0] ? 1 : 0;
  v->at = (v->lo[v->slice] + v->hi[v->slice]) / 2;
  v->across = 1 - v->slice;
}

static long add_group(const view *v, const sph_group *group, sph_text *data)
{
  const double *x[3] = {NULL, NULL, NULL};
  long shown = 0;
  for (int d = 0; d < v->dim; d++) x[d] = sph_group_read(group, "position", d);
  for (long i = 0; x[0] && i < sph_group_count(group); i++) {
    if (v->slice >= 0 && fabs(x[v->slice][i] - v->at) > half_slice * sph_sim_dx(v->sim)) continue;
    sph_text_add(data, "%.6g %.6g\n", x[v->across][i], v->dim == 1 ? 0 : x[v->up][i]);
    shown++;
  }
  if (shown) sph_text_add(data, "\n\n");
  return shown;
}

/* Pixels: the axes are equal, 1000 across, with 170 for what stands around them. */
static int height(const view *v)
{
  const double dx = sph_sim_dx(v->sim);
  if (v->dim == 1) return 300;
  return 170 + (int)fmin(1000, 1000 * (v->hi[v->up] - v->lo[v->up] + 4 * dx) /
                                   (v->hi[v->across] - v->lo[v->across] + 4 * dx));
}

static void add_head(const view *v, const char *title, sph_text *script)
{
  char about[200];
  snprintf(about, sizeof about, v->slice < 0 ? "%.120s" : "%.120s, slice %c = %.3g m, %.2g m thick",
           title ? title : "", "xyz"[v->slice < 0 ? 0 : v->slice], v -> at,
           2 * half_slice * sph_sim_dx(v->sim));
  sph_text_add(script, "set title ");
  sph_text_gnuplot_string(script, about);
  sph_text_add(
      script,
      " noenhanced\nset xlabel '%c [m]' offset 0, 0.4\nset ylabel '%s'\nset size ratio -1\nset key "
      "outside "
      "bottom center horizontal Left reverse samplen 1 noenhanced height 2\nset style fill solid "
      "noborder\n",
      "xyz"[v->across],
      v -> dim == 1     ? ""
           : v->up == 1 ? "y [m]"
                        : "z [m]");
  const double more = 2 * sph_sim_dx(v->sim);
  sph_text_add(script, "set xrange [%.9g:%.9g]\n", v->lo[v->across] - more,
               v->hi[v->across] + more);
  if (v->dim == 1)
    sph_text_add(script, "set yrange [-1:1]\nunset ytics\nset size noratio\n");
  else
    sph_text_add(script, "set yrange [%.9g:%.9g]\n", v->lo[v->up] - more, v->hi[v->up] + more);
}

int sph_plot_geometry(const sph_sim *sim, const char *title, const char *png, sph_error *error)
{
  view v = {.sim = sim};
  sph_gnuplot names;
  sph_text script = {0}, data = {0}, plots = {0};
  const sph_group *group;
  int index = 0, number[2] = {0};
  if (!sim || !png)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a picture of no %s (NULL)",
                         sim ? "path" : "simulation");
  int status = sph_gnuplot_names(&names, png, error);
  if (status) return status;
  choose(&v);
  sph_text_add(&data, "# x [m], y [m], a block a group\n");
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    const int wall = !strcmp(sph_group_kind(group), "wall"), n = number[wall]++;
    if (!add_group(&v, group, &data)) continue;
    sph_text_add(&plots, "%s data index %d using 1:2:(%.6g) with circles lc rgb '%s' title ",
                 index ? ", \\\n " : "plot", index, 0.45 * sph_sim_dx(sim),
                 wall ? walls[n % 5] : colours[n % 6]);
    sph_text_gnuplot_string(&plots, sph_group_name(group));
    index++;
  }
  sph_gnuplot_begin(&names, &script, 1100, height(&v));
  add_head(&v, title, &script);
  sph_text_add(&script, "%s\n", index ? plots.data : "plot NaN notitle");
  status = sph_error_set(error, plots.error.status, "%s", plots.error.text);
  if (!status) status = sph_gnuplot_run(&names, &script, &data, error);
  sph_text_free(&plots);
  sph_text_free(&data);
  sph_text_free(&script);
  return status;
}
