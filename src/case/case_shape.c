#include "case_shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "case_path.h"
#include "memory.h"
#include "sphode/kernel.h"

#define get_text sph_case_reader_text
#define get_number sph_case_reader_number
#define get_vector sph_case_reader_vector
#define child_of sph_case_reader_find

typedef struct builder {
  const sph_case *c;
  double dx, support; /* [m] */
  sph_error *error;
} builder;

static sph_shape *build(const builder *b, const sph_case_node *node);

/* What the library found, with the place in the file. */
static sph_shape *told(const builder *b, const sph_case_node *node, sph_shape *shape,
                       const sph_error *error)
{
  if (!shape)
    sph_case_schema_fail(b->c, b->error, node, 0, 0, "%s",
                         error->status ? error->text : "out of memory");
  return shape;
}

static sph_shape *simple(const builder *b, const sph_case_node *node, sph_error *e)
{
  double one[3], other[3];
  const char *name = node->key;
  const double radius = get_number(node, "radius", 0);
  if (!strcmp(name, "ball")) {
    get_vector(node, "centre", one);
    return sph_shape_ball(b->c->dim, one, radius, e);
  }
  if (!strcmp(name, "half_space")) {
    get_vector(node, "point", one);
    get_vector(node, "normal", other);
    return sph_shape_half_space(b->c->dim, one, other, e);
  }
  if (!strcmp(name, "box")) {
    get_vector(node, "lower", one);
    get_vector(node, "upper", other);
    return sph_shape_box(b->c->dim, one, other, e);
  }
  get_vector(node, "from", one);
  get_vector(node, "to", other);
  if (!strcmp(name, "cylinder")) return sph_shape_cylinder(one, other, radius, e);
  return sph_shape_cone(one, other, radius, get_number(node, "radius_to", 0), e);
}

/* Corners [n][2], to be freed; NULL: told. */
static double (*corners_of(const sph_case_node *list, int *n, sph_error *error))[2]
{
  *n = 0;
  for (const sph_case_node *point = list->first; point; point = point->next) ++*n;
  double(*corner)[2] = sph_memory_new((size_t)*n, sizeof *corner, "a polygon", error);
  int k = 0;
  for (const sph_case_node *point = list->first; corner && point; point = point->next, k++) {
    corner[k][0] = point->first->number;
    corner[k][1] = point->first->next->number;
  }
  return corner;
}

static sph_shape *polygon(const sph_case_node *node, sph_error *e)
{
  int n;
  const char *axis = get_text(node, "axis", "z");
  double(*corner)[2] = corners_of(child_of(node, "corners"), &n, e);
  sph_shape *s = NULL;
  if (corner && !strcmp(node->key, "polygon"))
    s = sph_shape_polygon(n, corner, e);
  else if (corner)
    s = sph_shape_prism(n, corner, axis[0] - 'x', get_number(node, "from", 0),
                        get_number(node, "to", 0), e);
  sph_memory_free(corner);
  return s;
}

static sph_shape *surface(const builder *b, const sph_case_node *node, sph_error *e)
{
  char path[SPH_CASE_PATH];
  const sph_case_node *file = child_of(node, "file");
  if (sph_case_path(b->c, file->text, path, e)) return NULL;
  return sph_shape_surface(path, get_number(node, "unit", 1), get_number(node, "holes", 0) != 0, e);
}

enum { MOST = 100 };

/* What is wrong with a part has been told with its own place. */
static sph_shape *combination(const builder *b, const sph_case_node *node)
{
  sph_shape *part[MOST], *s = NULL;
  sph_error e = {0};
  int n = 0;
  const sph_case_node *one = node->first;
  for (; one && n < MOST; one = one->next, n++)
    if (!(part[n] = build(b, one->first))) break;
  if (one && n < MOST) {
    while (n > 0) sph_shape_free(part[--n]);
    return NULL;
  }
  if (one) {
    sph_error_set(&e, SPH_ERR_PARSE, "%s: more than %d shapes", node->key, MOST);
    while (n > 0) sph_shape_free(part[--n]);
  } else if (!strcmp(node->key, "union"))
    s = sph_shape_union(n, part, &e);
  else if (!strcmp(node->key, "difference"))
    s = sph_shape_difference(n, part, &e);
  else
    s = sph_shape_intersection(n, part, &e);
  return told(b, node, s, &e);
}

/* Of one other shape; the same of what is wrong with that. */
static sph_shape *changed(const builder *b, const sph_case_node *node)
{
  double about[3], axis[3], by[3];
  sph_error e = {0};
  sph_shape *part = build(b, child_of(node, "of")->first), *s;
  if (!part) return NULL;
  get_vector(node, "about", about);
  get_vector(node, "by", by);
  if (!get_vector(node, "axis", axis)) axis[2] = 1;
  if (!strcmp(node->key, "translate"))
    s = sph_shape_translate(part, by, &e);
  else if (!strcmp(node->key, "scale"))
    s = sph_shape_scale(part, get_number(node, "factor", 1), about, &e);
  else if (!strcmp(node->key, "rotate"))
    s = sph_shape_rotate(part, axis, get_number(node, "angle", 0), about, &e);
  else
    s = sph_shape_shell(part, get_number(node, "thickness", b->support),
                        !strcmp(get_text(node, "side", "outside"), "inside"), b->dx, &e);
  return told(b, node, s, &e);
}

static int in_dimension(const builder *b, const sph_case_node *node)
{
  static const char *const only[][4] = {/* what is right in 1D, 2D, 3D */
                                        {"polygon", "box", NULL, "prism"},
                                        {"prism", "box", "polygon", NULL},
                                        {"cylinder", "box", "ball: a disc", NULL},
                                        {"cone", "box", "polygon", NULL},
                                        {"surface", "box", "polygon", NULL}};
  for (size_t k = 0; k < sizeof only / sizeof *only; k++)
    if (!strcmp(node->key, only[k][0]) && only[k][b->c->dim]) {
      sph_case_schema_fail(b->c, b->error, node, 0, 0,
                           "%s: a shape of %d dimensions, here are %d; right is %s", node->key,
                           only[k][3] ? 2 : 3, b->c->dim, only[k][b->c->dim]);
      return 0;
    }
  return 1;
}

static sph_shape *build(const builder *b, const sph_case_node *node)
{
  sph_error e = {0};
  if (!in_dimension(b, node)) return NULL;
  if (node->kind == SPH_CASE_LIST) return combination(b, node);
  if (child_of(node, "of")) return changed(b, node);
  if (!strcmp(node->key, "surface")) return told(b, node, surface(b, node, &e), &e);
  if (child_of(node, "corners")) return told(b, node, polygon(node, &e), &e);
  return told(b, node, simple(b, node, &e), &e);
}

sph_shape *sph_case_shape_of(const sph_case *c, const sph_case_node *node, double dx,
                             double support, sph_error *error)
{
  const builder b = {.c = c, .dx = dx, .support = support, .error = error};
  return build(&b, node);
}

/* ---- particles */

int sph_case_shape_is(const sph_case_node *group, const sph_case_node *shape)
{
  static const char *const others[] = {"layers", "plane", "file"};
  for (int k = 0; k < 3; k++)
    if (!strcmp(shape->key, others[k])) return 0;
  const int plain = !strcmp(shape->key, "box") || !strcmp(shape->key, "ball");
  return !plain || child_of(group, "lattice") || child_of(group, "lattice_origin") ||
         child_of(group, "packing");
}

/* A box is filled with whole cells: they begin at its corner and are stretched a little. */
static void fit(const sph_case *c, const sph_case_node *box, double dx, sph_fill *fill)
{
  double lower[3], upper[3], side[3] = {1, 1, 1};
  get_vector(box, "lower", lower);
  get_vector(box, "upper", upper);
  if (fill->lattice && !sph_shape_lattice_cell(fill->lattice, side)) return;
  for (int d = 0; d < c->dim && d < 3; d++) {
    const double cells = fmax(1, round((upper[d] - lower[d]) / (side[d] * dx)));
    fill->origin[d] = lower[d];
    fill->stretch[d] = (upper[d] - lower[d]) / (cells * side[d] * dx);
  }
}

int sph_case_shape_add(const sph_case *c, sph_sim *sim, sph_group *group, const sph_case_node *map,
                       const sph_case_node *shape, double density, sph_error *error)
{
  const double dx = sph_sim_dx(sim);
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  const double reach = sph_kernel_support(kernel) * sph_sim_h(sim);
  const double support = ceil(reach / dx - 1e-9) * dx; /* whole layers */
  sph_fill fill = {.rho0 = density, .lattice = get_text(map, "lattice", NULL)};
  get_vector(map, "lattice_origin", fill.origin);
  const sph_case_node *packing = child_of(map, "packing");
  const sph_pack pack = {.uniformity = get_number(packing, "uniformity", 0),
                         .iterations = (int)get_number(packing, "iterations", 0)};
  if (packing) fill.pack = &pack;
  if (!strcmp(shape->key, "box") && !child_of(map, "lattice_origin") && !packing)
    fit(c, shape, dx, &fill);
  sph_shape *s = sph_case_shape_of(c, shape, dx, support, error);
  if (!s) return error->status;
  sph_group_add_shape(group, s, &fill);
  sph_shape_free(s);
  return SPH_OK;
}
