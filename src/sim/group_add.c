/* Particles of simple shapes on the lattice (k + 1/2) dx. */
#include <math.h>
#include <string.h>

#include "sim_data.h"

/* Counts of a box or of the layers around it: cells [from, to) per direction. */
typedef struct lattice {
  long from[3], to[3];
  double origin[3];
} lattice;

static const double MOST = 2e9; /* particles in a group: places in sorted order are ints */

static int ready(const sph_group *group, const char *what)
{
  if (!group || !sph_sim_data_ok(group->sim)) return 0;
  if (group->sim->prepared)
    sph_sim_fail(group->sim, SPH_ERR_STATE, "group %s: %s is added before the run", group->name,
                 what);
  return sph_sim_data_ok(group->sim);
}

static int positive(sph_group *group, const char *name, double value)
{
  if (isfinite(value) && value > 0) return 1;
  sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: %s = %g; right is a finite number > 0",
               group->name, name, value);
  return 0;
}

static void add(sph_group *group, const double *x, double rho0)
{
  const sph_sim *sim = group->sim;
  long i = group->n, id = 0;
  for (int g = 0; g < sim->groups; g++) id += sim->group[g]->n;
  if (sph_group_data_reserve(group, i + 1, &group->sim->error)) return;
  for (int d = 0; d < group->dim; d++) {
    group->own[SPH_POSITION][d][i] = x[d];
    if (group->wall) group->start[d][i] = x[d];
  }
  group->own[SPH_DENSITY][0][i] = rho0;
  group->own[SPH_MASS][0][i] = rho0 * sim->volume;
  for (int q = 0; q < group->scalars; q++)
    group->own[SPH_SCALAR + q][0][i] = sim->terms.scalar[q].initial;
  group->rho0 = rho0;
  if (i == 0) group->first_id = id;
  if (group->first_id + i != id && !sph_group_data_ids(group, &group->sim->error)) return;
  if (group->id) group->id[i] = id;
  group->n++;
}

/* The cells of a box; 0 where it is not one. */
static int box_lattice(sph_group *group, const double *lo, const double *hi, lattice *cells)
{
  *cells = (lattice){.to = {1, 1, 1}};
  double count = 1, dx = group->sim->dx;
  for (int d = 0; d < group->dim; d++) {
    double side = lo && hi ? hi[d] - lo[d] : NAN;
    if (!lo || !(isfinite(side) && side >= dx / 2)) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                   "group %s: box side %d from %g to %g m; right is at least dx/2 = %g m long",
                   group->name, d, lo ? lo[d] : NAN, hi ? hi[d] : NAN, dx / 2);
      return 0;
    }
    double cells_here = fmax(1, round(side / dx));
    count *= cells_here;
    if (count > MOST) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                   "group %s: a box of %g or more particles; at most %g", group->name, count, MOST);
      return 0;
    }
    cells->to[d] = (long)cells_here;
    cells->origin[d] = lo[d];
  }
  return 1;
}

typedef int keep_function(const lattice *cells, const long k[3], const double *x, const void *ctx);

/* All points of the lattice, the last direction fastest, that keep() wants. */
static void fill(sph_group *group, const lattice *cells, double rho0, keep_function *keep,
                 const void *ctx)
{
  const double dx = group->sim->dx;
  long k[3];
  for (k[0] = cells->from[0]; k[0] < cells->to[0]; k[0]++)
    for (k[1] = cells->from[1]; k[1] < cells->to[1]; k[1]++)
      for (k[2] = cells->from[2]; k[2] < cells->to[2]; k[2]++) {
        double x[3];
        for (int d = 0; d < 3; d++) x[d] = cells->origin[d] + ((double)k[d] + 0.5) * dx;
        if (keep && !keep(cells, k, x, ctx)) continue;
        add(group, x, rho0);
        if (!sph_sim_data_ok(group->sim)) return;
      }
}

void sph_group_add_box(sph_group *group, const double *lo, const double *hi, double rho0)
{
  lattice cells;
  if (!ready(group, "a box") || !positive(group, "rho0", rho0)) return;
  group->shapes++;
  if (box_lattice(group, lo, hi, &cells)) fill(group, &cells, rho0, NULL, NULL);
}

typedef struct ball {
  double centre[3], radius;
  int dim;
} ball;

static int inside(const lattice *cells, const long k[3], const double *x, const void *ctx)
{
  const ball *b = ctx;
  double r2 = 0;
  (void)cells, (void)k;
  for (int d = 0; d < b->dim; d++) r2 += (x[d] - b->centre[d]) * (x[d] - b->centre[d]);
  return r2 < b->radius * b->radius;
}

void sph_group_add_ball(sph_group *group, const double *centre, double radius, double rho0)
{
  if (!ready(group, "a ball") || !positive(group, "rho0", rho0)) return;
  if (!positive(group, "radius", radius)) return;
  lattice cells = {.to = {1, 1, 1}};
  ball b = {.radius = radius, .dim = group->dim};
  double reach = ceil(radius / group->sim->dx) + 1;
  for (int d = 0; d < group->dim; d++) {
    if (!centre || !isfinite(centre[d])) {
      sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: centre of a ball is not finite",
                   group->name);
      return;
    }
    b.centre[d] = cells.origin[d] = centre[d];
    cells.from[d] = -(long)reach;
    cells.to[d] = (long)reach;
  }
  if (pow(2 * reach, group->dim) > MOST) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: a ball of %g dx radius is too large",
                 group->name, reach);
    return;
  }
  group->shapes++;
  fill(group, &cells, rho0, inside, &b);
}

static int outside(const lattice *cells, const long k[3], const double *x, const void *ctx)
{
  const long *inner = ctx; /* cells of the box itself */
  (void)cells, (void)x;
  for (int d = 0; d < 3; d++)
    if (k[d] < 0 || k[d] >= inner[d]) return 1;
  return 0;
}

/* Is side "x-", "y+", ... among the open ones? */
static int is_open(const char *open, int d, char sign)
{
  for (const char *s = open ? open : ""; (s = strchr(s, "xyz"[d])); s++)
    if (s[1] == sign) return 1;
  return 0;
}

static int good_sides(sph_group *group, const char *open)
{
  for (const char *s = open ? open : ""; *s; s++) {
    if (*s == ' ' || *s == ',') continue;
    if (*s >= 'x' && *s < 'x' + group->dim && (s[1] == '+' || s[1] == '-')) {
      s++;
      continue;
    }
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                 "group %s: open sides \"%s\"; right are x- x+ y- y+ z- z+, as \"y+\"", group->name,
                 open);
    return 0;
  }
  return 1;
}

void sph_group_add_layers(sph_group *group, const double *lo, const double *hi, const char *open,
                          double rho0)
{
  lattice cells;
  if (!ready(group, "walls") || !positive(group, "rho0", rho0) || !good_sides(group, open)) return;
  if (!box_lattice(group, lo, hi, &cells)) return;
  long inner[3] = {cells.to[0], cells.to[1], cells.to[2]};
  long layers = (long)ceil(group->sim->H / group->sim->dx - 1e-9);
  for (int d = 0; d < group->dim; d++) {
    if (!is_open(open, d, '-')) cells.from[d] -= layers;
    if (!is_open(open, d, '+')) cells.to[d] += layers;
  }
  group->shapes++;
  fill(group, &cells, rho0, outside, inner);
}

void sph_group_add_points(sph_group *group, long n, const double *const x[], double rho0)
{
  if (!ready(group, "points") || !positive(group, "rho0", rho0)) return;
  group->loose = 1;
  if (n < 0 || (double)n > MOST || (n > 0 && !x)) {
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: %ld points", group->name, n);
    return;
  }
  for (long i = 0; i < n && sph_sim_data_ok(group->sim); i++) {
    double point[3] = {0};
    for (int d = 0; d < group->dim; d++) point[d] = x[d] ? x[d][i] : NAN;
    for (int d = 0; d < group->dim; d++)
      if (!isfinite(point[d]))
        sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s: coordinate %d of point %ld is %g",
                     group->name, d, i, point[d]);
    if (sph_sim_data_ok(group->sim)) add(group, point, rho0);
  }
}
