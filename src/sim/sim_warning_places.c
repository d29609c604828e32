/* Do bodies stand where they were meant to?  Fluids far from all walls, or a little off those that
 * they were to touch; packings that did not become even. */
#include <math.h>

#include "memory.h"
#include "sim_overlap.h"
#include "sim_warning.h"

static const char axis[] = "xyz";

/* Particles of faces that touch are 1 dx apart; farther than the last one is a gap by itself. */
static const double TOUCHING = 1.25, NEXT = 2.9;

static int is_body(const sph_group *group)
{
  return !group->eos.dust && !(group->wall && group->model == SPH_MODEL_MIRROR);
}

static void extend(const sph_group *group, int d, double *low, double *high)
{
  const double *x = sph_group_read(group, "position", d);
  for (long i = 0; i < group->n; i++) *low = fmin(*low, x[i]), *high = fmax(*high, x[i]);
}

static int at_rest(const sph_group *fluid)
{
  for (int d = 0; d < fluid->dim; d++) {
    const double *v = sph_group_read(fluid, "velocity", d);
    for (long i = 0; i < fluid->n; i++)
      if (v[i] != 0) return 0;
  }
  return 1;
}

typedef struct box {
  double low[3], high[3], longest; /* [m] */
} box;

static box box_of(const sph_sim *sim, const sph_group *only)
{
  box b = {.longest = 0};
  for (int d = 0; d < sim->dim; d++) {
    b.low[d] = INFINITY, b.high[d] = -INFINITY;
    for (int g = 0; g < sim->groups; g++)
      if (only ? sim->group[g] == only : sim->group[g]->wall)
        extend(sim->group[g], d, &b.low[d], &b.high[d]);
    b.longest = fmax(b.longest, b.high[d] - b.low[d]);
  }
  return b;
}

/* Beyond the walls by more than they are long; or at rest beside all of them, where it will fall.
 * Mirrors are planes without an end. */
static void find_far(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  const box walls = box_of(sim, NULL), own = box_of(sim, fluid);
  double g2 = 0;
  for (int d = 0; d < sim->dim; d++) g2 += sim->terms.g[d] * sim->terms.g[d];
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->wall && !is_body(sim->group[g])) return;
  for (int d = 0; d < sim->dim; d++) {
    const double apart = fmax(own.low[d] - walls.high[d], walls.low[d] - own.high[d]);
    const int falls = g2 > 0 && sim->terms.g[d] == 0 && apart > 2 * sim->dx && at_rest(fluid);
    if (sim->periodic[d] || !(apart > walls.longest || falls)) continue;
    sph_sim_warning_found(f,
                          "%s lies from %c = %.4g to %.4g m, all walls from %.4g to %.4g m: they "
                          "will not hold it; a wrong unit, or a sign?",
                          fluid->name, axis[d], own.low[d], own.high[d], walls.low[d],
                          walls.high[d]);
    return;
  }
}

static void find_uneven(sph_finder *f, const sph_group *group)
{
  const sph_packing *p = &group->packing;
  if (p->particles == 0 || p->settled || p->uniformity <= 4 * group->packed_to) return;
  sph_sim_warning_found(
      f, "%s: packed in %d moves to an unevenness of %.2g, not to %.2g as wanted; %s", group->name,
      p->iterations, p->uniformity, group->packed_to,
      p->stuck ? "more moves did not help, as at sharp corners; right is a "
                 "smaller spacing, rounder corners, or a lattice as it is"
               : "no more were allowed; right are more iterations");
}

/* ---- gaps: the outermost particles of a fluid, and what is ahead of them */

enum { SIDES = 6 };

typedef struct face {
  long n, gaping; /* of its particles */
  double apart;   /* of the first one that gapes [m] */
  long first;     /* -1: none */
  int wall;       /* whose particle that is */
} face;

typedef struct ahead {
  float apart; /* to the nearest particle of others, straight ahead [m]; there are many of these */
  int group;
} ahead;

static double inside(const sph_sim *sim, const sph_neighbors *search, int g, int d, long i)
{
  const double *wrap = sph_neighbors_wrap(search, g, d);
  return sph_group_read(sim->group[g], "position", d)[i] - (wrap ? wrap[i] * sim->length[d] : 0);
}

static void look_ahead(const sph_sim *sim, const sph_neighbors *search, const int of[2],
                       const long who[2], int image, ahead found[SIDES])
{
  double by[3] = {0};
  for (int d = 0; d < sim->dim; d++)
    by[d] = inside(sim, search, of[1], d, who[1]) + sph_neighbors_shifts(search, NULL)[image][d] -
            inside(sim, search, of[0], d, who[0]);
  for (int d = 0; d < sim->dim; d++) {
    double aside = 0;
    for (int e = 0; e < sim->dim; e++) aside = e == d ? aside : fmax(aside, fabs(by[e]));
    ahead *to = &found[2 * d + (by[d] > 0)];
    if (aside < 0.6 * sim->dx && (float)fabs(by[d]) < to->apart)
      *to = (ahead){.apart = (float)fabs(by[d]), .group = of[1]};
  }
}

/* Of all particles of a fluid, what is ahead of them among the other bodies: [n][SIDES]. */
static int look_around(const sph_sim *sim, sph_neighbors *search, int g, ahead (*found)[SIDES])
{
  const int *order = sph_neighbors_order(search, g);
  for (long i = 0; i < sim->group[g]->n; i++)
    for (int s = 0; s < SIDES; s++) found[i][s] = (ahead){.apart = INFINITY};
  for (int k = 0; k < sim->groups; k++) {
    if (k == g || !is_body(sim->group[k])) continue;
    if (sph_neighbors_build(search, g, k, NULL)) return SPH_ERR_MEMORY;
    const sph_list list = sph_neighbors_list(search, g, k);
    const int *source = sph_neighbors_order(search, k), of[2] = {g, k};
    for (long b = 0; b < list.blocks; b++) /* a particle each: one lane */
      for (long r = list.first[b]; r < list.first[b + 1]; r++)
        for (long s = 0; s < sph_run_count(list.runs[r]); s++) {
          const long who[2] = {order[b], source[sph_run_start(list.runs[r]) + s]};
          look_ahead(sim, search, of, who, sph_run_image(list.runs[r]), found[order[b]]);
        }
  }
  return SPH_OK;
}

/* Side s of the box around a fluid: of its particles there, which have nothing before NEXT? */
static face look_at_face(const sph_sim *sim, const sph_group *fluid, ahead (*found)[SIDES], int s)
{
  const double *x = sph_group_read(fluid, "position", s / 2);
  double low = INFINITY, high = -INFINITY;
  face at = {.first = -1};
  extend(fluid, s / 2, &low, &high);
  for (long i = 0; i < fluid->n; i++) {
    if (fabs(x[i] - (s % 2 ? high : low)) > 0.1 * sim->dx) continue;
    at.n++;
    const ahead *a = &found[i][s];
    if (!(a->apart > TOUCHING * sim->dx && a->apart < NEXT * sim->dx)) continue;
    at.gaping++;
    if (at.first < 0) at.first = i, at.apart = a->apart, at.wall = a->group;
  }
  return at;
}

static void find_gaps(sph_finder *f, const sph_sim *sim, sph_neighbors *search, int g)
{
  static const long least[] = {0, 1, 4, 12}; /* particles that make a face, not a corner */
  const sph_group *fluid = sim->group[g];
  ahead(*found)[SIDES] = sph_memory_take((size_t)fluid->n, sizeof *found);
  if (found && !look_around(sim, search, g, found))
    for (int s = 0; s < 2 * sim->dim; s++) {
      const int d = s / 2, above = sim->terms.g[d] * (s % 2 ? 1 : -1) < 0; /* air, under a lid */
      const face at = look_at_face(sim, fluid, found, s);
      if (sim->periodic[d] || above || at.n < least[sim->dim] || 2 * at.gaping <= at.n) continue;
      if (!sim->group[at.wall]->wall) continue;
      double x[3] = {0};
      char place[100];
      for (int e = 0; e < sim->dim; e++) x[e] = sph_group_read(fluid, "position", e)[at.first];
      sph_sim_warning_found(
          f,
          "%s and %s: there is a gap between them, their particles are %.3g dx apart along %c, at "
          "%s; where they are to touch, 1 is right: lengths that are whole numbers of dx",
          fluid->name, sim->group[at.wall]->name, at.apart / sim->dx, axis[d],
          sph_sim_overlap_place(sim, x, place, sizeof place));
      break; /* one side tells it */
    }
  sph_memory_free(found);
}

void sph_sim_warning_places(sph_finder *f, const sph_sim *sim)
{
  for (int g = 0; g < sim->groups; g++) find_uneven(f, sim->group[g]);
  if (sim->time != sim->start) return; /* later they move */
  int walls = 0;
  for (int g = 0; g < sim->groups; g++) walls += sim->group[g]->wall && is_body(sim->group[g]);
  for (int g = 0; g < sim->groups && walls; g++)
    if (!sim->group[g]->wall && is_body(sim->group[g])) find_far(f, sim, sim->group[g]);
  if (f->found > f->wanted || !walls) return; /* what follows takes longer */
  sph_neighbors *search = sph_sim_overlap_search(sim, NEXT * sim->dx);
  for (int g = 0; g < sim->groups && search; g++)
    if (!sim->group[g]->wall && is_body(sim->group[g])) find_gaps(f, sim, search, g);
  sph_neighbors_free(search);
}
