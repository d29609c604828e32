/* sphode/shape.h -- shapes: where particles are put.
 *
 * A shape is a function d(x) [m], the distance to its surface, negative inside.  Shapes are made of
 * others; the outermost is filled with particles by sph_group_add_shape:
 *
 *   sph_shape *tank = sph_shape_box(2, lo, hi, &error), *pillar = sph_shape_ball(2, c, r, &error);
 *   sph_shape *water = sph_shape_difference(2, (sph_shape *[]){tank, pillar}, &error);
 *   sph_group_add_shape(group, water, &(sph_fill){.rho0 = 1000});
 *   sph_shape_free(water);
 *
 * What makes a shape of others owns them from then on, also where it fails.  Each returns NULL with
 * the reason in error; NULL parts (from a failed predecessor) flow through. */
#ifndef SPHODE_SHAPE_H
#define SPHODE_SHAPE_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_shape sph_shape;
struct sph_group;

/* [dim] each [m], upper above lower in each direction. */
SPH_API sph_shape *sph_shape_box(int dim, const double *lower, const double *upper,
                                 sph_error *error);
/* A ball, in 2D a disc; centre[dim], radius > 0 [m]. */
SPH_API sph_shape *sph_shape_ball(int dim, const double *centre, double radius, sph_error *error);
/* A cylinder, and a cone with its tip cut off where both radii are > 0: in 3D, from[3], to[3] the
 * ends of its axis [m]. */
SPH_API sph_shape *sph_shape_cylinder(const double *from, const double *to, double radius,
                                      sph_error *error);
SPH_API sph_shape *sph_shape_cone(const double *from, const double *to, double radius_from,
                                  double radius_to, sph_error *error);
/* All points behind a plane (in 2D a line), whose normal[dim], of any length, points out of the
 * shape. */
SPH_API sph_shape *sph_shape_half_space(int dim, const double *point, const double *normal,
                                        sph_error *error);
/* A polygon in 2D: corner[n][2] [m] in order, either way round, n >= 3; edges do not cross. */
SPH_API sph_shape *sph_shape_polygon(int n, const double (*corner)[2], sph_error *error);
/* A polygon in the plane of the two other directions, in the order x, y, z, drawn out along axis
 * (0, 1, 2) between two coordinates [m]: in 3D. */
SPH_API sph_shape *sph_shape_prism(int n, const double (*corner)[2], int axis, double from,
                                   double to, sph_error *error);
/* The inside of a surface of triangles in a file, .stl (binary or ASCII) or .obj, times unit [m].
 * Edges belong to two triangles each that go round the same way, or it is an error; holes == 1:
 * what more than half of all directions meet is inside (generalised winding number, Jacobson,
 * Kavan & Sorkine-Hornung 2013), whether the surface is closed or not. */
SPH_API sph_shape *sph_shape_surface(const char *path, double unit, int holes, sph_error *error);

/* In one of them; in all of them; in the first and in none of the others; n >= 1. */
SPH_API sph_shape *sph_shape_union(int n, sph_shape *const *part, sph_error *error);
SPH_API sph_shape *sph_shape_intersection(int n, sph_shape *const *part, sph_error *error);
SPH_API sph_shape *sph_shape_difference(int n, sph_shape *const *part, sph_error *error);
/* What is nearer than thickness [m] to the surface of part, outside it (inside == 0) or inside.  dx
 * [m]: the spacing that it is for; where the distance of part is not known in closed form, it is
 * taken from points of its surface dx/8 apart, and right within as much at edges. */
SPH_API sph_shape *sph_shape_shell(sph_shape *part, double thickness, int inside, double dx,
                                   sph_error *error);
SPH_API sph_shape *sph_shape_translate(sph_shape *part, const double *by, sph_error *error);
/* By angle [rad] around an axis[3], of any length, right handed, through about[dim]; in 2D axis is
 * not looked at (NULL is right): anticlockwise. */
SPH_API sph_shape *sph_shape_rotate(sph_shape *part, const double *axis, double angle,
                                    const double *about, sph_error *error);
/* By a factor > 0, about[dim] stays. */
SPH_API sph_shape *sph_shape_scale(sph_shape *part, double by, const double *about,
                                   sph_error *error);

/* Distance of x[dim] [m], < 0 inside.  The sign is right everywhere; the size is the distance for
 * all that is no combination, else at most the distance.  NULL: NaN. */
SPH_API double sph_shape_distance(const sph_shape *shape, const double *x);
/* A box around it, lower[3], upper[3] [m]; 0: it goes on without end. */
SPH_API int sph_shape_bounds(const sph_shape *shape, double *lower, double *upper);
SPH_API int sph_shape_dim(const sph_shape *shape);
SPH_API void sph_shape_free(sph_shape *shape); /* NULL is fine */

/* Particles that fit the shape: as many as its volume over dx^dim, the outermost half a spacing
 * from its surface, moved apart until h times the rms of the gradient of their concentration
 * sum V W (with what is behind the surface filled) is at most `uniformity`. */
typedef struct sph_pack {
  double uniformity; /* 0: 0.005; a lattice that is cut has 0.03 to 0.08 */
  int iterations;    /* at most, and no longer than they help; 0: 500 */
} sph_pack;

typedef struct sph_packing {
  long particles;
  int iterations, settled; /* settled 0: not as uniform as wanted, */
  int stuck;               /* and more moves did not help; else their number was used up */
  double before, uniformity;
  double volume; /* of the shape [m^dim] */
} sph_packing;

/* How a shape is filled.  Of every lattice a particle has the volume dx^dim. */
typedef struct sph_fill {
  double rho0;          /* density [kg/m^3] */
  const char *lattice;  /* NULL: "square" in 1D and 2D, "cubic" in 3D */
  double origin[3];     /* a corner of a cell of the lattice [m] */
  double stretch[3];    /* of its cells, as to fit into a box; volumes and masses follow; 0: 1 */
  const sph_pack *pack; /* NULL: as on the lattice */
} sph_fill;

/* Lattice k = 0, 1, ...: "square", "hexagonal" (2D), "cubic", "bcc", "fcc", "hcp" (3D); NULL behind
 * the last.  Its dimensions. */
SPH_API const char *sph_shape_lattice_name(int k);
SPH_API int sph_shape_lattice_dim(const char *name);
/* Sides of its cell over dx, side[3]; 1 where there is no such direction; 0: no such lattice. */
SPH_API int sph_shape_lattice_cell(const char *name, double *side);

/* Adds the points of the lattice inside the shape to a group, before the run; failures stick to its
 * simulation. */
SPH_API void sph_group_add_shape(struct sph_group *group, const sph_shape *shape,
                                 const sph_fill *fill);

/* What came of the last packing of a group; NULL: it has none. */
SPH_API const sph_packing *sph_group_packing(const struct sph_group *group);

#ifdef __cplusplus
}
#endif
#endif
