/* baseline.h -- what speed is compared with: the same right-hand side as a good plain code has it.
 *
 * Particles sorted by cells, one record each; a full neighbour list in compressed rows, exact; a
 * scalar loop over it, with the compiler flags of the library's loops.  One liquid in open space,
 * Wendland C2: continuity, pressure (C2), artificial viscosity (beta = 0), Molteni's diffusion,
 * Tait with gamma = 7.  Not a line of it is the library's. */
#ifndef BASELINE_H
#define BASELINE_H

typedef struct baseline_def {
  int dim;            /* 2, 3 */
  double h;           /* smoothing length [m] */
  double alpha;       /* of the artificial viscosity */
  double delta;       /* of Molteni's diffusion */
  double rho0, c0;    /* of the liquid [kg/m^3], [m/s] */
  long n;             /* particles */
  const double *x[3]; /* [n] [m], and so on: borrowed, in the user's order */
  const double *v[3], *rho, *m;
} baseline_def;

typedef struct baseline baseline;

/* NULL: no memory. */
baseline *baseline_create(const baseline_def *def);
void baseline_free(baseline *b);
/* Sorts, and builds the rows; 0: no memory. */
int baseline_build(baseline *b);
/* Pack, pair loop, unpack: dv[d][n], drho[n] in the user's order. */
void baseline_rates(baseline *b, double *const dv[3], double *drho);

#endif
