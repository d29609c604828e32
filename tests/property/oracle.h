/* oracle.h -- the right-hand side a second time: brute force over all pairs in long double, written
 * from the equations alone (docs/theory.md), sharing no line with the library.
 *
 * Beside every result stands its size: the sum of the magnitudes of all that was added to it, in
 * which what cancels counts in full.  A double precision evaluation differs by rounding times
 * size. */
#ifndef ORACLE_H
#define ORACLE_H

typedef long double real;

enum oracle_eos_kind { ORACLE_TAIT, ORACLE_LINEAR, ORACLE_IDEAL_GAS };

typedef struct oracle_eos {
  enum oracle_eos_kind kind;
  real rho0, c0, gamma, p_background; /* [kg/m^3], [m/s], 1, [Pa] */
  real c_v;                           /* [J/(kg K)]; 0: no temperature */
} oracle_eos;

typedef struct oracle_group {
  int wall;             /* 1: wall, 0: fluid or dust */
  int dust;             /* 1: a species of its own, without pressure */
  oracle_eos eos;       /* of a wall: that of the fluid it holds */
  int no_slip;          /* of a wall: viscous terms see it */
  int tension;          /* of a wall: p < 0 is allowed */
  real repulsion;       /* of a wall, of liquids */
  real rho0;            /* of a wall, at rest [kg/m^3] */
  real viscosity;       /* [Pa s] */
  real conductivity;    /* [W/(m K)] */
  real temperature;     /* of a wall's surface [K]; 0: adiabatic */
  real velocity[3];     /* of a wall [m/s] */
  real acceleration[3]; /* of a wall [m/s^2] */
} oracle_group;

typedef struct oracle_particle {
  int group;
  /* Given: */
  real x[3], v[3]; /* [m], [m/s]; a wall's v is set from its group */
  real m, rho, u;  /* [kg], [kg/m^3], [J/kg]; a wall's rho is a result */
  /* Results: */
  real p, c;         /* [Pa], [m/s] */
  real volume;       /* of a wall's place; 0 until it is known [m^dim] */
  real v_viscous[3]; /* what viscous terms see [m/s] */
  real T;            /* what conduction sees [K] */
  real phi;          /* of the row of that name */
  real gradient[3];  /* <grad rho>^L [kg/m^4] */
  real B[3][3];      /* inverse gradient matrix, or 1 */
  real alpha;        /* given where a switch varies it */
  real f, f_size;    /* Balsara's */
  real L[3][3], L_size, v_sig, dalpha, dalpha_size;
  real dx[3], a[3], drho;
  real du;                        /* rate of the energy that is integrated */
  real work, heat;                /* by compression, by all else [W/kg] */
  real p_size, condition, T_size; /* condition: of rho */
  real B_size;                    /* of each of its numbers */
  real gradient_size, dx_size, a_size, drho_size, du_size, work_size, heat_size;
} oracle_particle;

enum oracle_kernel {
  ORACLE_WENDLAND_C2,
  ORACLE_WENDLAND_C4,
  ORACLE_WENDLAND_C6,
  ORACLE_CUBIC,
  ORACLE_QUINTIC,
  ORACLE_GAUSSIAN,
  ORACLE_SHIFTED,
  ORACLE_SPIKY
};
enum { ORACLE_KERNELS = ORACLE_SPIKY + 1 };
enum { ORACLE_GROUPS = 6 };
enum oracle_row { ORACLE_NONE, ORACLE_C1, ORACLE_C2, ORACLE_PHI }; /* density and its partners */
enum oracle_delta { ORACLE_OFF, ORACLE_MOLTENI, ORACLE_ANTUONO, ORACLE_FOURTAKAS };
enum oracle_correction { ORACLE_PLAIN, ORACLE_ONE_SIDED, ORACLE_MEAN };
enum oracle_alpha { ORACLE_CONSTANT, ORACLE_MORRIS_MONAGHAN, ORACLE_CULLEN_DEHNEN };
enum oracle_laminar { ORACLE_INVISCID, ORACLE_MORRIS, ORACLE_MCG };
/* What is integrated; of a liquid: carried along, heated, not compressed. */
enum oracle_energy {
  ORACLE_DEFAULT, /* u of a gas, nothing of a liquid */
  ORACLE_U,
  ORACLE_TOTAL,
  ORACLE_ENTROPY,
  ORACLE_TEMPERATURE
};

typedef struct oracle {
  int dim;
  enum oracle_kernel kernel;
  real h, dx; /* [m] */
  int periodic[3];
  real length[3]; /* [m] */
  enum oracle_row continuity, pressure;
  enum oracle_correction continuity_corrected, pressure_corrected, laminar_corrected;
  real exponent; /* of the row phi: phi = rho^exponent */
  int summed;    /* density is a sum, not integrated: then continuity is ORACLE_C1 */
  enum oracle_energy energy;
  real alpha, beta; /* artificial viscosity */
  real signal_alpha, signal_beta;
  int balsara; /* switches of these two */
  enum oracle_alpha varied;
  real alpha_min;
  enum oracle_laminar laminar;
  int conduction;
  real epsilon; /* XSPH */
  int drag;     /* K = drag_K + drag_rate rho_dust */
  real drag_K, drag_rate;
  real second_moment; /* a result: int q^2 W dV at h = 1 */
  real conductivity;  /* alpha_u */
  enum oracle_delta diffusion;
  real delta;
  real g[3];  /* [m/s^2] */
  real omega; /* [1/s] */
  int groups;
  oracle_group group[ORACLE_GROUPS];
  long n;
  oracle_particle *particle; /* [n] */
} oracle;

/* Fills in all results. */
void oracle_evaluate(oracle *o);

/* W(r, h) and F = (dW/dr)/r of the oracle's kernel. */
real oracle_w(const oracle *o, real r);
real oracle_f(const oracle *o, real r);

#endif
