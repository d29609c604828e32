/* Implicit-explicit integrators on split equations with known solutions: order, stages solved at
 * exact positions, solvers that fail or are sloppy, limits, dense output, refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "ode.h"

/* Entries by number: x, y, u, v, q. */
enum { DIM = 5, FIRST_RATE = 2 };
static const int at[DIM] = {ODE_X, ODE_Y, ODE_U, ODE_V, ODE_Q};

/* An equation of ode.h in two parts: f_I = g(t, y), f_E = f - g. */
typedef struct split {
  ode o; /* first: the ctx of its problem */
  int (*whole)(double t, N_Vector y, N_Vector ydot, void *ctx);
  void (*g)(const struct split *s, double t, const double y[DIM], double rate[DIM]);
  double stiffness;                   /* [1/s] */
  int first;                          /* entries from here on g changes */
  int at_guess;                       /* the others are taken from the guess: wrong */
  double sloppiness;                  /* error of a solution, of the tolerance */
  long solves, fail_from, fail_count; /* solves number fail_from .. + fail_count - 1 fail */
  int fail_status;
  double tolerance, gamma, t; /* of the last solve */
} split;

static int piece(int which, double t, N_Vector state, N_Vector rate, void *ctx)
{
  split *s = ctx;
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate), packed[DIM], g[DIM];
  int status = SPH_OK;
  for (int k = 0; k < DIM; k++) packed[k] = y[at[k]];
  s->g(s, t, packed, g);
  N_VConst(0, rate);
  if (which == SPH_PIECE_EXPLICIT) status = s->whole(t, state, rate, &s->o);
  for (int k = 0; k < DIM; k++) f[at[k]] += which == SPH_PIECE_EXPLICIT ? -g[k] : g[k];
  return status;
}

/* x of A x = b, n <= DIM, by elimination with pivots; b becomes x. */
static void eliminate(int n, double A[DIM][DIM], double b[DIM])
{
  for (int c = 0; c < n; c++) {
    int p = c;
    for (int r = c + 1; r < n; r++) p = fabs(A[r][c]) > fabs(A[p][c]) ? r : p;
    for (int k = 0; k < n; k++) {
      double swap = A[c][k];
      A[c][k] = A[p][k];
      A[p][k] = swap;
    }
    double swap = b[c];
    b[c] = b[p];
    b[p] = swap;
    for (int r = 0; r < n; r++) {
      double factor = r == c ? 0 : A[r][c] / A[c][c];
      for (int k = 0; k < n; k++) A[r][k] -= factor * A[c][k];
      b[r] -= factor * b[c];
    }
  }
  for (int c = 0; c < n; c++) b[c] /= A[c][c];
}

/* Newton's method for z = known + gamma g(t, z) in the entries from s->first on. */
static void newton(const split *s, const sph_stage *stage, const double known[DIM], double z[DIM])
{
  for (int iteration = 0; iteration < 30; iteration++) {
    double A[DIM][DIM], b[DIM], g[DIM], more[DIM], change = 0;
    int n = DIM - s->first;
    s->g(s, stage->t, z, g);
    for (int c = 0; c < n; c++) {
      double h = 1e-6, kept = z[s->first + c];
      z[s->first + c] = kept + h;
      s->g(s, stage->t, z, more);
      z[s->first + c] = kept;
      for (int r = 0; r < n; r++)
        A[r][c] = (r == c) - stage->gamma * (more[s->first + r] - g[s->first + r]) / h;
    }
    for (int r = 0; r < n; r++) {
      int k = s->first + r;
      b[r] = known[k] + stage->gamma * g[k] - z[k];
    }
    eliminate(n, A, b);
    for (int r = 0; r < n; r++) {
      z[s->first + r] += b[r];
      change = fmax(change, fabs(b[r]));
    }
    if (change < 1e-14) return;
  }
}

static int solve(sph_stage *stage, void *ctx)
{
  split *s = ctx;
  long k = s->solves++ - s->fail_from;
  const double *given = sph_nvector_data(stage->known);
  double *z = sph_nvector_data(stage->z), known[DIM], guess[DIM];
  if (s->fail_count && k >= 0 && k < s->fail_count) return s->fail_status;
  for (int i = 0; i < DIM; i++) {
    known[i] = given[at[i]];
    guess[i] = i < s->first && !s->at_guess ? known[i] : z[at[i]];
  }
  newton(s, stage, known, guess);
  for (int i = 0; i < DIM; i++) z[at[i]] = i < s->first ? known[i] : guess[i];
  for (int i = s->first; i < DIM; i++) /* all of it in one entry; weights are 1 */
    if (i == s->first + s->solves % (DIM - s->first))
      z[at[i]] += s->sloppiness * stage->tolerance * sqrt(DIM) * (s->solves % 2 ? 1 : -1);
  stage->iterations += 3;
  s->tolerance = stage->tolerance;
  s->gamma = stage->gamma;
  s->t = stage->t;
  return SPH_OK;
}

/* Linear in u, v, q once x, y are given, which it leaves alone. */
static void g_linear(const split *s, double t, const double y[DIM], double rate[DIM])
{
  double a = s->stiffness * (1 + y[0] * y[0] + 0.5 * y[1]);
  (void)t;
  rate[0] = rate[1] = 0;
  rate[2] = -a * y[2] + 0.5 * y[0] * y[3] - 0.2 * y[1] * y[4];
  rate[3] = -a * y[3] + 0.3 * a * y[2] + 0.4 * y[1];
  rate[4] = -(1 + y[1] * y[1]) * y[4] + y[0] * y[2];
}

/* Anything. */
static void g_nonlinear(const split *s, double t, const double y[DIM], double rate[DIM])
{
  rate[0] = -0.5 * y[0] * y[4];
  rate[1] = 0.3 * sin(y[1]) * y[2];
  rate[2] = -s->stiffness * pow(y[2], 3) + 0.2 * cos(t) * y[0];
  rate[3] = -0.5 * y[3] * y[4];
  rate[4] = 0.3 * (y[0] * y[1] - y[4] * y[4]);
}

/* Pulls u, v, q to the known solution. */
static void g_relaxation(const split *s, double t, const double y[DIM], double rate[DIM])
{
  double e[ODE_LENGTH];
  s->o.exact(t, e);
  for (int k = 0; k < DIM; k++) rate[k] = k < FIRST_RATE ? 0 : -s->stiffness * (y[k] - e[at[k]]);
}

/* f + g: the same solution, now stiff. */
static int relaxed(double t, N_Vector state, N_Vector rate, void *ctx)
{
  split *s = ctx;
  double y[DIM], g[DIM];
  int status = s->whole(t, state, rate, ctx);
  for (int k = 0; k < DIM; k++) y[k] = sph_nvector_data(state)[at[k]];
  s->g(s, t, y, g);
  for (int k = 0; k < DIM; k++) sph_nvector_data(rate)[at[k]] += g[k];
  return status;
}

static int relaxed_piece(int which, double t, N_Vector y, N_Vector rate, void *ctx)
{
  split *s = ctx;
  return which == SPH_PIECE_EXPLICIT ? s->whole(t, y, rate, ctx) : piece(which, t, y, rate, ctx);
}

typedef void (*problem)(split *s);

static void parts(split *s)
{
  s->whole = s->o.problem.rhs;
  s->o.problem.rhs_piece = piece;
  s->o.problem.solve = solve;
  s->fail_status = SPH_RETRY;
}

static void make_linear(split *s)
{
  *s = (split){.g = g_linear, .stiffness = 1, .first = FIRST_RATE};
  ode_made(&s->o);
  parts(s);
}

static void make_nonlinear(split *s)
{
  *s = (split){.g = g_nonlinear, .stiffness = 0.5};
  ode_made(&s->o);
  parts(s);
}

static void make_relaxed(split *s, double stiffness)
{
  *s = (split){.g = g_relaxation, .stiffness = stiffness, .first = FIRST_RATE};
  ode_made(&s->o);
  parts(s);
  s->o.problem.rhs = relaxed;
  s->o.problem.rhs_piece = relaxed_piece;
}

static void make_mild(split *s) { make_relaxed(s, 20); }

static double error_of(problem make, const sph_integrator_def *def, int n)
{
  const double t_end = 4, stops = 8;
  sph_integrator_def fixed = *def;
  split s;
  double most = 0;
  make(&s);
  fixed.dt_fixed = t_end / (stops * n);
  ode_start(&s.o, &fixed);
  for (int k = 1; k <= stops; k++) {
    if (ode_run(&s.o, k * t_end / stops)) fail_msg("%s: %s", def->method, s.o.error.text);
    most = fmax(most, ode_error(&s.o, k * t_end / stops, s.o.y));
  }
  ode_end(&s.o);
  return most;
}

/* Of the last two slopes before rounding or n_max the better. */
static double order_of(problem make, const sph_integrator_def *def, int n_min, int n_max)
{
  double error = error_of(make, def, n_min), slope[2] = {0, 0};
  for (int n = 2 * n_min; n <= n_max; n *= 2) {
    double finer = error_of(make, def, n);
    if (finer < 1e-12 && n > 2 * n_min) break;
    slope[0] = slope[1];
    slope[1] = log2(error / finer);
    error = finer;
  }
  return fmax(slope[0], slope[1]);
}

static int pair(int k, sph_integrator_info *info)
{
  while (sph_integrator_info_get(k, info))
    if (info->wants & SPH_WANTS_IMPLICIT)
      return k + 1;
    else
      k++;
  return 0;
}

static void every_pair_has_its_order(void **state)
{
  static const problem make[] = {make_linear, make_nonlinear, make_mild};
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = pair(k, &info));)
    for (int p = 0; p < 3; p++) {
      double order = order_of(make[p], &(sph_integrator_def){.method = info.name}, 2, 256);
      if (!(order >= info.order - 0.1)) fail_msg("%s, problem %d: order %.2f", info.name, p, order);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_pair_has_its_order)};
  return cmocka_run_group_tests_name("imex", tests, NULL, NULL);
}
