/* sphode/term.h -- the terms of the right-hand side; docs/theory.md, Terms.
 *
 * sph_term_*() return small definitions by value; they are checked where they are attached
 * (sph_sim_add_term). */
#ifndef SPHODE_TERM_H
#define SPHODE_TERM_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a body term reads and adds to: all particles of one fluid group. */
typedef struct sph_particles {
  int dim;
  long n;
  double t;           /* time [s] */
  const char *group;  /* its name */
  const double *x[3]; /* [n] positions [m]; NULL for d >= dim */
  const double *v[3]; /* [n] velocities [m/s] */
  const double *rho;  /* [n] density [kg/m^3] */
  const double *u;    /* [n] internal energy [J/kg], NULL unless the group is thermal */
  const double *p;    /* [n] pressure [Pa] */
  const double *c;    /* [n] sound speed [m/s] */
  const double *m;    /* [n] mass [kg, kg/m, kg/m^2 in 3D, 2D, 1D] */
  double *a[3];       /* [n] add accelerations [m/s^2] */
  double *drho;       /* [n] add density rates [kg/m^3/s] */
  double *du;         /* [n] add heating [W/kg], NULL unless thermal */
} sph_particles;

typedef struct sph_term sph_term;
struct sph_term {
  const char *name; /* "pressure", ... or the user's own; copied when attached */
  /* Parameters of the built-in terms; each constructor says which it reads. */
  /* continuity: "c2" (NULL) or "c1"; pressure: "c2" (NULL) or "s"; delta: "molteni" or "antuono" */
  const char *form;
  double alpha, beta; /* artificial viscosity; alpha: artificial conductivity */
  double delta;       /* density diffusion */
  double g[3];        /* uniform body force [m/s^2] */
  double omega;       /* harmonic body force [1/s] */
  /* A user's own (NULL in built-in pair terms): */
  int (*body)(const sph_term *term, const sph_particles *particles);      /* 0, SPH_RETRY or < 0 */
  double (*dt_max)(const sph_term *term, const sph_particles *particles); /* [s]; NULL: no limit */
  /* [J/kg] for the energy balance; NULL: none */
  double (*potential)(const sph_term *term, const double x[3]);
  void *ctx;            /* the user's; borrowed unless free is given */
  void (*free)(void *); /* called once with ctx when the simulation lets go of it; may be NULL */
};

/* d rho_i/dt: "c2": rho_i sum V_j v_ij.grad W;  "c1": sum m_j v_ij.grad W */
SPH_API sph_term sph_term_continuity(void);
SPH_API sph_term sph_term_continuity_form(const char *form);
/* a_i: "c2": - sum m_j (p_i + p_j)/(rho_i rho_j) grad W;
 *      "s":  - sum m_j (p_i/rho_i^2 + p_j/rho_j^2) grad W;
 * thermal fluids are heated by the partner of the same row. */
SPH_API sph_term sph_term_pressure(void);
SPH_API sph_term sph_term_pressure_form(const char *form);
/* Monaghan (1992) artificial viscosity with heating; alpha, beta >= 0. */
SPH_API sph_term sph_term_viscosity_artificial(double alpha, double beta);
/* Price (2008) artificial conductivity of thermal fluids; alpha_u >= 0, usually 1. */
SPH_API sph_term sph_term_conductivity_artificial(double alpha_u);
/* Density diffusion of the delta-SPH family: model "molteni" or "antuono"; delta >= 0, usually
 * 0.1. */
SPH_API sph_term sph_term_delta(const char *model, double delta);
/* Uniform body force g[3] [m/s^2]. */
SPH_API sph_term sph_term_gravity(const double g[3]);
/* Central harmonic body force a = -omega^2 x [1/s]: the oscillating drop. */
SPH_API sph_term sph_term_harmonic(double omega);

SPH_API const char *sph_term_name(int k);               /* built-in names, NULL behind the last */
SPH_API const char *sph_term_formula(const char *name); /* one line; NULL for an unknown name */

#ifdef __cplusplus
}
#endif
#endif
