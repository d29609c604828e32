/* The order of the integrators on particles: a periodic box of weakly compressible fluid, vortices
 * and sound of finite amplitude, with smooth terms only (continuity, pressure) and a kernel that is
 * smooth enough, Wendland C6: forces have five continuous derivatives in the positions.
 *
 * Against a run of order eight with far smaller steps: error(dt) ~ dt^order.  For tables of order
 * five and more the smoothness of the kernel and rounding are the limit, tests/unit/test_butcher.c
 * and test_integrator.c hold these. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "sphode.h"

enum { ACROSS = 16, N = ACROSS * ACROSS, FIELDS = 5 };

static const double c0 = 10, V = 1, T = 0.08, PI = 3.14159265358979323846; /* [m/s], [m/s], [s] */

static void start(sph_group *fluid)
{
  double *x = sph_group_write(fluid, "position", 0), *y = sph_group_write(fluid, "position", 1);
  double *u = sph_group_write(fluid, "velocity", 0), *v = sph_group_write(fluid, "velocity", 1);
  assert_true(x && y && u && v);
  for (int i = 0; i < N; i++) {
    double a = 2 * PI * x[i], b = 2 * PI * y[i];
    u[i] = V * (sin(a) * cos(b) + 0.5 * sin(a + 1));
    v[i] = V * (-cos(a) * sin(b) + 0.3 * cos(2 * b));
    x[i] += 0.05 / ACROSS * sin(3 * a + b); /* off the lattice */
    y[i] += 0.05 / ACROSS * cos(2 * b - a);
  }
}

/* What is there besides continuity and pressure. */
typedef struct setup {
  double epsilon;   /* of XSPH */
  int shaken;       /* by a force that turns about with time */
  const char *fast; /* that is the fast part: "shaking", "waves" (all else); NULL: there is none */
} setup;

static int shake(const sph_term *term, const sph_particles *p)
{
  (void)term;
  for (long i = 0; i < p->n; i++) {
    p->a[0][i] += 300 * sin(200 * p->t + 2 * PI * p->x[1][i]);
    p->a[1][i] += 200 * cos(150 * p->t + 2 * PI * p->x[0][i]) * (1 + 0.2 * p->v[0][i]);
  }
  return SPH_OK;
}

/* Positions, velocities, density after T, in units of their scales. */
static void run(const char *method, const setup *what, int steps, double state[FIELDS][N])
{
  static const char *const field[] = {"position", "position", "velocity", "velocity", "density"};
  const double rho0 = 1000, scale[] = {1.0 / ACROSS, 1.0 / ACROSS, V, V, rho0 * V * V / c0 / c0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = 1.0 / ACROSS,
                                               .kernel = "wendland-c6",
                                               .h_over_dx = 1.8,
                                               .periodic = {1, 1},
                                               .length = {1, 1},
                                               .speed = V});
  sph_group *fluid = sph_group_box(sim, "fluid", (double[]){0, 0}, (double[]){1, 1}, rho0);
  sph_group_set_eos(fluid, sph_eos_tait(rho0, c0, 7));
  start(fluid);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  if (what->epsilon > 0) sph_sim_add_term(sim, sph_term_xsph(what->epsilon));
  if (what->shaken)
    sph_sim_add_term(sim, (sph_term){.name = "shaking", .body = shake, .reads = ""});
  sph_integrator_def def = {.method = method, .dt_fixed = T / steps};
  if (what->fast) {
    def.fast_method = "erk:verner-8-5-6";
    def.fast_step = T / steps / 4;
  }
  if (what->fast && !strcmp(what->fast, "shaking")) sph_sim_set_part(sim, "shaking", "fast");
  if (what->fast && !strcmp(what->fast, "waves")) {
    sph_sim_set_part(sim, "continuity", "fast");
    sph_sim_set_part(sim, "pressure", "fast");
  }
  sph_sim_set_integrator(sim, &def);
  if (sph_sim_run(sim, T)) fail_msg("%s: %s", method, sph_sim_error(sim));
  for (int f = 0; f < FIELDS; f++) {
    const double *a = sph_group_read(fluid, field[f], f % 2 && f < 4);
    for (int i = 0; i < N; i++) state[f][i] = a[i] / scale[f];
  }
  sph_sim_free(sim);
}

static double distance(double a[FIELDS][N], double b[FIELDS][N])
{
  double sum = 0;
  for (int f = 0; f < FIELDS; f++)
    for (int i = 0; i < N; i++) sum += pow(a[f][i] - b[f][i], 2);
  return sqrt(sum / (FIELDS * N));
}

/* Steps of half the stability limit, a quarter, an eighth; verlet-dual has to pass its Euler steps
 * several times, and those of order one to be near their limit of small steps. */
static int first_steps(const sph_integrator_info *info)
{
  const double h = 1.8 / ACROSS;
  int more = info->order == 1 || !strcmp(info->name, "verlet-dual") ? 8 : 1;
  return more * (int)ceil(T / (0.5 * info->stability * h / c0));
}

static void reference(const setup *what, double exact[FIELDS][N])
{
  static double coarser[FIELDS][N];
  const setup whole = {.epsilon = what->epsilon, .shaken = what->shaken};
  run("erk:fehlberg-13-7-8", &whole, 200, exact);
  run("erk:fehlberg-13-7-8", &whole, 100, coarser);
  assert_true(distance(coarser, exact) < 1e-12);
}

static double least = INFINITY; /* order, more than the nominal one */

static void check(const sph_integrator_info *info, const setup *what, double exact[FIELDS][N])
{
  static double found[FIELDS][N];
  double error[4];
  int n = first_steps(info);
  for (int j = 0; j < 4; j++) {
    run(info->name, what, n << j, found);
    error[j] = distance(found, exact);
  }
  double last = log2(error[2] / error[3]), before = log2(error[1] / error[2]);
  print_message("# %-26s order %d: %.2f, %.2f (%d to %d steps, error %.1e to %.1e)\n", info->name,
                info->order, before, last, n, n << 3, error[0], error[3]);
  least = fmin(least, fmax(before, last) - info->order);
  if (!(fmax(before, last) >= info->order - 0.1)) fail_msg("%s: order %.2f", info->name, last);
}

static void every_scheme_has_its_order(void **state)
{
  static double exact[FIELDS][N];
  sph_integrator_info info;
  int checked = 0;
  const setup plain = {0};
  (void)state;
  reference(&plain, exact);
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (info.order > 4 || info.wants) continue;
    check(&info, &plain, exact);
    checked++;
  }
  assert_true(checked >= 17);
}

/* XSPH: dr/dt is not v, which second-order schemes that move positions by v and a must know. */
static void drifting_positions_keep_it(void **state)
{
  static double exact[FIELDS][N];
  sph_integrator_info info;
  int checked = 0;
  const setup drifting = {.epsilon = 0.5};
  (void)state;
  reference(&drifting, exact);
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (!strncmp(info.name, "erk:", 4) || info.wants) continue;
    check(&info, &drifting, exact);
    checked++;
  }
  assert_true(checked >= 7);
}

/* Slow waves with a fast force beside them, and fast waves with a slow one. */
static void couplings_of_parts_keep_it(void **state)
{
  static double exact[FIELDS][N];
  static const char *const fast[] = {"shaking", "waves"};
  sph_integrator_info info;
  int checked = 0;
  (void)state;
  reference(&(setup){.shaken = 1}, exact);
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    for (int f = 0; f < 2; f++) {
      if (info.order > 4 || !(info.wants & SPH_WANTS_FAST)) continue;
      check(&info, &(setup){.shaken = 1, .fast = fast[f]}, exact);
      checked++;
    }
  assert_true(checked >= 6);
}

static int tell(void **state)
{
  (void)state;
  print_message("# least order - nominal: %.2f\n", least);
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_scheme_has_its_order),
                                     cmocka_unit_test(drifting_positions_keep_it),
                                     cmocka_unit_test(couplings_of_parts_keep_it)};
  return cmocka_run_group_tests_name("order", tests, NULL, tell);
}
