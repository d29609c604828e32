/* baseline.h -- what speed is compared with: the same right-hand side as a good plain code has it.
 *
 * Particles sorted by cells, one record each; a full neighbour list in compressed rows, exact; a
 * scalar loop over it, compiled with -O3 (or the flags given to configure) for the instruction set
 * of the library's loops.  One liquid in open space,
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

typedef struct baseline_code {
  baseline *(*create)(const baseline_def *def); /* NULL: no memory */
  void (*free)(baseline *b);
  int (*build)(baseline *b); /* sorts, and builds the rows; 0: no memory */
  /* Pack, pair loop, unpack: dv[d][n], drho[n] in the user's order. */
  void (*rates)(baseline *b, double *const dv[3], double *drho);
} baseline_code;

#endif
