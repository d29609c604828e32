/* scene.h -- random states, made once for the oracle and once for the library through its public
 * interface. */
#ifndef SCENE_H
#define SCENE_H
#include "oracle.h"
#include "sphode.h"

typedef struct scene_def {
  int dim, kernel; /* kernel: enum oracle_kernel */
  int n;           /* cells of size dx along each direction; 8 or more */
  int periodic[3]; /* where it is not, the cloud ends */
  int random;      /* 1: points anywhere, not closer than 0.3 dx; 0: a lattice with 20 % jitter */
  int walls;       /* 0: none; 1: three layers at the bottom; 2: at the top, too, which move */
  int no_slip, tension;
  int fluids;  /* 1 or 2, side by side */
  int dusts;   /* 0, 1 or 2, everywhere, in walls too */
  int thermal; /* ideal gas, else Tait (and linear as the second) */
  int laminar; /* fluids have viscosity, conductivity, specific heat, walls a temperature */
  int outside; /* some particles are whole periods away from the box */
  unsigned long seed;
} scene_def;

typedef struct scene {
  oracle o;
  double dx, h_over_dx;
  int thermal;
} scene;

/* Neither terms nor body forces are set: scene.o is there to be changed. */
void scene_make(scene *s, const scene_def *def);
void scene_free(scene *s);

/* The library's simulation of scene.o with its terms, and with these options (NULL, 0:
 * defaults). */
typedef struct scene_options {
  const char *isa, *neighbors, *precision;
  int threads;
  double skin; /* [h] */
} scene_options;
sph_sim *scene_sim(scene *s, scene_options options);

/* Writes scene.o's positions, velocities, densities, energies to the groups of the simulation. */
void scene_write(const scene *s, sph_sim *sim);

/* The rates that the library found, in the order of scene.o.particle: [n] each, 0 for walls; p of
 * walls too.  du: of the energy that is integrated; drho: 0 where density is summed.
 * To be freed by scene_rates_free. */
typedef struct scene_rates {
  long n;
  double *dx[3], *a[3], *drho, *du, *p, *c, *rho, *dalpha;
} scene_rates;
scene_rates scene_evaluate(const scene *s,
                           sph_sim *sim); /* fails the test where the library fails */
void scene_rates_free(scene_rates *rates);
/* Bits: 1 where all are the same. */
int scene_rates_same(const scene_rates *a, const scene_rates *b);

/* Uniform in [0, 1); any seed. */
double scene_random(unsigned long *state);

#endif
