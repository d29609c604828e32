/* sphode/boundary.h -- wall models. */
#ifndef SPHODE_BOUNDARY_H
#define SPHODE_BOUNDARY_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Rigid motion of a wall at time t [s]: displacement from the start [m], velocity [m/s],
 * acceleration [m/s^2].  A lid that slides in its own plane has a velocity and no displacement. */
typedef void sph_motion(void *ctx, double t, double displacement[3], double velocity[3],
                        double acceleration[3]);

/* Rotation of a wall at time t [s], besides its motion: about the axis through the centre of its
 * boundary, both carried along by the displacement: turn = angle since the start [rad], angular
 * velocity [1/s], angular acceleration [1/s^2], right handed.  The angle of a drum that turns in
 * itself may stay 0. */
typedef void sph_rotation(void *ctx, double t, double turn[3]);

/* Of a wall's surface at time t [s]: value[n] at the places x[d][n] [m]. */
typedef void sph_surface(void *ctx, double t, long n, const double *const x[3], double *value);

/* A plane of a mirror, infinite: a point of it [m] and its normal into the fluid, of any length. */
typedef struct sph_plane {
  double point[3], normal[3];
} sph_plane;

enum { SPH_PLANES_MAX = 6 };

typedef struct sph_boundary {
  const char *name; /* "adami", "dbc", "mirror" */
  int no_slip; /* 1: viscous terms see 2 v_prescribed - <v_fluid> (adami, in the frame of a wall
                  that turns), v_prescribed (dbc), 2 v_prescribed - v (mirror); 0: none of the wall;
                  of a mirror the reflected v */
  int tension; /* 1: wall pressure may be negative; 0: p_w >= 0 (thin films go wrong otherwise), of
                  dbc rho_w >= rho0; a mirror shows the pressure of its fluid */
  double temperature; /* [K] of the wall's surface, for conduction; 0: adiabatic */
  double heat_flux;   /* of a mirror: heat that enters the fluid [W/m^2]; 0: adiabatic */
  int planes;         /* of a mirror, 1 to SPH_PLANES_MAX; pairwise parallel or at right angles */
  sph_plane plane[SPH_PLANES_MAX];
  sph_motion *motion; /* NULL: at rest */
  /* NULL: no rotation; not of mirrors.  axis: of any length; 0: that of z (in 2D none other is). */
  sph_rotation *rotation;
  double centre[3], axis[3]; /* a point of the axis at the start [m]; its direction */
  /* Where these are given they count in place of the two numbers above: temperature [K] > 0 at the
   * particles of the wall, of a mirror where its planes reflect particles; flux [W/m^2] there. */
  sph_surface *temperature_at, *heat_flux_at;
  /* Where the displacement along x, y, z and the angle come from, as "piston.yml:3:14: push(t)",
   * for the error that says that they are not finite; NULL: their names.  Borrowed, as ctx is. */
  const char *source[4];
  void *ctx;            /* the user's, for all of these; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx; may be NULL */
} sph_boundary;

/* Adami, Hu & Adams (2012) dummy particles, free slip, p_w >= 0, at rest.  Liquids are repelled
 * besides: sph_group_set_repulsion. */
SPH_API sph_boundary sph_boundary_adami(void);
SPH_API sph_boundary sph_boundary_adami_no_slip(void);

/* Dynamic boundary particles (Crespo, Gomez-Gesteira & Dalrymple 2007): density by continuity with
 * the fluid, integrated in y; pressure by the equation of state; rho_w >= rho0, free slip, at rest.
 * Needs the term continuity and an equation of state p(rho). */
SPH_API sph_boundary sph_boundary_dbc(void);

/* Mirror images of the fluid behind planes, at edges and corners by repeated reflection: free slip,
 * adiabatic, at rest.  Its group has no particles of its own; what sph_group_count tells is the
 * number of images, which changes at each build of the lists.  Planes are added by the two below:
 * one, or the sides of a box but for the open ones ("x- y+"; NULL: none).  What is wrong with them
 * is told where the boundary is set. */
SPH_API sph_boundary sph_boundary_mirror(void);
SPH_API void sph_boundary_mirror_plane(sph_boundary *boundary, const double *point,
                                       const double *normal, int dim);
SPH_API void sph_boundary_mirror_box(sph_boundary *boundary, const double *lo, const double *hi,
                                     const char *open, int dim);

SPH_API const char *sph_boundary_name(int k); /* NULL behind the last */
SPH_API const char *sph_boundary_formula(const char *name);

#ifdef __cplusplus
}
#endif
#endif
