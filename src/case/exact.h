/* exact.h -- exact solutions: what runs are compared with, and what tests assert.
 *
 * Each takes a struct of its parameters by value or const pointer, keeps no state, and answers bad
 * parameters with SPH_ERR_ARGUMENT and a text. */
#ifndef SPH_EXACT_H
#define SPH_EXACT_H
#include "sphode/base.h"
#include "sphode/eos.h"

/* --- Riemann problem of an ideal gas in 1D: two states meet at x = 0, t = 0 --- */

typedef struct sph_exact_gas {
  double rho, u, p; /* density [kg/m^3], velocity [m/s], pressure [Pa] */
} sph_exact_gas;

typedef struct sph_exact_riemann {
  double gamma;              /* > 1 */
  sph_exact_gas left, right; /* rho > 0, p > 0 */
  /* Filled in by sph_exact_riemann_solve: */
  double p, u;                 /* between the waves [Pa], [m/s] */
  double rho_left, rho_right;  /* on both sides of the contact [kg/m^3] */
  double left_head, left_tail; /* speeds of the left wave [m/s]; a shock: equal */
  double right_tail, right_head;
} sph_exact_riemann;

int sph_exact_riemann_solve(sph_exact_riemann *riemann, sph_error *error);

/* The state at x/t [m/s] of a solved one. */
sph_exact_gas sph_exact_riemann_at(const sph_exact_riemann *riemann, double x_over_t);

/* --- Oscillating drop in 2D: an ellipse of liquid under the force -omega^2 r per mass --- */

typedef struct sph_exact_drop {
  double radius; /* of the circle at t = 0 [m], > 0 */
  double rate;   /* v = (rate x, -rate y) at t = 0 [1/s] */
  double omega;  /* of the force [1/s], >= 0; 0: free drop */
} sph_exact_drop;

typedef struct sph_exact_ellipse {
  double a, b; /* semi-axes in x and y [m] */
  double rate; /* v = (rate x, -rate y) [1/s] */
  double p0;   /* pressure in the centre / density [m^2/s^2]: p = rho p0 (1 - x^2/a^2 - y^2/b^2) */
} sph_exact_ellipse;

/* The ellipses[n] at the times t[n] [s], not negative and not falling. */
int sph_exact_drop_at(const sph_exact_drop *drop, long n, const double *t,
                      sph_exact_ellipse *ellipses, sph_error *error);

/* --- Column of liquid at rest: dp/dz = -rho g --- */

typedef struct sph_exact_column {
  sph_eos eos;      /* sph_eos_tait or sph_eos_linear */
  double surface;   /* height of the free surface [m] */
  double p_surface; /* pressure there [Pa] */
  double g;         /* [m/s^2], >= 0 */
} sph_exact_column;

/* Density rho[n] [kg/m^3] and pressure p[n] [Pa] at heights z[n] [m]; above the surface: as there.
 * Either may be NULL. */
int sph_exact_column_at(const sph_exact_column *column, long n, const double *z, double *rho,
                        double *p, sph_error *error);

/* --- Two of them, one above the other: pressure is continuous where they meet --- */

typedef struct sph_exact_layers {
  sph_eos lower, upper; /* sph_eos_tait or sph_eos_linear */
  double meet;          /* height where they meet [m] */
  double surface;       /* height of the upper one's free surface [m], >= meet */
  double p_surface;     /* pressure there [Pa] */
  double g;             /* [m/s^2], >= 0 */
} sph_exact_layers;

/* The column of one of the layers (upper: 0 or 1), for sph_exact_column_at. */
int sph_exact_layers_column(const sph_exact_layers *layers, int upper, sph_exact_column *column,
                            sph_error *error);

/* --- Channel: a liquid at rest between walls at y = 0 and y = width; at t = 0 the upper wall
 * begins to move (Couette), a force along the walls to act (Poiseuille), or both --- */

typedef struct sph_exact_channel {
  double width; /* [m], > 0 */
  double nu;    /* kinematic viscosity [m^2/s], > 0 */
  double speed; /* of the upper wall [m/s] */
  double force; /* along the walls, per mass [m/s^2] */
} sph_exact_channel;

/* Velocity v[n] [m/s] along the walls at y[n] [m] at time t >= 0 [s]; outside: that of the wall. */
int sph_exact_channel_at(const sph_exact_channel *channel, double t, long n, const double *y,
                         double *v, sph_error *error);

/* --- Heat conduction at rest: a mode in one medium; two media that meet --- */

typedef struct sph_exact_medium {
  double temperature;  /* at the start [K] */
  double conductivity; /* [W/m/K], > 0 */
  double capacity;     /* density times specific heat [J/m^3/K], > 0 */
} sph_exact_medium;

typedef struct sph_exact_heat_mode {
  sph_exact_medium medium; /* its temperature: the mean */
  double amplitude;        /* at the start [K] */
  double k;                /* wave number [1/m]: T = mean + amplitude sin(k x) */
} sph_exact_heat_mode;

typedef struct sph_exact_heat_step {
  sph_exact_medium left, right; /* x < 0 and x > 0, in touch from t = 0 on */
} sph_exact_heat_step;

/* Temperature T[n] [K] at x[n] [m] at time t >= 0 [s]. */
int sph_exact_heat_mode_at(const sph_exact_heat_mode *mode, double t, long n, const double *x,
                           double *T, sph_error *error);
int sph_exact_heat_step_at(const sph_exact_heat_step *step, double t, long n, const double *x,
                           double *T, sph_error *error);

/* --- Taylor-Green vortices in 2D, in a periodic box of length 2 pi/k --- */

typedef struct sph_exact_taylor_green {
  double speed; /* largest, at t = 0 [m/s] */
  double k;     /* wave number [1/m], > 0 */
  double nu;    /* kinematic viscosity [m^2/s], >= 0 */
  double rho;   /* [kg/m^3], > 0 */
} sph_exact_taylor_green;

typedef struct sph_exact_flow {
  double v[2], p; /* [m/s], [Pa] with mean 0 */
} sph_exact_flow;

sph_exact_flow sph_exact_taylor_green_at(const sph_exact_taylor_green *vortices, double t, double x,
                                         double y);

/* --- A square of liquid that begins to rotate, in 2D --- */

typedef struct sph_exact_square {
  double side;  /* [m], > 0 */
  double omega; /* of the rotation, clockwise [1/s] */
  double rho;   /* [kg/m^3], > 0 */
} sph_exact_square;

/* Pressure [Pa] at (x, y) [m] from the centre, t after the start, while it still is a square; 0
 * outside. */
double sph_exact_square_pressure(const sph_exact_square *square, double t, double x, double y);

/* --- Sound of small amplitude in 1D: linear in the amplitude --- */

typedef struct sph_exact_wave {
  double rho, p, c; /* at rest: density [kg/m^3] > 0, pressure [Pa], sound speed [m/s] > 0 */
  double amplitude; /* of the density, relative */
  double k;         /* wave number [1/m], > 0 */
  int standing;     /* 0: runs along +x */
} sph_exact_wave;

/* Density, velocity, pressure at x [m] and t [s]. */
sph_exact_gas sph_exact_wave_at(const sph_exact_wave *wave, double t, double x);

/* --- A fluid with dust in it: two uniform streams; sound --- */

typedef struct sph_exact_stream {
  double rho, v; /* density [kg/m^3] > 0, velocity at the start [m/s] */
} sph_exact_stream;

typedef struct sph_exact_dusty_box {
  sph_exact_stream fluid, dust;
  double K; /* of the drag [kg/m^3/s], >= 0 */
  double u; /* internal energy of the fluid at the start [J/kg] */
} sph_exact_dusty_box;

typedef struct sph_exact_streams {
  double fluid, dust, u; /* velocities [m/s], internal energy of the fluid [J/kg] */
} sph_exact_streams;

int sph_exact_dusty_box_at(const sph_exact_dusty_box *box, double t, sph_exact_streams *streams,
                           sph_error *error);

typedef struct sph_exact_dusty_wave {
  double rho_fluid, rho_dust; /* at rest [kg/m^3], > 0 */
  double c;                   /* sound speed of the fluid alone [m/s], > 0 */
  double K;                   /* of the drag [kg/m^3/s], >= 0 */
  double amplitude;           /* of both densities at the start, relative */
  double k;                   /* wave number [1/m], > 0 */
} sph_exact_dusty_wave;

/* Density rho[n] [kg/m^3] and velocity v[n] [m/s] of the fluid, or of the dust, at x[n] [m] at time
 * t >= 0 [s]; either may be NULL. */
int sph_exact_dusty_wave_at(const sph_exact_dusty_wave *wave, double t, int dust, long n,
                            const double *x, double *rho, double *v, sph_error *error);

#endif
