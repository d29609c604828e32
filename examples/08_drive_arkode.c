/* 08_drive_arkode -- SUNDIALS in your own hands: ARKODE steps a simulation and finds events in it.
 *
 * Equations  y' = f(t, y), a patch of fluid on a spring, dv/dt = ... - Omega^2 x: its centre swings
 *            as X(t) = X0 cos(Omega t) whatever happens inside, where forces are antisymmetric in
 *            pairs.  An event is a root of g(t, y) = X
 * Reference  D. R. Reynolds, D. J. Gardner, C. S. Woodward & R. Chinomona (2023), ARKODE: a
 *            flexible IVP solver infrastructure for one-step methods, ACM Trans. Math. Softw. 49,
 *            19
 * Run        ./08_drive_arkode
 * See        the times at which the centre passes the origin
 * Check      they are pi/(2 Omega), 3 pi/(2 Omega), 5 pi/(2 Omega) within 1e-5 of a period
 *
 * Where sphode is installed: cc 08_drive_arkode.c $(pkg-config --cflags --libs sphode-sundials) */
#include <arkode/arkode_erkstep.h>
#include <sphode.h>
#include <sphode/sundials.h>
#include <sundials/sundials_config.h>

/* From 7.1 on, what all steppers share is called ARKode..., not ERKStep... */
#if 100 * SUNDIALS_VERSION_MAJOR + SUNDIALS_VERSION_MINOR >= 701
#define ERK(function) ARKode##function
#else
#define ERK(function) ERKStep##function
#endif

static const double X0 = 0.5, omega = 2; /* [m], [1/s] */

static sph_sim *make(void)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.025, .speed = X0 * omega});
  sph_group *patch =
      sph_group_box(sim, "patch", (double[]){X0 - 0.2, -0.2}, (double[]){X0 + 0.2, 0.2}, 1000);
  sph_group_set_eos(patch, sph_eos_tait(1000, 10 * X0 * omega, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_add_term(sim, sph_term_harmonic(omega));
  return sim;
}

/* X of any vector that ARKODE may ask for: in each the arrays lie as in the simulation's own. */
static int centre(sunrealtype t, N_Vector y, sunrealtype *g, void *sim)
{
  const sph_group *patch = sph_sim_group(sim, "patch");
  const double *own = N_VGetArrayPointer(sph_sim_vector(sim));
  const double *x = N_VGetArrayPointer(y) + (sph_group_read(patch, "position", 0) - own);
  long n = sph_group_count(patch);
  (void)t;
  *g = 0;
  for (long i = 0; i < n; i++) *g += x[i] / (double)n;
  return 0;
}

/* Tolerance 1e-4 of the physical scales. */
static int weigh(N_Vector y, N_Vector weight, void *sim)
{
  int status = sph_sim_weights(y, weight, sim);
  N_VScale(1e4, weight, weight);
  return status;
}

/* The simulation's vector belongs to the simulation, and its SUNContext, too. */
static void *make_arkode(sph_sim *sim)
{
  N_Vector y = sph_sim_vector(sim);
  if (!y) return NULL;
  void *arkode = ERKStepCreate(sph_sim_rhs, 0, y, y->sunctx);
  if (arkode && !ERK(SetUserData)(arkode, sim) && !ERK(WFtolerances)(arkode, weigh) &&
      !ERKStepSetTableNum(arkode, ARKODE_BOGACKI_SHAMPINE_4_2_3) &&
      !ERK(SetMaxNumSteps)(arkode, 100000) && !ERK(RootInit)(arkode, 1, centre))
    return arkode;
  if (arkode) ERK(Free)(&arkode);
  return NULL;
}

int main(void)
{
  const double period = 2 * acos(-1) / omega;
  sph_sim *sim = make();
  void *arkode = make_arkode(sim);
  int good = arkode != NULL, found = 0;
  double t = 0;
  while (good && found < 3) {
    int flag = ERK(Evolve)(arkode, 2 * period, sph_sim_vector(sim), &t, ARK_NORMAL);
    double expected = (2 * found + 1) * period / 4;
    good = flag == ARK_ROOT_RETURN && fabs(t - expected) < 1e-5 * period;
    printf("t = %.7f s: X = 0, expected at %.7f s\n", t, expected);
    found++;
  }
  if (!good) fprintf(stderr, "08_drive_arkode: %s\n", sph_sim_error(sim));
  if (arkode) ERK(Free)(&arkode);
  sph_sim_free(sim);
  return !good;
}
