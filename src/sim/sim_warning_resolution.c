/* Is there enough within the support?  h/dx for the kernel, neighbours of particles, the thickness
 * of bodies and of walls. */
#include <math.h>
#include <string.h>

#include "memory.h"
#include "sim_prepare.h"
#include "sim_warning.h"

static const char axis[] = "xyz";

static void find_range(sph_finder *f, const sph_sim *sim)
{
  double low = 0, high = 0, ratio = sim->h / sim->dx;
  sph_kernel_range(sim->kernel, sim->dim, &low, &high);
  if (ratio < low * (1 - 1e-9) || ratio > high * (1 + 1e-9))
    sph_sim_warning_found(f,
                          "h = %.3g dx; of %s in %dD right is %g to %g (sphode info kernels "
                          "--spacing %g --dim %d): %s",
                          ratio, sph_kernel_name(sim->kernel), sim->dim, low, high, sim->dx,
                          sim->dim,
                          ratio < low ? "too few neighbours to sum over"
                                      : "details are smeared out, and some kernels pair");
}

/* Where particles stand farther apart than dx, or are few. */
static void find_neighbors(sph_finder *f, const sph_sim *sim)
{
  const double h_over_dx = sph_kernel_h_over_dx(sim->kernel);
  const double right = sph_kernel_neighbors(sim->kernel, sim->dim, h_over_dx);
  long fluids = 0;
  for (int g = 0; g < sim->groups; g++) fluids += sim->group[g]->wall ? 0 : sim->group[g]->n;
  if (!sim->listed || sim->fresh || !fluids || sim->terms.drag_K > 0) return;
  const double mean = sim->pairs_now / (double)fluids;
  if (mean < 0.5 * right)
    sph_sim_warning_found(f,
                          "fluid particles have %.3g neighbours on average; right are %.0f inside "
                          "a fluid, and half of them at least: a smaller spacing, or a larger h/dx",
                          mean, right);
}

/* A body without a particle whose support is full even to one side. */
static void find_thin_body(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  for (int d = 0; d < sim->dim; d++) {
    double low = INFINITY, high = -INFINITY;
    for (long i = 0; i < fluid->n; i++) {
      const double x = sph_group_read(fluid, "position", d)[i];
      low = fmin(low, x);
      high = fmax(high, x);
    }
    const double thick = high - low + sim->dx;
    if (sim->periodic[d] || !(thick < sim->H * (1 - 1e-9))) continue;
    sph_sim_warning_found(f,
                          "%s: the support, %.3g m to each side, is thicker than the body along "
                          "%c, %.3g m; right is a spacing of %.2g m or less (4 supports), not %.2g "
                          "m",
                          fluid->name, sim->H, axis[d], thick, sim->dx * thick / (4 * sim->H),
                          sim->dx);
  }
}

/* ---- walls: behind a wall particle beside a fluid one there has to be wall, as far as the support
 * of the fluid particle reaches. */

enum { FLUIDS, WALLS, PROBES, SETS };

/* The nearest wall particle. */
typedef struct nearest {
  double r2;       /* INFINITY: none within reach */
  double apart[3]; /* from it to the target */
  long wall;
} nearest;

typedef struct places {
  const sph_sim *sim;
  sph_neighbors *nb;
  long n[SETS];
  double *x[SETS][3]; /* [n] */
  nearest *found;     /* [n[FLUIDS]] */
} places;

/* Dust passes walls; mirrors have no thickness. */
static int has_place(const sph_group *group)
{
  return !group->eos.dust && !(group->wall && group->model == SPH_MODEL_MIRROR);
}

static int make_places(places *p)
{
  const sph_sim *sim = p->sim;
  const sph_neighbors_def def = sph_sim_prepare_search(sim, 1.3 * sim->dx);
  for (int g = 0; g < sim->groups; g++)
    if (has_place(sim->group[g])) p->n[sim->group[g]->wall ? WALLS : FLUIDS] += sim->group[g]->n;
  p->n[PROBES] = p->n[FLUIDS];
  int good = p->n[WALLS] > 0 && p->n[FLUIDS] > 0;
  if (good) good = (p->nb = sph_neighbors_create(&def, NULL)) != NULL;
  if (good) good = (p->found = sph_memory_take((size_t)p->n[FLUIDS], sizeof *p->found)) != NULL;
  for (int s = 0; s < SETS; s++)
    for (int d = 0; d < sim->dim && good; d++)
      good = (p->x[s][d] = sph_memory_take((size_t)p->n[s], sizeof(double))) != NULL;
  return good;
}

static void free_places(places *p)
{
  sph_neighbors_free(p->nb);
  sph_memory_free(p->found);
  for (int s = 0; s < SETS; s++)
    for (int d = 0; d < 3; d++) sph_memory_free(p->x[s][d]);
}

static void fill_places(places *p)
{
  const sph_sim *sim = p->sim;
  long at[SETS] = {0};
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    const int set = group->wall ? WALLS : FLUIDS;
    if (!has_place(group)) continue;
    for (int d = 0; d < sim->dim; d++)
      memcpy(p->x[set][d] + at[set], sph_group_read(group, "position", d),
             (size_t)group->n * sizeof(double));
    at[set] += group->n;
  }
}

/* Coordinate d of a point inside the periodic box. */
static double inside(const places *p, int set, int d, long i)
{
  const double *wrap = sph_neighbors_wrap(p->nb, set, d);
  return p->x[set][d][i] - (wrap ? wrap[i] * p->sim->length[d] : 0);
}

static void look_at(const places *p, int set, long i, long wall, int image)
{
  nearest here = {.wall = wall};
  for (int d = 0; d < p->sim->dim; d++) {
    const double shift = sph_neighbors_shifts(p->nb, NULL)[image][d];
    here.apart[d] = inside(p, set, d, i) - shift - inside(p, WALLS, d, wall);
    here.r2 += here.apart[d] * here.apart[d];
  }
  if (here.r2 < p->found[i].r2) p->found[i] = here;
}

/* Fills found[] for the points of a set. */
static int find_nearest(places *p, int set)
{
  const double *const x[3] = {p->x[set][0], p->x[set][1], p->x[set][2]};
  int status = sph_neighbors_sort(p->nb, set, p->n[set], x, NULL);
  if (!status) status = sph_neighbors_build(p->nb, set, WALLS, NULL);
  if (status) return status;
  const sph_list list = sph_neighbors_list(p->nb, set, WALLS);
  const int *order = sph_neighbors_order(p->nb, set), *walls = sph_neighbors_order(p->nb, WALLS);
  for (long i = 0; i < p->n[set]; i++) p->found[i].r2 = INFINITY;
  for (long b = 0; b < list.blocks; b++) /* a point each: one lane */
    for (long r = list.first[b]; r < list.first[b + 1]; r++)
      for (long s = 0; s < sph_run_count(list.runs[r]); s++)
        look_at(p, set, order[b], walls[sph_run_start(list.runs[r]) + s],
                sph_run_image(list.runs[r]));
  return SPH_OK;
}

/* Where the support of a fluid particle that lies against a wall ends behind it. */
static void place_probes(places *p)
{
  const double dx = p->sim->dx, deep = p->sim->H - dx;
  p->n[PROBES] = 0;
  for (long i = 0; i < p->n[FLUIDS]; i++) {
    const nearest *near = &p->found[i];
    const double r = sqrt(near->r2);
    if (!(r > 0 && r < 1.3 * dx)) continue;
    for (int d = 0; d < p->sim->dim; d++)
      p->x[PROBES][d][p->n[PROBES]] = p->x[WALLS][d][near->wall] - near->apart[d] * deep / r;
    p->n[PROBES]++;
  }
}

/* Share of the probes without wall: the nearest particle of a lattice is never farther than half a
 * diagonal of its cells. */
static double bare_probes(const places *p)
{
  const double far = 0.525 * sqrt((double)p->sim->dim) * p->sim->dx;
  long bare = 0;
  for (long i = 0; i < p->n[PROBES]; i++) bare += !(p->found[i].r2 < far * far);
  return p->n[PROBES] ? (double)bare / (double)p->n[PROBES] : 0;
}

static void find_thin_walls(sph_finder *f, const sph_sim *sim)
{
  places p = {.sim = sim};
  double bare = 0;
  if (make_places(&p)) {
    fill_places(&p);
    const double *const x[3] = {p.x[WALLS][0], p.x[WALLS][1], p.x[WALLS][2]};
    int status = sph_neighbors_sort(p.nb, WALLS, p.n[WALLS], x, NULL);
    if (!status) status = find_nearest(&p, FLUIDS);
    if (!status) place_probes(&p);
    if (!status) status = find_nearest(&p, PROBES);
    if (!status) bare = bare_probes(&p);
  }
  free_places(&p);
  if (bare > 0.1)
    sph_sim_warning_found(f,
                          "walls end within the support, %.3g m, of %.0f %% of the fluid particles "
                          "beside them; right are %.0f layers of particles",
                          sim->H, 100 * bare, ceil(sim->H / sim->dx * (1 - 1e-9)));
}

void sph_sim_warning_resolution(sph_finder *f, const sph_sim *sim)
{
  find_range(f, sim);
  find_neighbors(f, sim);
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall) find_thin_body(f, sim, sim->group[g]);
  if (f->found <= f->wanted) find_thin_walls(f, sim); /* takes longer */
}
