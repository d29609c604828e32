/* ode.h -- differential equations with known solutions, as problems for the integrators. */
#ifndef TESTS_ODE_H
#define TESTS_ODE_H
#include "integrator.h"
#include "nvector.h"

/* Five segments of one entry, 8 doubles apart. */
enum { ODE_X = 0, ODE_Y = 8, ODE_U = 16, ODE_V = 24, ODE_Q = 32, ODE_LENGTH = 40 };

typedef struct ode {
  sph_segment segment[5];
  sph_layout layout;
  SUNContext context;
  N_Vector y;
  sph_error error;
  sph_problem problem;
  sph_integrator *it;
  void (*exact)(double t, double *y);
  /* what goes wrong, and what limits */
  long calls, fail_from, fail_count; /* evaluations number fail_from .. + fail_count - 1 fail */
  int fail_status;
  double reject_above;           /* a step longer than this is not admissible [s]; 0: any is */
  double time;                   /* of the last accepted state */
  double limit[SPH_BOUND_COUNT]; /* 0: none */
  double breathe;                /* limits vary: 1 + breathe sin t times as large */
} ode;

/* Ellipse of eccentricity 0.3 around the origin, period 2 pi: exact after whole periods. */
void ode_kepler(ode *o);
/* x'' with forces of velocity and of q, made so that x = sin t, y = cos t, q = 2 + sin 2t. */
void ode_made(ode *o);
/* The same x, y, q with other velocities: dr/dt = v + d(t, r, v, q); q is no density here. */
void ode_drift(ode *o);
/* x = cos t, q = 1, all else but the velocity of x zero. */
void ode_oscillator(ode *o);
/* q = exp(-t), all else zero. */
void ode_decay(ode *o);
/* Creates the integrator at t = 0; fails the test if it cannot. */
void ode_start(ode *o, const sph_integrator_def *def);
/* Steps to t; returns the status. */
int ode_run(ode *o, double t);
void ode_end(ode *o);
/* Largest difference to the exact solution at t. */
double ode_error(const ode *o, double t, N_Vector y);

#endif
