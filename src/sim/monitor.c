/* monitor.c -- front, height, gauge, pressure at a point, semi-axis.
 *
 *   front      max { x_i : i has >= 3 neighbours j, |x_i - x_j| <= 2 dx } + dx/2
 *   gauge      the highest z on the line through x along the last direction where
 *              sum_j V_j W(x - x_j) = 1/2: what it is on the flat surface of a half space
 *   pressure   p(x) = sum_j V_j p_j W(x - x_j) / sum_j V_j W(x - x_j),  V = m/rho
 *   semi-axis  a = sqrt((d + 2) sum m (x - <x>)^2 / sum m),  <x> the centre of mass: exact for a
 *              uniform ellipsoid in d dimensions */
#include "monitor.h"

#include <math.h>
#include <string.h>

#include "memory.h"
#include "sphode/kernel.h"

const double sph_monitor_wet = 0.15;
enum { FRONT_NEIGHBORS = 3, SAMPLES_MAX = 32, NAME_MAX = 63 };

typedef struct points {
  int dim;
  long n;
  double length[3]; /* of the periodic box; 0: not periodic that way [m] */
  double *x[3];     /* [n] [m], not wrapped; 0 for d >= dim */
  double *p;        /* [n] [Pa]; 0 where the pressure is not asked for */
  double *v;        /* [n] volumes */
  void *memory;
} points;

static int chosen(const sph_monitor *monitor, const sph_group *group)
{
  if (strcmp(sph_group_kind(group), "fluid") != 0) return 0;
  return !monitor->group || !strcmp(monitor->group, sph_group_name(group));
}

static int take_points(points *all, long capacity, int dim, sph_error *error)
{
  double *memory = sph_memory_new((size_t)capacity, 5 * sizeof *memory, "a monitor", error);
  *all = (points){.dim = dim, .memory = memory};
  if (!memory) return SPH_ERR_MEMORY;
  for (int d = 0; d < 3; d++) all->x[d] = memory + d * capacity;
  all->p = memory + 3 * capacity;
  all->v = memory + 4 * capacity;
  return SPH_OK;
}

/* A distance, the shortest one across periodic boundaries. */
static double apart(const points *all, int d, double s)
{
  return all->length[d] > 0 ? s - all->length[d] * nearbyint(s / all->length[d]) : s;
}

/* Copies the particles of the chosen groups that are within `reach` of the monitor's place in each
 * direction; NULL: all. */
static int gather(const sph_monitor *monitor, const sph_sim *sim, int pressure, const double *reach,
                  points *all, sph_error *error)
{
  const sph_group *group;
  long capacity = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (chosen(monitor, group)) capacity += sph_group_count(group);
  if (take_points(all, capacity, sph_sim_dim(sim), error) != SPH_OK) return SPH_ERR_MEMORY;
  for (int d = 0; d < all->dim; d++) sph_sim_periodic(sim, d, NULL, &all->length[d]);
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (!chosen(monitor, group)) continue;
    const double *x[3] = {NULL}, *p = pressure ? sph_group_read(group, "pressure", 0) : NULL;
    const double *m = sph_group_read(group, "mass", 0), *rho = sph_group_read(group, "density", 0);
    for (int d = 0; d < all->dim; d++) x[d] = sph_group_read(group, "position", d);
    for (long i = 0; i < sph_group_count(group); i++) {
      int inside = 1;
      for (int d = 0; reach && d < all->dim; d++)
        inside &= fabs(apart(all, d, x[d][i] - monitor->x[d])) <= reach[d];
      if (!inside) continue;
      for (int d = 0; d < all->dim; d++) all->x[d][all->n] = x[d][i];
      all->p[all->n] = p ? p[i] : 0;
      all->v[all->n++] = m[i] / rho[i];
    }
  }
  return SPH_OK;
}

/* A heap with the largest key on top. */
static void sift(int *heap, long n, long i, const double *key)
{
  for (long child; (child = 2 * i + 1) < n; i = child) {
    if (child + 1 < n && key[heap[child + 1]] > key[heap[child]]) child++;
    if (key[heap[i]] >= key[heap[child]]) return;
    int swap = heap[i];
    heap[i] = heap[child];
    heap[child] = swap;
  }
}

static int near(const points *all, int i, int j, double reach)
{
  double r2 = 0;
  for (int d = 0; d < all->dim; d++) {
    double x = apart(all, d, all->x[d][i] - all->x[d][j]);
    r2 += x * x;
  }
  return r2 <= reach * reach * (1 + 1e-12);
}

/* Neighbours of the particle in place c among those in places [first, n), which fall with the place
 * from the far end; no more than are needed. */
static int neighbors(const points *all, const int *order, long first, long n, long c, int axis,
                     double reach)
{
  int found = 0;
  const double *key = all->x[axis];
  for (long j = c + 1; j < n && key[order[j]] - key[order[c]] <= reach; j++)
    if (found < FRONT_NEIGHBORS) found += near(all, order[c], order[j], reach);
  for (long j = c - 1; j >= first && found < FRONT_NEIGHBORS; j--)
    found += near(all, order[c], order[j], reach);
  return found;
}

/* From the far end inwards: sorts (heap sort, stopped early) only as far as it must look. */
static double front(const points *all, int *order, int axis, double dx)
{
  const double *key = all->x[axis], reach = 2 * dx;
  long left = all->n; /* places [0, left) are the heap, [left, n) are sorted */
  for (long i = 0; i < all->n; i++) order[i] = (int)i;
  for (long i = all->n / 2; i-- > 0;) sift(order, all->n, i, key);
  for (long c = all->n - 1; c >= 0; c--) {
    while (left > 0 && (left > c || key[order[0]] >= key[order[c]] - reach * (1 + 1e-12))) {
      int top = order[0];
      order[0] = order[--left];
      order[left] = top;
      sift(order, left, 0, key);
    }
    if (neighbors(all, order, left, all->n, c, axis, reach) >= FRONT_NEIGHBORS)
      return key[order[c]] + dx / 2;
  }
  return NAN;
}

static int value_front(const sph_monitor *monitor, const sph_sim *sim, double *value,
                       sph_error *error)
{
  int axis = strcmp(monitor->type, "height") ? monitor->axis : sph_sim_dim(sim) - 1;
  points all = {0};
  int *order = NULL;
  int status = gather(monitor, sim, 0, NULL, &all, error);
  if (status == SPH_OK) {
    order = SPH_NEW(int, all.n, "a monitor", error);
    status = order ? SPH_OK : SPH_ERR_MEMORY;
  }
  if (status == SPH_OK) *value = front(&all, order, axis, sph_sim_dx(sim));
  sph_memory_free(order);
  sph_memory_free(all.memory);
  return status;
}

/* sum V W at x, and sum V p W. */
static double cover(const points *near_by, const double x[3], const sph_kernel *kernel, double h,
                    double *pressure)
{
  double weight = 0;
  *pressure = 0;
  for (long j = 0; j < near_by->n; j++) {
    double r2 = 0;
    for (int d = 0; d < near_by->dim; d++) {
      // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): dim <= 3
      double s = apart(near_by, d, near_by->x[d][j] - x[d]);
      r2 += s * s;
    }
    double w = near_by->v[j] * sph_kernel_w(kernel, near_by->dim, sqrt(r2), h);
    weight += w;
    *pressure += w * near_by->p[j];
  }
  return weight;
}

static double pressure_at(const points *near_by, const double x[3], const sph_kernel *kernel,
                          double h)
{
  double sum, weight = cover(near_by, x, kernel, h, &sum);
  return weight >= sph_monitor_wet ? sum / weight : 0;
}

/* The mean over the samples x + e s/m, s = -m .. m, inside the ellipsoid with half lengths e. */
static double pressure_mean(const sph_monitor *monitor, const points *near_by,
                            const sph_kernel *kernel, double h, double dx)
{
  int m[3];
  double sum = 0, samples = 0;
  for (int d = 0; d < 3; d++)
    m[d] = d < near_by->dim ? (int)fmin(ceil(monitor->extent[d] / dx - 1e-9), SAMPLES_MAX) : 0;
  for (int a = -m[0]; a <= m[0]; a++)
    for (int b = -m[1]; b <= m[1]; b++)
      for (int c = -m[2]; c <= m[2]; c++) {
        double x[3], r2 = 0;
        const int s[3] = {a, b, c};
        for (int d = 0; d < 3; d++) {
          double q = m[d] ? (double)s[d] / m[d] : 0;
          x[d] = monitor->x[d] + q * monitor->extent[d];
          r2 += q * q;
        }
        if (r2 > 1 + 1e-12) continue;
        sum += pressure_at(near_by, x, kernel, h);
        samples++;
      }
  return sum / samples;
}

/* The particles that the monitor's ellipsoid can feel. */
static int gather_near(const sph_monitor *monitor, const sph_sim *sim, int pressure,
                       const sph_kernel *kernel, points *near_by, sph_error *error)
{
  double reach[3];
  if (!kernel)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "monitor %s: kernel \"%s\" is not known",
                         monitor->name, sph_sim_kernel(sim));
  for (int d = 0; d < 3; d++)
    reach[d] = monitor->extent[d] + sph_kernel_support(kernel) * sph_sim_h(sim);
  return gather(monitor, sim, pressure, reach, near_by, error);
}

int sph_monitor_cover(const sph_monitor *monitor, const sph_sim *sim, double *sum, sph_error *error)
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  points near_by = {0};
  double nothing;
  int status = gather_near(monitor, sim, 0, kernel, &near_by, error);
  if (status == SPH_OK) *sum = cover(&near_by, monitor->x, kernel, sph_sim_h(sim), &nothing);
  sph_memory_free(near_by.memory);
  return status;
}

static int value_pressure(const sph_monitor *monitor, const sph_sim *sim, double *value,
                          sph_error *error)
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  points near_by = {0};
  int status = gather_near(monitor, sim, 1, kernel, &near_by, error);
  if (status == SPH_OK)
    *value = pressure_mean(monitor, &near_by, kernel, sph_sim_h(sim), sph_sim_dx(sim));
  sph_memory_free(near_by.memory);
  return status;
}

static double cover_at(const points *near_by, double x[3], double z, const sph_kernel *kernel,
                       double h)
{
  double unused;
  x[near_by->dim - 1] = z;
  return cover(near_by, x, kernel, h, &unused);
}

/* From above to the first place on the line that is half covered, then halving that interval. */
static double surface(const sph_monitor *monitor, const points *near_by, const sph_kernel *kernel,
                      double h, double dx)
{
  const double half = 0.5, step = dx / 4, reach = sph_kernel_support(kernel) * h;
  const double *z = near_by->x[near_by->dim - 1];
  double x[3] = {monitor->x[0], monitor->x[1], monitor->x[2]}, top = -INFINITY, low = INFINITY;
  for (long j = 0; j < near_by->n; j++) top = fmax(top, z[j]), low = fmin(low, z[j]);
  top += reach;
  while (top > low && cover_at(near_by, x, top - step, kernel, h) < half) top -= step;
  if (!(top > low)) return NAN;
  double wet = top - step;
  for (int k = 0; k < 40; k++) {
    double middle = (wet + top) / 2;
    if (cover_at(near_by, x, middle, kernel, h) < half)
      top = middle;
    else
      wet = middle;
  }
  return (wet + top) / 2;
}

static int value_gauge(const sph_monitor *monitor, const sph_sim *sim, double *value,
                       sph_error *error)
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  points near_by = {0};
  sph_monitor line = *monitor;
  for (int d = 0; d < 3; d++) line.extent[d] = d == sph_sim_dim(sim) - 1 ? INFINITY : 0;
  int status = gather_near(&line, sim, 0, kernel, &near_by, error);
  if (status == SPH_OK)
    *value = surface(monitor, &near_by, kernel, sph_sim_h(sim), sph_sim_dx(sim));
  sph_memory_free(near_by.memory);
  return status;
}

/* sum m (x - shift)^power over the chosen groups. */
static double moment(const sph_monitor *monitor, const sph_sim *sim, double shift, int power)
{
  const sph_group *group;
  double sum = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (!chosen(monitor, group)) continue;
    const double *x = sph_group_read(group, "position", monitor->axis);
    const double *m = sph_group_read(group, "mass", 0);
    for (long i = 0; i < sph_group_count(group); i++) {
      double s = x[i] - shift;
      sum += m[i] * (power == 0 ? 1 : power == 1 ? s : s * s);
    }
  }
  return sum;
}

static int value_semi_axis(const sph_monitor *monitor, const sph_sim *sim, double *value,
                           sph_error *error)
{
  (void)error;
  double mass = moment(monitor, sim, 0, 0), centre = moment(monitor, sim, 0, 1) / mass;
  *value = sqrt((sph_sim_dim(sim) + 2) * moment(monitor, sim, centre, 2) / mass);
  return SPH_OK;
}

static const struct {
  const char *name, *unit;
  int (*value)(const sph_monitor *monitor, const sph_sim *sim, double *value, sph_error *error);
} types[] = {
    {"front", "m", value_front},         {"height", "m", value_front},
    {"gauge", "m", value_gauge},         {"pressure", "Pa", value_pressure},
    {"semi-axis", "m", value_semi_axis},
};
enum { TYPES = sizeof types / sizeof *types };

static int find(const char *type)
{
  for (int k = 0; type && k < TYPES; k++)
    if (!strcmp(types[k].name, type)) return k;
  return -1;
}

const char *sph_monitor_type(int k) { return k >= 0 && k < TYPES ? types[k].name : NULL; }

const char *sph_monitor_unit(const char *type)
{
  int k = find(type);
  return k < 0 ? NULL : types[k].unit;
}

int sph_monitor_check_name(const char *what, const char *name, sph_error *error)
{
  static const char allowed[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  size_t length = name ? strlen(name) : 0;
  if (length > 0 && length <= NAME_MAX && name[strspn(name, allowed)] == '\0') return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "%s name \"%.80s\": 1 to %d letters, digits, _ . - are right", what,
                       name ? name : "", NAME_MAX);
}

static int check_place(const sph_monitor *monitor, int dim, sph_error *error)
{
  if (monitor->axis < 0 || monitor->axis >= dim)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "monitor %s: axis %d; 0 to %d are right",
                         monitor->name, monitor->axis, dim - 1);
  for (int d = 0; d < 3; d++)
    if (!isfinite(monitor->x[d]) || !(monitor->extent[d] >= 0) || !isfinite(monitor->extent[d]))
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "monitor %s: x[%d] = %g m, extent[%d] = %g m; finite, extent >= 0",
                           monitor->name, d, monitor->x[d], d, monitor->extent[d]);
  return SPH_OK;
}

int sph_monitor_check(const sph_monitor *monitor, const sph_sim *sim, sph_error *error)
{
  if (!monitor || !sim)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a monitor: no %s (NULL)",
                         monitor ? "simulation" : "monitor");
  int status = sph_monitor_check_name("monitor", monitor->name, error);
  if (status != SPH_OK) return status;
  if (find(monitor->type) < 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "monitor %s: type \"%s\"; front, height, gauge, pressure, semi-axis are "
                         "known",
                         monitor->name, monitor->type ? monitor->type : "");
  if (monitor->group) {
    const sph_group *group = sph_sim_group(sim, monitor->group);
    if (!group || !chosen(monitor, group))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "monitor %s: no fluid group \"%s\"",
                           monitor->name, monitor->group);
  }
  const int last = sph_sim_dim(sim) - 1;
  if (!strcmp(monitor->type, "gauge") && sph_sim_periodic(sim, last, NULL, NULL))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "monitor %s: a gauge along %c, which is periodic: there is no surface",
                         monitor->name, "xyz"[last]);
  return check_place(monitor, last + 1, error);
}

int sph_monitor_value(const sph_monitor *monitor, sph_sim *sim, double *value, sph_error *error)
{
  int status = sph_monitor_check(monitor, sim, error);
  if (status != SPH_OK) return status;
  if (!value)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "monitor %s: no place for its value (NULL)",
                         monitor->name);
  return types[find(monitor->type)].value(monitor, sim, value, error);
}
