/* Packing.  Particles move down the gradient of their concentration C = sum V W, as by shifting
 * (Lind, Xu, Stansby & Rogers 2012, with the repulsion of near neighbours of Monaghan 2000):
 *
 *   dx_i = -h^2/4 sum_j V (1 + 0.2 (W_ij/W(dx))^4) grad_i W_ij,  at most dx/5,
 *
 * where those near the surface see images of themselves and each other behind it, and none comes
 * nearer to it than dx/2 (the idea of body-fitted packing: Colagrossi, Bouscasse, Antuono & Marrone
 * 2012).  A body holds its volume over dx^dim particles: the innermost places of the lattice. */
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
  long n, all, room;                 /* of x: the particles, then their images */
  double *x[3], *slope[3], *best[3]; /* best: the particles where they were most even */
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

/* By cells of a quarter of the spacing. */
static double volume_of(const packer *p)
{
  const double s = p->dx / 4;
  const sph_shape *shape = p->shape;
  long cells[3] = {1, 1, 1};
  double sum = 0;
  for (int d = 0; d < p->dim; d++)
    cells[d] = (long)ceil((shape->upper[d] - shape->lower[d]) / s) + 2;
  for (long c = 0; c < cells[2]; c++)
    for (long b = 0; b < cells[1]; b++) {
      double known = 0, since = 0, now = 0;
      for (long a = 0; a < cells[0]; a++, since += s) {
        const long k[3] = {a, b, c};
        double x[3] = {0};
        for (int d = 0; d < p->dim; d++) x[d] = shape->lower[d] + ((double)k[d] - 0.5) * s;
        if (since >= known) { /* no surface as far as that, but for half a cell */
          now = depth(p, x);
          known = fabs(now) - s;
          since = 0;
        }
        sum += part(now, s);
      }
    }
  return sum * pow(s, p->dim);
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

static int add_images(packer *p)
{
  p->all = p->n;
  for (long i = 0; i < p->n; i++) {
    double x[3], n[3];
    get(p, i, x);
    const double d = depth(p, x);
    if (d < -p->reach / 2 || !normal(p, x, n)) continue;
    for (int c = 0; c < p->dim; c++) p->x[c][p->all] = x[c] - 2 * d * n[c];
    p->all++;
  }
  int status = sph_neighbors_sort(p->neighbors, 0, p->all, (const double *const *)p->x, p->error);
  return status ? status : sph_neighbors_build(p->neighbors, 0, 0, p->error);
}

static void add_pair(const packer *p, long i, long j)
{
  double r[3] = {0}, r2 = 0;
  for (int d = 0; d < p->dim; d++) {
    r[d] = p->x[d][i] - p->x[d][j];
    r2 += r[d] * r[d];
  }
  const double distance = sqrt(r2);
  if (i == j || distance >= p->reach || !(distance > 0)) return;
  const double crowd = sph_kernel_w(p->kernel, p->dim, distance, p->h) / p->w_dx;
  const double F = p->volume * (1 + 0.2 * crowd * crowd * crowd * crowd) *
                   sph_kernel_f(p->kernel, p->dim, distance, p->h);
  for (int d = 0; d < p->dim; d++) p->slope[d][i] += F * r[d];
}

/* The gradient at the particles; h times its rms. */
static double slopes(const packer *p)
{
  const sph_list list = sph_neighbors_list(p->neighbors, 0, 0);
  const int *order = sph_neighbors_order(p->neighbors, 0);
  double sum = 0;
  for (long s = 0; s < list.blocks; s++) {
    const long i = order[s];
    if (i >= p->n) continue;
    for (int d = 0; d < p->dim; d++) p->slope[d][i] = 0;
    for (long k = list.first[s]; k < list.first[s + 1]; k++)
      for (long m = 0; m < sph_run_count(list.runs[k]); m++)
        add_pair(p, i, order[sph_run_start(list.runs[k]) + m]);
  }
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < p->dim; d++) sum += p->slope[d][i] * p->slope[d][i];
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
  const double wanted = pack->uniformity > 0 ? pack->uniformity : 0.03;
  int status = add_images(p);
  info->before = info->uniformity = status ? 0 : slopes(p);
  for (long i = 0; i < p->n; i++) hold(p, i);
  double best = INFINITY;
  int since = 0; /* moves that made it no better */
  for (info->iterations = 0; info->iterations < most && !status; info->iterations++) {
    status = add_images(p);
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
  p->room = 2 * n;
  for (int d = 0; d < p->dim; d++) {
    p->x[d] = SPH_NEW(double, p->room, "a packing", p->error);
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
    info->volume = volume_of(&p);
    status = choose(&p, *n, (long)fmax(1, round(info->volume / p.volume)), x);
  }
  if (!status) status = relax(&p, pack, info);
  info->particles = p.n;
  for (int d = 0; d < p.dim && !status; d++) memcpy(x[d], p.best[d], (size_t)p.n * sizeof *x[d]);
  if (!status) *n = p.n;
  clear(&p);
  return status;
}
