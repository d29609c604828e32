/* sim_parameter.h -- the numbers that f depends on besides t and y, by name. */
#ifndef SPH_SIM_PARAMETER_H
#define SPH_SIM_PARAMETER_H
#include "sim_data.h"

enum { SPH_PARAMETER_NAME_MAX = 2 * SPH_NAME_MAX };

/* Where a parameter acts besides the constants of pair loops: bits. */
enum { SPH_ACTS_EOS = 1, SPH_ACTS_WALLS = 2, SPH_ACTS_RATES = 4, SPH_ACTS_ALL = 7 };

typedef struct sph_parameter {
  char name[SPH_PARAMETER_NAME_MAX];
  double *value; /* where it lives; NULL: none, nothing changes */
  double scale;  /* its size: |value|, or what stands for that of a zero */
  unsigned acts;
  int is_h;          /* the smoothing length, which others are made of */
  int is_own;        /* the user's own: callbacks may read it */
  size_t eos_member; /* > 0: offset in sph_eos, of all groups that share one equation of state */
  unsigned char shares[SPH_SETS_MAX]; /* whether group g is one of them */
} sph_parameter;

/* By name:
 *   h                          smoothing length, at fixed dx and masses
 *   TERM.NUMBER                as viscosity-artificial.alpha, delta.delta, xsph.epsilon,
 *                              harmonic.omega, gravity.y
 *   GROUP.viscosity, .conductivity, .temperature (of a wall)
 *   GROUP.c0, .rho0, .gamma, .p_background, .p_inf, .q, .slope, .grueneisen, .c_v
 *                              of its equation of state, and of all groups that have the same one
 * Unknown, or of a term that is not there or does nothing: recorded, with the known names. */
int sph_sim_parameter_find(sph_sim *sim, const char *name, sph_parameter *parameter);
/* Number k = 0, 1, ... of those; 0 behind the last. */
int sph_sim_parameter_get(sph_sim *sim, int k, sph_parameter *parameter);
/* A number of the user's own that callbacks read. */
void sph_sim_parameter_own(const char *name, double *value, sph_parameter *parameter);
void sph_sim_parameter_set(sph_sim *sim, const sph_parameter *parameter, double value);

#endif
