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

typedef struct sph_boundary {
  const char *name; /* "adami" */
  int no_slip; /* 1: viscous terms see v_w = 2 v_prescribed - <v_fluid>; 0: walls take no part in
                  them */
  int tension; /* 1: wall pressure may be negative; 0: p_w >= 0 (thin films go wrong otherwise) */
  double temperature;   /* [K] of the wall's surface, for conduction; 0: adiabatic */
  sph_motion *motion;   /* NULL: at rest */
  void *ctx;            /* the user's; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx; may be NULL */
} sph_boundary;

/* Adami, Hu & Adams (2012) dummy particles, free slip, p_w >= 0, at rest. */
SPH_API sph_boundary sph_boundary_adami(void);
SPH_API sph_boundary sph_boundary_adami_no_slip(void);

SPH_API const char *sph_boundary_name(int k); /* NULL behind the last */
SPH_API const char *sph_boundary_formula(const char *name);

#ifdef __cplusplus
}
#endif
#endif
