/* term_scalar_diffusion.h -- what the simulation asks of a scalar that diffuses. */
#ifndef SPH_TERM_SCALAR_DIFFUSION_H
#define SPH_TERM_SCALAR_DIFFUSION_H
#include "sphode/term.h"

/* The diffusivity of a fluid, the scalar at the surface of a wall; where there is none: none. */
double sph_term_scalar_diffusion_of(const sph_term *term, const char *group, double none);
/* Without any diffusivity it has no pairs. */
void sph_term_scalar_diffusion_settle(sph_term *term);

#endif
