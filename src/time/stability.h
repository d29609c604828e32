/* stability.h -- the step that an explicit Runge-Kutta scheme bears. */
#ifndef SPH_STABILITY_H
#define SPH_STABILITY_H

/* An estimate of S: the largest c dt/h; A: [stages][stages], b: [stages]. */
double sph_stability(int stages, const double *const *A, const double *b);

#endif
