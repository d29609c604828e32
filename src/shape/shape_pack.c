/* Packing.  Particles move down the gradient of their concentration C = sum V W, as by shifting
 * (Lind, Xu, Stansby & Rogers 2012, with the repulsion of near neighbours of Monaghan 2000):
 *
 *   dx_i = -h^2/4 [sum_j V (1 + 0.2 (W_ij/W(dx))^4) grad_i W_ij + w int grad_i W(x_i - x) dx],
 *
 * at most dx/5; the integral goes over what is outside of the body, whatever its corners are, by
 * cells of dx/2; w = 0.9 draws particles into the outermost layer, which else has gaps.  None comes
 * nearer to the surface than dx/2 (the idea of body-fitted packing: Colagrossi, Bouscasse, Antuono
 * & Marrone 2012).  A body holds its volume over dx^dim particles: the innermost places of the
 * lattice. */
#include "shape_pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "shape_data.h"
#include "shape_sample.h"
#include "sphode/kernel.h"
#include "sphode/neighbors.h"

typedef struct packer {
  const sph_shape *shape;
  sph_shape_sample *surface; /* NULL: the distance inside is exact */
  const sph_kernel *kernel;
  sph_neighbors *neighbors;
  int dim;
  double dx, h, reach, volume, w_dx;
  long n;
  double *x[3], *slope[3], *best[3]; /* best: the particles where they were most even */
  double inside;                     /* volume */
  long cells, room;                  /* outside: centres and volumes */
  double *cell[4];
  sph_error *error;
} packer;

/* ---- the body */

static double depth(const packer *p, const double x[3])
{
  const double d = p->shape->distance(p->shape, x);
  if (!p->surface || d >= 0 || d < -p->reach) return d;
  return fmin(d, -sph_shape_sample_nearest(p->surface, x));
}

/* Out of the body, of length 1; 0: there is no such direction. */
static int normal(const packer *p, const double x[3], double n[3])
{
  const double step = p->surface ? 0.1 * p->dx : 1e-4 * p->dx;
  double length = 0;
  n[0] = n[1] = n[2] = 0;
  for (int d = 0; d < p->dim && d < 3; d++) {
    double more[3] = {x[0], x[1], x[2]}, less[3] = {x[0], x[1], x[2]};
    more[d] += step;
    less[d] -= step;
    n[d] = depth(p, more) - depth(p, less);
    length += n[d] * n[d];
  }
  length = sqrt(length);
  for (int d = 0; d < 3 && length > 0; d++) n[d] /= length;
  return length > 0.2 * step;
}

static void get(const packer *p, long i, double x[3])
{
  for (int d = 0; d < 3; d++) x[d] = d < p->dim ? p->x[d][i] : 0;
}

/* Back to where the surface is half a spacing away. */
static void hold(const packer *p, long i)
{
  double x[3], n[3];
  for (int k = 0; k < 3; k++) {
    get(p, i, x);
    const double beyond = depth(p, x) + p->dx / 2;
    if (!(beyond > 1e-6 * p->dx) || !normal(p, x, n)) return;
    for (int d = 0; d < p->dim; d++) p->x[d][i] -= beyond * n[d];
  }
}

/* The part of a cell of side s that is inside, as if the surface were flat in it. */
static double part(double distance, double s) { return fmin(fmax(0.5 - distance / s, 0), 1); }

/* w: with 1 the outermost layer is 3 % too thin, with 0.8 as much too dense. */
static const double OUTSIDE = 0.9;

/* What is done with the cell of side s around x; a status. */
typedef int visiting(packer *p, const double x[3], double distance, double s);

/* All cells of side s in the box around the body, `far` more at each side; farther outside than
 * that, and inside by more than a cell, the distance may be that of a cell before. */
static int visit_cells(packer *p, double s, double far, visiting *visit)
{
  const sph_shape *shape = p->shape;
  long cells[3] = {1, 1, 1};
  int status = SPH_OK;
  for (int d = 0; d < p->dim; d++)
    cells[d] = (long)ceil((shape->upper[d] - shape->lower[d] + 2 * far) / s) + 2;
  for (long c = 0; c < cells[2]; c++)
    for (long b = 0; b < cells[1]; b++) {
      double known = 0, since = 0, now = 0;
      for (long a = 0; a < cells[0] && !status; a++, since += s) {
        const long k[3] = {a, b, c};
        double x[3] = {0};
        for (int d = 0; d < p->dim; d++) x[d] = shape->lower[d] - far + ((double)k[d] - 0.5) * s;
        if (since >= known) {
          now = depth(p, x);
          known = now > 0 ? now - far - s : -now - s;
          since = 0;
        }
        status = visit(p, x, now, s);
      }
    }
  return status;
}

static int add_inside(packer *p, const double x[3], double distance, double s)
{
  (void)x;
  p->inside += part(distance, s) * pow(s, p->dim);
  return SPH_OK;
}

static int add_outside(packer *p, const double x[3], double distance, double s)
{
  const double outside = 1 - part(distance, s);
  if (!(outside > 0) || distance > p->reach) return SPH_OK;
  const long room = p->room ? 2 * p->room : 1024;
  for (int d = 0; p->cells == p->room && d < 4; d++)
    if (sph_memory_grow((void **)&p->cell[d], (size_t)p->room, (size_t)room, sizeof(double),
                        "the cells around a packing", p->error))
      return SPH_ERR_MEMORY;
  if (p->cells == p->room) p->room = room;
  for (int d = 0; d < 3; d++) p->cell[d][p->cells] = x[d];
  p->cell[3][p->cells++] = OUTSIDE * outside * pow(s, p->dim);
  return SPH_OK;
}

/* ---- which places of the lattice */

typedef struct place {
  double distance;
  long i;
} place;

static int by_distance(const void *a, const void *b)
{
  const place *p = a, *q = b;
  if (p->distance != q->distance) return p->distance > q->distance ? 1 : -1;
  return (p->i > q->i) - (p->i < q->i);
}

static int by_number(const void *a, const void *b)
{
  const place *p = a, *q = b;
  return (p->i > q->i) - (p->i < q->i);
}

/* The innermost `count` of x[d][n], in their order. */
static int choose(packer *p, long n, long count, double *const x[3])
{
  place *places = SPH_NEW(place, n, "places of a packing", p->error);
  if (!places) return SPH_ERR_MEMORY;
  for (long i = 0; i < n; i++) {
    double at[3] = {0};
    for (int d = 0; d < p->dim; d++) at[d] = x[d][i];
    places[i] = (place){depth(p, at), i};
  }
  qsort(places, (size_t)n, sizeof *places, by_distance);
  p->n = count < n ? count : n;
  qsort(places, (size_t)p->n, sizeof *places, by_number);
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < p->dim; d++) p->x[d][i] = x[d][places[i].i];
  sph_memory_free(places);
  return SPH_OK;
}

/* ---- one move */

/* Particles within the reach of each other, and of cells outside. */
static int find_neighbors(packer *p)
{
  const double *const *x = (const double *const *)p->x;
  int status = sph_neighbors_sort(p->neighbors, 0, p->n, x, p->error);
  if (!status) status = sph_neighbors_build(p->neighbors, 0, 0, p->error);
  return status ? status : sph_neighbors_build(p->neighbors, 0, 1, p->error);
}

/* V grad W of what is at x, and the repulsion if that is a particle. */
static void add_pair(const packer *p, long i, double *const x[3], long j, double V, int particle)
{
  double r[3] = {0}, r2 = 0, crowd = 0;
  for (int d = 0; d < p->dim; d++) {
    r[d] = p->x[d][i] - x[d][j];
    r2 += r[d] * r[d];
  }
  const double distance = sqrt(r2);
  if (distance >= p->reach || !(distance > 0)) return;
  if (particle) crowd = sph_kernel_w(p->kernel, p->dim, distance, p->h) / p->w_dx;
  const double F = V * (1 + 0.2 * crowd * crowd * crowd * crowd) *
                   sph_kernel_f(p->kernel, p->dim, distance, p->h);
  for (int d = 0; d < p->dim; d++) p->slope[d][i] += F * r[d];
}

/* Those that are held at half a spacing, and pushed outwards: what is left is along the surface. */
static void stay(const packer *p, long i)
{
  double x[3], n[3], out = 0;
  get(p, i, x);
  if (depth(p, x) < -0.501 * p->dx || !normal(p, x, n)) return;
  for (int d = 0; d < p->dim; d++) out -= p->slope[d][i] * n[d];
  for (int d = 0; d < p->dim && out > 0; d++) p->slope[d][i] += out * n[d];
}

/* The gradient at the particles; h times its rms. */
static double slopes(const packer *p)
{
  const sph_list list[2] = {sph_neighbors_list(p->neighbors, 0, 0),
                            sph_neighbors_list(p->neighbors, 0, 1)};
  const int *order[2] = {sph_neighbors_order(p->neighbors, 0),
                         sph_neighbors_order(p->neighbors, 1)};
  double sum = 0;
  for (long s = 0; s < p->n; s++) {
    const long i = order[0][s];
    for (int d = 0; d < p->dim; d++) p->slope[d][i] = 0;
    for (int of = 0; of < 2; of++)
      for (long k = list[of].first[s]; k < list[of].first[s + 1]; k++)
        for (long m = 0; m < sph_run_count(list[of].runs[k]); m++) {
          const long j = order[of][sph_run_start(list[of].runs[k]) + m];
          add_pair(p, i, of ? p->cell : p->x, j, of ? p->cell[3][j] : p->volume, !of);
        }
    stay(p, i);
    for (int d = 0; d < p->dim; d++) sum += p->slope[d][i] * p->slope[d][i];
  }
  return p->h * sqrt(sum / (double)p->n);
}

static void move(const packer *p)
{
  for (long i = 0; i < p->n; i++) {
    double by[3] = {0}, length = 0;
    for (int d = 0; d < p->dim; d++) {
      by[d] = -0.25 * p->h * p->h * p->slope[d][i];
      length += by[d] * by[d];
    }
    const double least = fmin(1, 0.2 * p->dx / fmax(sqrt(length), 1e-300));
    for (int d = 0; d < p->dim; d++) p->x[d][i] += least * by[d];
    hold(p, i);
  }
}

enum { STUCK = 50 }; /* moves without any use */

static int relax(packer *p, const sph_pack *pack, sph_packing *info)
{
  const int most = pack->iterations > 0 ? pack->iterations : 500;
  const double wanted = pack->uniformity > 0 ? pack->uniformity : SPH_PACK_UNIFORMITY;
  int status = find_neighbors(p);
  info->before = info->uniformity = status ? 0 : slopes(p);
  for (long i = 0; i < p->n; i++) hold(p, i);
  double best = INFINITY;
  int since = 0; /* moves that made it no better */
  for (info->iterations = 0; info->iterations < most && !status; info->iterations++) {
    status = find_neighbors(p);
    if (status) break;
    info->uniformity = slopes(p);
    since = info->uniformity < 0.99 * best ? 0 : since + 1;
    if (info->uniformity < best) {
      best = info->uniformity;
      for (int d = 0; d < p->dim; d++) memcpy(p->best[d], p->x[d], (size_t)p->n * sizeof *p->x[d]);
    }
    if (info->uniformity <= wanted || since == STUCK) break;
    move(p);
  }
  info->uniformity = best;
  info->settled = !status && best <= wanted;
  info->stuck = !info->settled && since == STUCK;
  return status;
}

/* ---- together */

static int make(packer *p, const sph_shape *shape, double dx, long n)
{
  double lower[3], upper[3];
  if (!sph_shape_bounds(shape, lower, upper))
    return sph_error_set(p->error, SPH_ERR_ARGUMENT, "a packing of a shape without end");
  p->kernel = sph_kernel_find("wendland-c2");
  p->h = 1.5 * dx;
  p->reach = sph_kernel_support(p->kernel) * p->h;
  p->volume = pow(dx, p->dim);
  p->w_dx = sph_kernel_w(p->kernel, p->dim, dx, p->h);
  for (int d = 0; d < p->dim; d++) {
    p->x[d] = SPH_NEW(double, n, "a packing", p->error);
    p->slope[d] = SPH_NEW(double, n, "a packing", p->error);
    p->best[d] = SPH_NEW(double, n, "a packing", p->error);
    if (!p->x[d] || !p->slope[d] || !p->best[d]) return SPH_ERR_MEMORY;
  }
  p->neighbors =
      sph_neighbors_create(&(sph_neighbors_def){.dim = p->dim, .reach = p->reach, .dx = dx},
                           p->error);
  if (!p->neighbors) return p->error->status;
  if (shape->exact_inside) return SPH_OK;
  p->surface = sph_shape_sample_create(shape, dx / 8, p->reach, p->error);
  return p->surface ? SPH_OK : p->error->status;
}

static void clear(packer *p)
{
  sph_neighbors_free(p->neighbors);
  sph_shape_sample_free(p->surface);
  for (int d = 0; d < 4; d++) sph_memory_free(p->cell[d]);
  for (int d = 0; d < 3; d++) {
    sph_memory_free(p->x[d]);
    sph_memory_free(p->slope[d]);
    sph_memory_free(p->best[d]);
  }
}

int sph_shape_pack(const sph_shape *shape, double dx, const sph_pack *pack, long *n,
                   double *const x[3], sph_packing *info, sph_error *error)
{
  sph_error own = {0};
  packer p = {.shape = shape, .dim = shape->dim, .dx = dx, .error = error ? error : &own};
  int status = make(&p, shape, dx, *n);
  *info = (sph_packing){0};
  if (!status) {
    status = visit_cells(&p, dx / 4, 0, add_inside);
    info->volume = p.inside;
  }
  if (!status) status = visit_cells(&p, dx / 2, p.reach, add_outside);
  if (!status)
    status = sph_neighbors_sort(p.neighbors, 1, p.cells, (const double *const *)p.cell, p.error);
  if (!status) status = choose(&p, *n, (long)fmax(1, round(info->volume / p.volume)), x);
  if (!status) status = relax(&p, pack, info);
  info->particles = p.n;
  for (int d = 0; d < p.dim && !status; d++) memcpy(x[d], p.best[d], (size_t)p.n * sizeof *x[d]);
  if (!status) *n = p.n;
  clear(&p);
  return status;
}
