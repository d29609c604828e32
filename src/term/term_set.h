/* term_set.h -- the terms of a simulation: what the fused loops need of them, and the body
 * terms. */
#ifndef SPH_TERM_SET_H
#define SPH_TERM_SET_H
#include "fluid_pair.h"
#include "sphode/term.h"

enum { SPH_BODY_TERMS_MAX = 32, SPH_TERM_NAME_MAX = 64 };

typedef struct sph_term_set {
  unsigned bits;             /* pair terms: SPH_CONTINUITY | ... */
  unsigned form_c2, form_c1; /* which terms asked for which row: all must be the same */
  double alpha, beta;        /* artificial viscosity */
  double alpha_u;            /* artificial conductivity */
  double delta;              /* density diffusion */
  double g[3];               /* sum of the uniform body forces [m/s^2] */
  int bodies;
  sph_term body[SPH_BODY_TERMS_MAX];
  char name[SPH_BODY_TERMS_MAX][SPH_TERM_NAME_MAX];
} sph_term_set;

/* Checks a term and takes it in (its ctx too: on failure it is let go of). */
int sph_term_set_add(sph_term_set *set, const sph_term *term, sph_error *error);
/* Do the terms fit together? */
int sph_term_set_check(const sph_term_set *set, sph_error *error);
void sph_term_set_free(sph_term_set *set);
/* Energy per mass of all body forces that have a potential [J/kg]. */
double sph_term_set_potential(const sph_term_set *set, const double x[3]);

#endif
