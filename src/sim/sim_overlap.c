#include "sim_overlap.h"

#include <math.h>
#include <stdio.h>

#include "sim_prepare.h"

sph_neighbors *sph_sim_overlap_search(const sph_sim *sim, double reach)
{
  const sph_neighbors_def def = sph_sim_prepare_search(sim, fmin(reach, sim->H));
  sph_neighbors *search = sph_neighbors_create(&def, NULL);
  int status = search ? SPH_OK : SPH_ERR_MEMORY;
  for (int g = 0; g < sim->groups && !status; g++) {
    const double *x[3] = {0};
    for (int d = 0; d < sim->dim; d++) x[d] = sph_group_read(sim->group[g], "position", d);
    status = sph_neighbors_sort(search, g, sim->group[g]->n, x, NULL);
  }
  if (!status) return search;
  sph_neighbors_free(search);
  return NULL;
}

/* Coordinate d of particle i, inside the periodic box. */
static double inside(const sph_sim *sim, const sph_neighbors *search, int g, int d, long i)
{
  const double *wrap = sph_neighbors_wrap(search, g, d);
  return sph_group_read(sim->group[g], "position", d)[i] - (wrap ? wrap[i] * sim->length[d] : 0);
}

static double distance(const sph_sim *sim, const sph_neighbors *search, int target, long i,
                       int source, long j, int image)
{
  double r2 = 0;
  for (int d = 0; d < sim->dim; d++) {
    const double shift = sph_neighbors_shifts(search, NULL)[image][d];
    const double r = inside(sim, search, target, d, i) - shift - inside(sim, search, source, d, j);
    r2 += r * r;
  }
  return sqrt(r2);
}

sph_overlap sph_sim_overlap_find(const sph_sim *sim, sph_neighbors *search, int target, int source,
                                 double near)
{
  sph_overlap found = {.least = INFINITY};
  long who = -1;
  if (sph_neighbors_build(search, target, source, NULL)) return found;
  const sph_list list = sph_neighbors_list(search, target, source);
  const int *order = sph_neighbors_order(search, target);
  const int *sources = sph_neighbors_order(search, source);
  for (long b = 0; b < list.blocks; b++) { /* a particle each: one lane */
    const long i = order[b];
    double least = INFINITY;
    for (long r = list.first[b]; r < list.first[b + 1]; r++)
      for (long s = 0; s < sph_run_count(list.runs[r]); s++) {
        const long j = sources[sph_run_start(list.runs[r]) + s];
        const int image = sph_run_image(list.runs[r]),
                  itself = target == source && i == j && image == 0;
        if (!itself) least = fmin(least, distance(sim, search, target, i, source, j, image));
      }
    if (least < near ? !found.n || i < who : !found.n && least < found.least) who = i;
    found.n += least < near;
    found.least = fmin(found.least, least);
  }
  for (int d = 0; d < sim->dim && who >= 0; d++)
    found.x[d] = sph_group_read(sim->group[target], "position", d)[who];
  return found;
}

const char *sph_sim_overlap_place(const sph_sim *sim, const double x[3], char *text, size_t size)
{
  const double zero = 1e-9 * sim->dx; /* rounding: not -1.3e-17 */
  int n = 0;
  for (int d = 0; d < sim->dim && n >= 0 && (size_t)n < size; d++)
    n +=
        snprintf(text + n, size - (size_t)n, "%s%.4g", d ? " " : "(", fabs(x[d]) < zero ? 0 : x[d]);
  if (n >= 0 && (size_t)n < size) snprintf(text + n, size - (size_t)n, ") m");
  return text;
}
