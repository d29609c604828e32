/* A tree of boxes around triangles.  The winding number is the sum of the solid angles of all
 * triangles (van Oosterom & Strackee 1983) over 4 pi; what is far away is one dipole (Barill,
 * Dickson, Schmidt, Levin & Jacobson 2018, first order). */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"
#include "shape_data.h"
#include "shape_mesh.h"

enum { LEAF = 4, DEEPEST = 60 };
static const double FAR = 3; /* a node is far beyond so many of its radii */

typedef struct builder {
  sph_shape_mesh *mesh;
  double (*middle)[3]; /* of triangles, in the order of the tree so far */
} builder;

static void minus(const double a[3], const double b[3], double c[3])
{
  for (int d = 0; d < 3; d++) c[d] = a[d] - b[d];
}

static void times(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

static const double *corner(const sph_shape_mesh *m, int triangle, int k)
{
  return m->corner[m->triangle[triangle][k]];
}

static void area_of(const sph_shape_mesh *m, int t, double area[3])
{
  double a[3], b[3];
  minus(corner(m, t, 1), corner(m, t, 0), a);
  minus(corner(m, t, 2), corner(m, t, 0), b);
  times(a, b, area);
  for (int d = 0; d < 3; d++) area[d] /= 2;
}

/* What a node tells of its triangles begin .. end - 1. */
static void sum_up(const builder *b, sph_shape_mesh_node *n, int begin, int end)
{
  const sph_shape_mesh *m = b->mesh;
  double whole = 0;
  for (int d = 0; d < 3; d++) n->lower[d] = INFINITY, n->upper[d] = -INFINITY;
  for (int t = begin; t < end; t++) {
    double area[3];
    area_of(m, t, area);
    const double size = sqrt(sph_shape_data_dot(area, area));
    whole += size;
    for (int d = 0; d < 3; d++) {
      n->area[d] += area[d];
      n->middle[d] += size * b->middle[t][d];
      for (int k = 0; k < 3; k++) {
        n->lower[d] = fmin(n->lower[d], corner(m, t, k)[d]);
        n->upper[d] = fmax(n->upper[d], corner(m, t, k)[d]);
      }
    }
  }
  for (int d = 0; d < 3; d++)
    n->middle[d] = whole > 0 ? n->middle[d] / whole : (n->lower[d] + n->upper[d]) / 2;
  for (int t = begin; t < end; t++)
    for (int k = 0; k < 3; k++) {
      double r[3];
      minus(corner(m, t, k), n->middle, r);
      n->radius = fmax(n->radius, sqrt(sph_shape_data_dot(r, r)));
    }
}

static void swap(const builder *b, int i, int j)
{
  int t[3];
  double x[3];
  memcpy(t, b->mesh->triangle[i], sizeof t);
  memcpy(b->mesh->triangle[i], b->mesh->triangle[j], sizeof t);
  memcpy(b->mesh->triangle[j], t, sizeof t);
  memcpy(x, b->middle[i], sizeof x);
  memcpy(b->middle[i], b->middle[j], sizeof x);
  memcpy(b->middle[j], x, sizeof x);
}

/* The triangles begin .. end - 1 in two halves, across the longest side of the box of their
 * middles. */
static int split(const builder *b, int begin, int end)
{
  double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int t = begin; t < end; t++)
    for (int d = 0; d < 3; d++) {
      lower[d] = fmin(lower[d], b->middle[t][d]);
      upper[d] = fmax(upper[d], b->middle[t][d]);
    }
  int across = 0, at = begin;
  for (int d = 1; d < 3; d++)
    if (upper[d] - lower[d] > upper[across] - lower[across]) across = d;
  const double half = (lower[across] + upper[across]) / 2;
  for (int t = begin; t < end; t++)
    if (b->middle[t][across] < half) swap(b, t, at++);
  return at == begin || at == end ? (begin + end) / 2 : at;
}

static int grow(const builder *b, int begin, int end, int depth)
{
  sph_shape_mesh *m = b->mesh;
  const int number = m->nodes++;
  sph_shape_mesh_node *n = &m->node[number];
  *n = (sph_shape_mesh_node){0};
  sum_up(b, n, begin, end);
  if (end - begin <= LEAF) {
    n->begin = begin;
    n->end = end;
    return number;
  }
  /* Halves by number keep a tree of any triangles from going down without end. */
  const int middle = depth < DEEPEST ? split(b, begin, end) : (begin + end) / 2;
  n->left = grow(b, begin, middle, depth + 1);
  n->right = grow(b, middle, end, depth + 1);
  return number;
}

int sph_shape_mesh_tree(sph_shape_mesh *m, sph_error *error)
{
  builder b = {.mesh = m};
  b.middle = sph_memory_new((size_t)m->triangles, sizeof *b.middle, "a surface", error);
  m->node = SPH_NEW(sph_shape_mesh_node, 2 * (long)m->triangles, "a surface", error);
  if (b.middle && m->node) {
    for (int t = 0; t < m->triangles; t++)
      for (int k = 0; k < 3; k++)
        for (int d = 0; d < 3; d++) b.middle[t][d] += corner(m, t, k)[d] / 3;
    grow(&b, 0, m->triangles, 0);
  }
  sph_memory_free(b.middle);
  return m->node && m->nodes ? SPH_OK : SPH_ERR_MEMORY;
}

/* ---- the nearest triangle */

static double segment2(const double p[3], const double a[3], const double b[3])
{
  double e[3], w[3];
  minus(b, a, e);
  minus(p, a, w);
  const double length2 = sph_shape_data_dot(e, e);
  const double along = length2 > 0 ? fmin(fmax(sph_shape_data_dot(w, e) / length2, 0), 1) : 0;
  for (int d = 0; d < 3; d++) w[d] -= along * e[d];
  return sph_shape_data_dot(w, w);
}

/* Square of the distance: from the plane, where the foot of p lies in the triangle, else from its
 * edges. */
static double triangle2(const sph_shape_mesh *m, int t, const double p[3])
{
  double n[3], w[3];
  area_of(m, t, n);
  const double n2 = sph_shape_data_dot(n, n);
  int over = n2 > 0;
  for (int k = 0; k < 3 && over; k++) {
    double e[3], out[3];
    minus(corner(m, t, (k + 1) % 3), corner(m, t, k), e);
    times(n, e, out); /* into the triangle */
    minus(p, corner(m, t, k), w);
    over = sph_shape_data_dot(w, out) >= 0;
  }
  if (over) {
    minus(p, corner(m, t, 0), w);
    const double off = sph_shape_data_dot(w, n);
    return off * off / n2;
  }
  double least = INFINITY;
  for (int k = 0; k < 3; k++)
    least = fmin(least, segment2(p, corner(m, t, k), corner(m, t, (k + 1) % 3)));
  return least;
}

static double box2(const sph_shape_mesh_node *n, const double x[3])
{
  double sum = 0;
  for (int d = 0; d < 3; d++) {
    const double beyond = fmax(0, fmax(n->lower[d] - x[d], x[d] - n->upper[d]));
    sum += beyond * beyond;
  }
  return sum;
}

static double nearest2(const sph_shape_mesh *m, int node, const double x[3], double least)
{
  const sph_shape_mesh_node *n = &m->node[node];
  for (int t = n->begin; t < n->end; t++) least = fmin(least, triangle2(m, t, x));
  if (n->begin < n->end) return least;
  double left = box2(&m->node[n->left], x), right = box2(&m->node[n->right], x);
  const int first = left <= right;
  if (fmin(left, right) < least) least = nearest2(m, first ? n->left : n->right, x, least);
  if (fmax(left, right) < least) least = nearest2(m, first ? n->right : n->left, x, least);
  return least;
}

double sph_shape_mesh_tree_distance(const sph_shape_mesh *m, const double x[3])
{
  return sqrt(nearest2(m, 0, x, INFINITY));
}

/* ---- the winding number */

/* Solid angle of a triangle [sr]. */
static double angle(const sph_shape_mesh *m, int t, const double x[3])
{
  double a[3], b[3], c[3], bc[3];
  minus(corner(m, t, 0), x, a);
  minus(corner(m, t, 1), x, b);
  minus(corner(m, t, 2), x, c);
  times(b, c, bc);
  const double la = sqrt(sph_shape_data_dot(a, a)), lb = sqrt(sph_shape_data_dot(b, b)),
               lc = sqrt(sph_shape_data_dot(c, c));
  const double below = la * lb * lc + sph_shape_data_dot(a, b) * lc +
                       sph_shape_data_dot(b, c) * la + sph_shape_data_dot(c, a) * lb;
  return 2 * atan2(sph_shape_data_dot(a, bc), below);
}

static double solid_angle(const sph_shape_mesh *m, int node, const double x[3])
{
  const sph_shape_mesh_node *n = &m->node[node];
  double r[3], sum = 0;
  minus(n->middle, x, r);
  const double r2 = sph_shape_data_dot(r, r);
  if (r2 > FAR * FAR * n->radius * n->radius)
    return sph_shape_data_dot(r, n->area) / (r2 * sqrt(r2));
  for (int t = n->begin; t < n->end; t++) sum += angle(m, t, x);
  if (n->begin < n->end) return sum;
  return solid_angle(m, n->left, x) + solid_angle(m, n->right, x);
}

double sph_shape_mesh_tree_winding(const sph_shape_mesh *m, const double x[3])
{
  return solid_angle(m, 0, x) / (4 * M_PI);
}
