/* 08_drive_cvode -- CVODE steps a simulation: backward differentiation, matrix-free Newton-Krylov.
 *
 * Equations  y' = f(t, y): honey under a force a = F sin(k y) along x, which viscosity soon
 *            balances: v = F/(nu k^2) (1 - exp(-nu k^2 t)) sin(k y).  Explicit steps are bound by
 *            h^2/nu until the end; those of BDF grow as the flow gets steady
 * Reference  A. C. Hindmarsh, P. N. Brown, K. E. Grant, S. L. Lee, R. Serban, D. E. Shumaker &
 *            C. S. Woodward (2005), SUNDIALS, ACM Trans. Math. Softw. 31, 363
 * Run        ./08_drive_cvode
 * See        the amplitude of the flow, and evaluations of f beside those of an explicit run
 * Check      the amplitude is the exact one within 2 % of the steady one, which is what 24
 *            particles in a wave give; evaluations and products with the Jacobian are a tenth of
 *            the evaluations of an explicit run, or less
 *
 * Where sphode is installed: cc 08_drive_cvode.c $(pkg-config --cflags --libs sphode-sundials)
 * -lsundials_cvode -lsundials_sunlinsolspgmr -lm */
#include <cvode/cvode.h>
#include <math.h>
#include <sphode.h>
#include <sphode/sundials.h>
#include <stdio.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_spgmr.h>

static const double L = 1, nu = 1, V = 0.1, k = 6.283185307179586; /* [m], [m^2/s], [m/s], [1/m] */

static int push(const sph_term *term, const sph_particles *s)
{
  (void)term;
  for (long i = 0; i < s->n; i++) s->a[0][i] += nu * k * k * V * sin(k * s->x[1][i]);
  return 0;
}

static sph_sim *make(void)
{
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = L / 24, .periodic = {1, 1}, .length = {L, L}, .speed = V});
  sph_group *honey = sph_group_box(sim, "honey", (double[]){0, 0}, (double[]){L, L}, 1400);
  sph_group_set_eos(honey, sph_eos_tait(1400, 10 * V, 7));
  sph_group_set_viscosity(honey, 1400 * nu);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, (sph_term){.name = "push", .body = push});
  return sim;
}

/* Twice the mean of v sin(k y). */
static double amplitude(const sph_sim *sim)
{
  const sph_group *honey = sph_sim_group(sim, "honey");
  const double *y = sph_group_read(honey, "position", 1), *v = sph_group_read(honey, "velocity", 0);
  long n = sph_group_count(honey);
  double sum = 0;
  for (long i = 0; v && i < n; i++) sum += 2 * v[i] * sin(k * y[i]) / (double)n;
  return sum;
}

/* Tolerance 1e-4 of the physical scales. */
static int weigh(N_Vector y, N_Vector weight, void *sim)
{
  int status = sph_sim_weights(y, weight, sim);
  N_VScale(1e4, weight, weight);
  return status;
}

/* Newton's equations are solved by GMRES, which needs products with the Jacobian only; without
 * CVodeSetJacTimes these would be differences of f. */
static void *make_cvode(sph_sim *sim, SUNLinearSolver *solver)
{
  N_Vector y = sph_sim_vector(sim);
  if (!y) return NULL;
  void *cvode = CVodeCreate(CV_BDF, y->sunctx);
  *solver = SUNLinSol_SPGMR(y, SUN_PREC_NONE, 20, y->sunctx);
  if (cvode && *solver && !CVodeInit(cvode, sph_sim_rhs, 0, y) && !CVodeSetUserData(cvode, sim) &&
      !CVodeWFtolerances(cvode, weigh) && !CVodeSetLinearSolver(cvode, *solver, NULL) &&
      !CVodeSetJacTimes(cvode, NULL, sph_sim_jacobian_times) && !CVodeSetMaxNumSteps(cvode, 10000))
    return cvode;
  if (cvode) CVodeFree(&cvode);
  return NULL;
}

static int follow(sph_sim *sim, void *cvode)
{
  const double tau = 1 / (nu * k * k);
  const double at[] = {0.5, 1, 2, 4, 10, 20};
  int good = 1;
  for (int j = 0; good && j < 6; j++) {
    double t = 0;
    good = CVode(cvode, at[j] * tau, sph_sim_vector(sim), &t, CV_NORMAL) == CV_SUCCESS;
    double a = amplitude(sim) / V, exact = 1 - exp(-t / tau);
    printf("t = %5.2f tau: amplitude %.4f V, exact %.4f V\n", t / tau, a, exact);
    good = good && fabs(a - exact) < 0.02;
  }
  return good;
}

/* Evaluations of an explicit run to the same end. */
static long explicit_run(double t_end)
{
  sph_sim_stats stats;
  sph_sim *sim = make();
  int status = sph_sim_run(sim, t_end);
  sph_sim_get_stats(sim, &stats);
  printf("explicit: amplitude %.4f V\n", amplitude(sim) / V);
  sph_sim_free(sim);
  return status ? 0 : stats.step.rhs_evaluations;
}

int main(void)
{
  sph_sim *sim = make();
  SUNLinearSolver solver = NULL;
  void *cvode = make_cvode(sim, &solver);
  int good = cvode && follow(sim, cvode);
  long steps = 0, evaluations = 0, products = 0;
  if (cvode) {
    CVodeGetNumSteps(cvode, &steps);
    CVodeGetNumRhsEvals(cvode, &evaluations);
    CVodeGetNumJtimesEvals(cvode, &products);
    CVodeFree(&cvode);
  }
  long needed = explicit_run(20 / (nu * k * k));
  printf("CVODE: %ld steps, %ld evaluations, %ld products with the Jacobian\n", steps, evaluations,
         products);
  printf("explicit: %ld evaluations\n", needed);
  good = good && 10 * (evaluations + products) < needed;
  if (!good) fprintf(stderr, "08_drive_cvode: %s\n", sph_sim_error(sim));
  if (solver) SUNLinSolFree(solver);
  sph_sim_free(sim);
  return !good;
}
