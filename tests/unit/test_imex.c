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
  double stiffness;  /* [1/s] */
  int first;         /* entries from here on g changes */
  int at_guess;      /* the others are taken from the guess: wrong */
  double sloppiness; /* error of a solution, of the tolerance */
  int changing;      /* its sign changes at random */
  unsigned random;
  long solves, fail_from, fail_count; /* solves number fail_from .. + fail_count - 1 fail */
  int fail_status;
  double tolerance; /* of the last solve */
  int stages;       /* implicit ones a step */
  double gap[2];    /* largest distance from guess to solution, of first stages and of others */
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
  if (s->fail_count && k >= 0 && k < s->fail_count)
    return s->fail_status < 0 ? sph_error_set(&s->o.error, s->fail_status, "the matrix is odd")
                              : s->fail_status;
  for (int i = 0; i < DIM; i++) {
    known[i] = given[at[i]];
    guess[i] = i < s->first && !s->at_guess ? known[i] : z[at[i]];
  }
  newton(s, stage, known, guess);
  for (int i = s->first; i < DIM && s->stages; i++) {
    double *gap = &s->gap[(s->solves - 1) % s->stages > 0];
    *gap = fmax(*gap, fabs(guess[i] - z[at[i]]));
  }
  for (int i = 0; i < DIM; i++) z[at[i]] = i < s->first ? known[i] : guess[i];
  s->random = s->random * 1664525u + 1013904223u;
  double error = s->changing && s->random >> 31 ? -s->sloppiness : s->sloppiness;
  for (int i = s->first; i < DIM; i++) /* weights are 1, the norm is the rms of all entries */
    z[at[i]] += error * stage->tolerance * sqrt((double)DIM / (DIM - s->first));
  stage->iterations += 3;
  s->tolerance = stage->tolerance;
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

/* Prothero & Robinson (1974): u, v, q are pulled to the known solution. */
static void g_pull(const split *s, double t, const double y[DIM], double rate[DIM])
{
  double e[ODE_LENGTH];
  s->o.exact(t, e);
  for (int k = 0; k < DIM; k++) rate[k] = k < FIRST_RATE ? 0 : -s->stiffness * (y[k] - e[at[k]]);
}

/* g is added to f: the same solution, now stiff, with f_E the f of before. */
static int pulled(double t, N_Vector state, N_Vector rate, void *ctx)
{
  split *s = ctx;
  double y[DIM], g[DIM];
  int status = s->whole(t, state, rate, ctx);
  for (int k = 0; k < DIM; k++) y[k] = sph_nvector_data(state)[at[k]];
  s->g(s, t, y, g);
  for (int k = 0; k < DIM; k++) sph_nvector_data(rate)[at[k]] += g[k];
  return status;
}

static int pulled_piece(int which, double t, N_Vector y, N_Vector rate, void *ctx)
{
  split *s = ctx;
  return which == SPH_PIECE_EXPLICIT ? s->whole(t, y, rate, ctx) : piece(which, t, y, rate, ctx);
}

/* Two things that fall together and rub on each other, so that their velocities u and v become one
 * at once: their mean moves as sin t, q as in ode_made. */
static void drag_exact(double t, double *y)
{
  memset(y, 0, ODE_LENGTH * sizeof *y);
  y[ODE_X] = sin(t);
  y[ODE_U] = cos(t) + (t > 0 ? 0 : 0.1);
  y[ODE_V] = cos(t) - (t > 0 ? 0 : 0.1);
  y[ODE_Q] = 2 + sin(2 * t);
}

static void g_drag(const split *s, double t, const double y[DIM], double rate[DIM])
{
  double pull = s->stiffness * (1 + y[0] * y[0]) * (y[2] - y[3]);
  (void)t;
  memset(rate, 0, DIM * sizeof *rate);
  rate[2] = -pull;
  rate[3] = pull;
}

static int drag(double t, N_Vector state, N_Vector rate, void *ctx)
{
  split *s = ctx;
  const double *y = sph_nvector_data(state);
  double *f = sph_nvector_data(rate), packed[DIM], g[DIM];
  double w = (y[ODE_U] + y[ODE_V]) / 2, off = y[ODE_Q] - 2 - sin(2 * t);
  for (int k = 0; k < DIM; k++) packed[k] = y[at[k]];
  s->g(s, t, packed, g);
  N_VConst(0, rate);
  f[ODE_X] = w;
  f[ODE_Q] = 2 * cos(2 * t) - off * (1 + y[ODE_X] * w) + 0.5 * (w - cos(t));
  f[ODE_U] = -y[ODE_X] - 0.3 * (pow(w, 3) - pow(cos(t), 3)) * y[ODE_Q] + 0.5 * off + g[2];
  f[ODE_V] = f[ODE_U] - g[2] + g[3];
  return SPH_OK;
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

/* Also with positions in the implicit part: all of z is unknown to the solver. */
static void make_full(split *s)
{
  make_linear(s);
  s->first = 0;
}

static void make_pulled(split *s, double stiffness)
{
  *s = (split){.g = g_pull, .stiffness = stiffness, .first = FIRST_RATE};
  ode_made(&s->o);
  parts(s);
  s->o.problem.rhs = pulled;
  s->o.problem.rhs_piece = pulled_piece;
}

static void make_mild(split *s) { make_pulled(s, 20); }
static void make_pull(split *s) { make_pulled(s, 1e5); }

static void make_drag(split *s)
{
  *s = (split){.g = g_drag, .stiffness = 1e6, .first = FIRST_RATE};
  ode_made(&s->o);
  s->o.problem.rhs = drag;
  s->o.exact = drag_exact;
  parts(s);
}

static void make_sloppy(split *s)
{
  make_linear(s);
  s->sloppiness = 1;
}

static void make_guessing(split *s)
{
  make_linear(s);
  s->at_guess = 1;
}

enum { STOPS = 8 };
static const double END = 4;

/* Steps to the end; the largest error at eighths of it. */
static double run(split *s, const sph_integrator_def *def)
{
  double most = 0;
  ode_start(&s->o, def);
  for (int k = 1; k <= STOPS; k++) {
    if (ode_run(&s->o, k * END / STOPS)) fail_msg("%s: %s", def->method, s->o.error.text);
    most = fmax(most, ode_error(&s->o, k * END / STOPS, s->o.y));
  }
  return most;
}

static double error_of(problem make, const char *name, int n)
{
  split s;
  make(&s);
  double error = run(&s, &(sph_integrator_def){.method = name, .dt_fixed = END / STOPS / n});
  ode_end(&s.o);
  return error;
}

/* With n steps between the stops, doubled until n_max or until the error is below `least`: of the
 * last two slopes the better. */
static double order_of(problem make, const char *name, int n, int n_max, double least)
{
  double error = error_of(make, name, n), slope[2] = {0, 0};
  for (n *= 2; n <= n_max && error > least; n *= 2) {
    double finer = error_of(make, name, n);
    slope[0] = slope[1];
    slope[1] = log2(error / finer);
    error = finer;
  }
  return fmax(slope[0], slope[1]);
}

/* Row k or a later one that wants an implicit part, and the number behind it; 0: none. */
static int next_pair(int k, sph_integrator_info *info)
{
  while (sph_integrator_info_get(k, info))
    if (k++, info->wants & SPH_WANTS_IMPLICIT) return k;
  return 0;
}

/* Smooth equations, split with and without positions in the implicit part; relaxation with
 * stiffness h from 5 to 0.04; and with 1e6 h, where what is stiff is not forced. */
static void every_pair_has_its_order(void **state)
{
  static const struct {
    const char *name;
    problem make;
  } row[] = {{"linear", make_linear},
             {"full", make_full},
             {"nonlinear", make_nonlinear},
             {"mild", make_mild},
             {"drag", make_drag}};
  sph_integrator_info info;
  int pairs = 0;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info)); pairs++)
    for (size_t p = 0; p < sizeof row / sizeof *row; p++) {
      double order = order_of(row[p].make, info.name, 2, 256, 3e-11);
      print_message("# %s, %s: order %.2f\n", info.name, row[p].name, order);
      if (!(order >= info.order - 0.1))
        fail_msg("%s, %s: order %.2f", info.name, row[p].name, order);
    }
  assert_true(pairs >= 5);
}

/* Forced and stiff (1e5 h > 800): what is stiff has the order of the stages, two by their
 * diagonally implicit part and less what the explicit one lacks.  Classical: Kennedy & Carpenter
 * (2003), section 5; no table of ARKODE is free of it. */
static void forced_stiffness_reduces_the_order(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));) {
    double order = order_of(make_pull, info.name, 2, 16, 0), least = info.order > 3 ? 2.4 : 1.9;
    print_message("# %s, pulled: order %.2f\n", info.name, order);
    if (!(order >= least)) fail_msg("%s, pulled: order %.2f", info.name, order);
  }
}

/* Steps by error control: error ~ tolerance ~ steps^-order, the same with a solver that is as wrong
 * as it may be. */
static void error_control_has_the_order(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));)
    for (int sloppy = 0; sloppy < 2; sloppy++) {
      double error[2], steps[2];
      for (int i = 0; i < 2; i++) {
        split s;
        const double tolerance = i ? 1e-8 : 1e-5;
        (sloppy ? make_sloppy : make_linear)(&s);
        s.changing = 1;
        error[i] = run(&s, &(sph_integrator_def){.method = info.name, .tolerance = tolerance});
        steps[i] = (double)sph_integrator_stats(s.o.it)->steps;
        if (!(error[i] < 40 * tolerance)) fail_msg("%s: error %.2e", info.name, error[i]);
        assert_true(fabs(s.tolerance / (1e-2 * tolerance) - 1) < 1e-12);
        ode_end(&s.o);
      }
      double order = log(error[0] / error[1]) / log(steps[1] / steps[0]);
      print_message("# %s, error control: order %.2f, %g and %g steps\n", info.name, order,
                    steps[0], steps[1]);
      if (!(order >= info.order - 0.1)) fail_msg("%s: order %.2f", info.name, order);
    }
}

/* Without error control a stage may be wrong by 1e-8 of the scales.  b_i/gamma <= 8 of that goes
 * into y at once; always in the same direction, as here, it adds up. */
static void sloppy_stages_add_little(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));)
    for (int n = 8; n <= 64; n *= 8) {
      double more = error_of(make_sloppy, info.name, n) - error_of(make_linear, info.name, n);
      double step = fabs(more) / (STOPS * n);
      print_message("# %s, sloppy: %.1e a step\n", info.name, step);
      if (!(step > 1e-11 && step < 8e-8)) fail_msg("%s: %.1e a step", info.name, step);
    }
}

/* f_I reads positions and leaves them alone: those of a stage are known exactly before it is
 * solved, and solving for the rest is solving for all.  With positions that are guessed the order
 * is lost. */
static void stages_are_solved_at_their_positions(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));) {
    const sph_integrator_def def = {.method = info.name, .dt_fixed = 0.05};
    split s[2];
    make_linear(&s[0]);
    make_full(&s[1]);
    for (int i = 0; i < 2; i++) run(&s[i], &def);
    N_VLinearSum(1, s[0].o.y, -1, s[1].o.y, s[1].o.y);
    assert_true(N_VMaxNorm(s[1].o.y) < 1e-13);
    for (int i = 0; i < 2; i++) ode_end(&s[i].o);
    if (info.order > 2) assert_true(order_of(make_guessing, info.name, 16, 64, 0) < 2.2);
  }
}

/* A guess is the state at the start of the step in its first stage, off by O(h), then on a line
 * through the last stage, off by O(h^2). */
static void stages_are_guessed_from_the_last(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));) {
    double order[2];
    split s[2];
    for (int i = 0; i < 2; i++) {
      make_linear(&s[i]);
      s[i].stages = info.stages - 1;
      run(&s[i], &(sph_integrator_def){.method = info.name, .dt_fixed = i ? 0.005 : 0.01});
      ode_end(&s[i].o);
    }
    for (int j = 0; j < 2; j++) order[j] = log2(s[0].gap[j] / s[1].gap[j]);
    print_message("# %s: guesses %.2f, %.2f\n", info.name, order[0], order[1]);
    assert_true(fabs(order[0] - 1) < 0.1 && fabs(order[1] - 2) < 0.1);
  }
}

static void dense_output_is_of_order_three(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));) {
    double most[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
      split s;
      make_linear(&s);
      ode_start(&s.o, &(sph_integrator_def){.method = info.name, .dt_fixed = i ? 0.0125 : 0.025});
      N_Vector inside = sph_nvector_clone(s.o.y, "a state", &s.o.error);
      while (sph_integrator_time(s.o.it) < 2) {
        assert_int_equal(sph_integrator_step(s.o.it, 2), SPH_OK);
        double t0 = sph_integrator_previous(s.o.it), t1 = sph_integrator_time(s.o.it);
        for (int j = 0; j <= 4; j++) {
          double t = t0 + j * (t1 - t0) / 4;
          assert_int_equal(sph_integrator_interpolate(s.o.it, t, inside), SPH_OK);
          most[i] = fmax(most[i], ode_error(&s.o, t, inside));
        }
      }
      N_VDestroy(inside);
      ode_end(&s.o);
    }
    double order = log2(most[0] / most[1]), least = info.order > 3 ? 3.9 : info.order - 0.1;
    print_message("# %s: dense order %.2f\n", info.name, order);
    if (!(order >= least)) fail_msg("%s: dense order %.2f", info.name, order);
  }
}

static void work_is_counted(void **state)
{
  sph_integrator_info info;
  (void)state;
  for (int k = 0; (k = next_pair(k, &info));) {
    split s;
    make_linear(&s);
    ode_start(&s.o, &(sph_integrator_def){.method = info.name, .dt_fixed = 0.01});
    assert_int_equal(ode_run(&s.o, 1), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(s.o.it);
    assert_int_equal(stats->steps, 100);
    assert_in_range(stats->rhs_evaluations, 100 * info.stages, 100 * info.stages + 2);
    assert_in_range(stats->implicit_evaluations, 100, 102);
    assert_int_equal(stats->solves, 100 * (info.stages - 1));
    assert_int_equal(stats->solves, s.solves);
    assert_int_equal(stats->solve_iterations, 3 * s.solves);
    assert_true(s.tolerance == 1e-8);
    ode_end(&s.o);
  }
}

/* What does not depend on the formulas is shown with one pair, with error control and without. */
static const char *const one = "imex:ark324l2sa-4-2-3";
static const double S = 2.54; /* its stability limit */

static void limits_bind(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    split s;
    int cfl = k / 2;
    make_linear(&s);
    s.o.limit[SPH_BOUND_CFL] = 0.02;
    s.o.limit[SPH_BOUND_FORCE] = cfl ? 1 : 0.003;
    ode_start(&s.o, &(sph_integrator_def){.method = one, .cfl = 0.9, .tolerance = k % 2 ? -1 : 0});
    assert_int_equal(ode_run(&s.o, 2), SPH_OK);
    assert_true(sph_integrator_time(s.o.it) == 2);
    const sph_step_stats *stats = sph_integrator_stats(s.o.it);
    double expected = cfl ? 0.9 * S * 0.02 : 0.003;
    assert_true(fabs(stats->dt_largest / expected - 1) < 1e-9);
    assert_true(stats->bound_by[cfl ? SPH_BOUND_CFL : SPH_BOUND_FORCE] >= stats->steps - 1);
    assert_true(ode_error(&s.o, 2, s.o.y) < 1e-3);
    ode_end(&s.o);
  }
}

/* A stage that cannot be solved, or an explicit part that cannot be had, costs one retry. */
static void what_fails_is_repeated(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    split s;
    make_linear(&s);
    s.o.limit[SPH_BOUND_CFL] = 0.01;
    if (k / 2)
      s.fail_from = 41, s.fail_count = 2;
    else
      s.o.fail_from = 41, s.o.fail_count = 2;
    ode_start(&s.o, &(sph_integrator_def){.method = one, .tolerance = k % 2 ? -1 : 0});
    assert_int_equal(ode_run(&s.o, 2), SPH_OK);
    const sph_step_stats *stats = sph_integrator_stats(s.o.it);
    assert_int_equal(stats->retries, 2);
    assert_true(stats->bound_by[SPH_BOUND_RETRY] >= 1);
    assert_true(fabs(stats->dt_smallest * 4 / stats->dt_largest - 1) < 1e-6);
    assert_true(ode_error(&s.o, 2, s.o.y) < 1e-3);
    ode_end(&s.o);
  }
}

static void lasting_failure_ends_at_the_last_good_state(void **state)
{
  static const struct {
    int status, result, retries;
    const char *text;
  } row[] = {{SPH_RETRY, SPH_ERR_STEP, 5, "after 5 halvings"},
             {SPH_ERR_STATE, SPH_ERR_STATE, 0, "the matrix is odd"}};
  (void)state;
  for (int k = 0; k < 4; k++) {
    split s;
    make_linear(&s);
    s.o.limit[SPH_BOUND_CFL] = 0.01;
    s.fail_from = 60;
    s.fail_count = 1000;
    s.fail_status = row[k / 2].status;
    ode_start(&s.o,
              &(sph_integrator_def){.method = one, .retries = 5, .tolerance = k % 2 ? -1 : 0});
    assert_int_equal(ode_run(&s.o, 2), row[k / 2].result);
    assert_non_null(strstr(s.o.error.text, row[k / 2].text));
    assert_int_equal(sph_integrator_stats(s.o.it)->retries, row[k / 2].retries);
    double t = sph_integrator_time(s.o.it);
    assert_true(t > 0.1 && ode_error(&s.o, t, s.o.y) < 1e-4);
    ode_end(&s.o);
  }
}

static void reset_is_a_new_start(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const sph_integrator_def def = {.method = one, .tolerance = k ? -1 : 1e-5};
    split s, fresh;
    make_linear(&s);
    make_linear(&fresh);
    s.o.limit[SPH_BOUND_CFL] = fresh.o.limit[SPH_BOUND_CFL] = 0.02;
    ode_start(&s.o, &def);
    ode_start(&fresh.o, &def);
    assert_int_equal(ode_run(&s.o, 0.5), SPH_OK);
    s.o.exact(0, sph_nvector_data(s.o.y));
    assert_int_equal(sph_integrator_reset(s.o.it, 0), SPH_OK);
    s.o.time = 0;
    assert_int_equal(ode_run(&s.o, 1), SPH_OK);
    assert_int_equal(ode_run(&fresh.o, 1), SPH_OK);
    assert_memory_equal(sph_nvector_data(s.o.y), sph_nvector_data(fresh.o.y),
                        ODE_LENGTH * sizeof(double));
    ode_end(&s.o);
    ode_end(&fresh.o);
  }
}

static void misuse_is_refused_with_a_reason(void **state)
{
  static const struct {
    sph_integrator_def def;
    const char *text;
  } row[] = {{{.method = "imex:ark324l2sa"},
              "nearest is \"imex:ark324l2sa-4-2-3\", known are imex:"},
             {{.method = "implicit"}, "erk:..., imex:..."},
             {{.method = one, .stage_tolerance = -1}, "stage_tolerance = -1; right is 0 (default)"},
             {{.method = one, .stage_tolerance = NAN}, "stage_tolerance = nan"}};
  (void)state;
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    sph_error error = {0};
    assert_int_equal(sph_integrator_check(&row[k].def, &error), SPH_ERR_ARGUMENT);
    if (!strstr(error.text, row[k].text)) fail_msg("\"%s\" lacks \"%s\"", error.text, row[k].text);
  }
  for (int k = 0; k < 2; k++) { /* no parts, no solver */
    split s;
    make_linear(&s);
    if (k)
      s.o.problem.solve = NULL;
    else
      s.o.problem.rhs_piece = NULL;
    sph_integrator *it = sph_integrator_create(&(sph_integrator_def){.method = one}, &s.o.problem,
                                               0, s.o.y, s.o.context, &s.o.error);
    assert_null(it);
    assert_int_equal(s.o.error.status, SPH_ERR_ARGUMENT);
    assert_non_null(strstr(s.o.error.text, "implicit part of f, and there is none; right is"));
    ode_end(&s.o);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_pair_has_its_order),
      cmocka_unit_test(forced_stiffness_reduces_the_order),
      cmocka_unit_test(error_control_has_the_order),
      cmocka_unit_test(sloppy_stages_add_little),
      cmocka_unit_test(stages_are_solved_at_their_positions),
      cmocka_unit_test(stages_are_guessed_from_the_last),
      cmocka_unit_test(dense_output_is_of_order_three),
      cmocka_unit_test(work_is_counted),
      cmocka_unit_test(limits_bind),
      cmocka_unit_test(what_fails_is_repeated),
      cmocka_unit_test(lasting_failure_ends_at_the_last_good_state),
      cmocka_unit_test(reset_is_a_new_start),
      cmocka_unit_test(misuse_is_refused_with_a_reason),
  };
  return cmocka_run_group_tests_name("imex", tests, NULL, NULL);
}
