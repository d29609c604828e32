/* shape_mesh.h -- a surface of triangles. */
#ifndef SPH_SHAPE_MESH_H
#define SPH_SHAPE_MESH_H
#include "sphode/base.h"

typedef struct sph_shape_mesh_node {
  double lower[3], upper[3];
  /* Seen from far away: sum of area times normal, at the mean of the triangles by area; how far any
   * of them is from there. */
  double area[3], middle[3], radius;
  int begin, end;  /* triangles of a leaf; begin == end: no leaf */
  int left, right; /* nodes */
} sph_shape_mesh_node;

typedef struct sph_shape_mesh {
  int corners, triangles, nodes;
  double (*corner)[3];       /* [corners] owned, [m] */
  int (*triangle)[3];        /* [triangles] owned, anticlockwise seen from outside */
  sph_shape_mesh_node *node; /* owned; the first is the root */
} sph_shape_mesh;

/* Reads .stl (binary or ASCII) or .obj, corners times unit; equal corners are one, triangles with
 * two equal corners are left out.  A status, the reason in error. */
int sph_shape_mesh_read(sph_shape_mesh *mesh, const char *path, double unit, sph_error *error);
/* Does each edge belong to triangles that go along it as often one way as the other?  Else told. */
int sph_shape_mesh_closed(const sph_shape_mesh *mesh, const char *path, sph_error *error);
/* Its volume [m^3], < 0 where its triangles are seen clockwise from outside. */
double sph_shape_mesh_volume(const sph_shape_mesh *mesh);
void sph_shape_mesh_turn(sph_shape_mesh *mesh); /* ... the other way */
void sph_shape_mesh_free(sph_shape_mesh *mesh);

/* Sorts the triangles into a tree; then: */
int sph_shape_mesh_tree(sph_shape_mesh *mesh, sph_error *error);
/* distance from the nearest triangle; */
double sph_shape_mesh_tree_distance(const sph_shape_mesh *mesh, const double x[3]);
/* winding number: 1 inside, 0 outside a closed surface, the part of all directions of an open one.
 */
double sph_shape_mesh_tree_winding(const sph_shape_mesh *mesh, const double x[3]);

#endif
