/* Particles of any shape on any lattice. */
#include <math.h>

#include "memory.h"
#include "shape_lattice.h"
#include "shape_pack.h"
#include "sim_data.h"
#include "sphode/shape.h"

static const double MOST = 2e9; /* points of a lattice that are looked at */

typedef struct filler {
  const sph_shape *shape;
  const sph_shape_lattice *lattice;
  int dim;
  double dx, side[3], origin[3]; /* of a cell [m] */
  sph_packing *packing;          /* of the group */
  double margin;                 /* places so far outside are taken, too [m] */
  long from[3], to[3];           /* cells that are looked at */
  long n, room;
  double *x[3];
  sph_error *error;
} filler;

static int add(filler *f, const double x[3])
{
  if (f->n == f->room) {
    const long room = 2 * f->room + 1024;
    for (int d = 0; d < f->dim; d++) {
      int status = sph_memory_grow((void **)&f->x[d], (size_t)f->room, (size_t)room,
                                   sizeof *f->x[d], "particles of a shape", f->error);
      if (status) return status;
    }
    f->room = room;
  }
  for (int d = 0; d < f->dim; d++) f->x[d][f->n] = x[d];
  f->n++;
  return SPH_OK;
}

/* Where points of the lattice lie on the surface, all shapes must say the same: the same hair's
 * breadth away from it, on one side of all of them. */
static double distance(const filler *f, const double x[3])
{
  static const double hair[3] = {1e-6, 0.7e-6, 0.3e-6};
  const double at[3] = {x[0] + hair[0] * f->dx, x[1] + hair[1] * f->dx, x[2] + hair[2] * f->dx};
  return sph_shape_distance(f->shape, at) - f->margin;
}

/* Point p of the cells along a row, the last direction: as far as a distance reaches, nothing
 * changes. */
static int add_row(filler *f, const long cell[3], int p)
{
  const int last = f->dim - 1;
  double x[3] = {0}, known = 0, since = 0;
  int status = SPH_OK, inside = 0;
  for (int d = 0; d < last; d++)
    x[d] = f->origin[d] + ((double)cell[d] + f->lattice->point[p][d]) * f->side[d];
  for (long k = f->from[last]; k < f->to[last] && !status; k++, since += f->side[last]) {
    x[last] = f->origin[last] + ((double)k + f->lattice->point[p][last]) * f->side[last];
    if (since >= 0.999 * known) {
      const double d = distance(f, x);
      inside = d < 0;
      known = fabs(d);
      since = 0;
    }
    if (inside) status = add(f, x);
  }
  return status;
}

static int add_all(filler *f)
{
  long cell[3] = {0}, to[3] = {1, 1, 1}, from[3] = {0};
  int status = SPH_OK;
  for (int d = 0; d < f->dim - 1; d++) from[d] = f->from[d], to[d] = f->to[d];
  for (cell[0] = from[0]; cell[0] < to[0]; cell[0]++)
    for (cell[1] = from[1]; cell[1] < to[1]; cell[1]++)
      for (int p = 0; p < f->lattice->points && !status; p++) status = add_row(f, cell, p);
  return status;
}

static int choose_cells(filler *f, const sph_fill *fill)
{
  double lower[3], upper[3], count = f->lattice->points;
  if (!sph_shape_bounds(f->shape, lower, upper))
    return sph_error_set(f->error, SPH_ERR_ARGUMENT,
                         "a shape without end; an intersection with a box has one");
  for (int d = 0; d < f->dim; d++) {
    const double stretch = fill->stretch[d] > 0 ? fill->stretch[d] : 1;
    f->side[d] = f->lattice->cell[d] * f->dx * stretch;
    f->origin[d] = fill->origin[d];
    const double from = floor((lower[d] - f->margin - f->origin[d]) / f->side[d]) - 1;
    const double to = ceil((upper[d] + f->margin - f->origin[d]) / f->side[d]) + 1;
    count *= fmax(0, to - from);
    if (!(fabs(from) < 1e9 && fabs(to) < 1e9 && count <= MOST))
      return sph_error_set(f->error, SPH_ERR_ARGUMENT,
                           "a shape from %g to %g m has too many places for particles dx = %g m "
                           "apart; a coarser spacing is right, or another unit (unit: 1 mm) of a "
                           "surface from a file",
                           lower[d], upper[d], f->dx);
    f->from[d] = (long)from;
    f->to[d] = (long)to;
  }
  return SPH_OK;
}

static int pack(filler *f, const sph_fill *fill)
{
  for (int d = 0; d < f->dim; d++)
    if (fill->stretch[d] > 0)
      return sph_error_set(f->error, SPH_ERR_ARGUMENT,
                           "a lattice is stretched or packed, not both");
  return sph_shape_pack(f->shape, f->dx, fill->pack, &f->n, f->x, f->packing, f->error);
}

static int find(filler *f, const sph_fill *fill)
{
  f->lattice = sph_shape_lattice_find(fill->lattice, f->dim, f->error);
  if (!f->lattice) return SPH_ERR_ARGUMENT;
  if (sph_shape_dim(f->shape) != f->dim)
    return sph_error_set(f->error, SPH_ERR_ARGUMENT, "a shape of %d dimensions; right is %d",
                         sph_shape_dim(f->shape), f->dim);
  int status = choose_cells(f, fill);
  if (!status) status = add_all(f);
  if (!status && f->n > 0 && fill->pack) status = pack(f, fill);
  if (status || f->n > 0) return status;
  double lower[3], upper[3], longest = 0;
  sph_shape_bounds(f->shape, lower, upper);
  for (int d = 0; d < f->dim; d++) longest = fmax(longest, upper[d] - lower[d]);
  return sph_error_set(f->error, SPH_ERR_ARGUMENT,
                       "no place of the lattice (dx = %g m) lies in the shape, %.3g m long%s",
                       f->dx, fmax(0, longest),
                       longest > 2 * f->dx
                           ? ": it is empty, or thinner than dx"
                           : "; a smaller spacing is right, or another unit (unit: 1 m) of a "
                             "surface from a file");
}

void sph_group_add_shape(sph_group *group, const sph_shape *shape, const sph_fill *fill)
{
  static const sph_fill none;
  sph_error error = {0};
  if (!group || !sph_sim_data_ok(group->sim)) return;
  if (!fill) fill = &none;
  filler f = {.shape = shape,
              .dim = group->dim,
              .dx = group->sim->dx,
              .packing = &group->packing,
              .margin = fill->pack ? group->sim->dx : 0,
              .error = &error};
  const long before = group->n;
  const int loose = group->loose;
  int status = find(&f, fill);
  if (status)
    sph_sim_fail(group->sim, status, "group %s: %s", group->name, error.text);
  else
    sph_group_add_points(group, f.n, (const double *const *)f.x, fill->rho0);
  group->shapes++;
  group->loose = loose;
  if (fill->pack)
    group->packed_to = fill->pack->uniformity > 0 ? fill->pack->uniformity : SPH_PACK_UNIFORMITY;
  for (int d = 0; d < group->dim && !status && sph_sim_data_ok(group->sim); d++)
    for (long i = before; i < group->n && fill->stretch[d] > 0; i++)
      group->own[SPH_MASS][0][i] *= fill->stretch[d];
  for (int d = 0; d < 3; d++) sph_memory_free(f.x[d]);
}

const sph_packing *sph_group_packing(const sph_group *group)
{
  return group && group->packing.particles > 0 ? &group->packing : NULL;
}
