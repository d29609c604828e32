/* The stability limit S of every integrator, as it stands in src/time/integrator_table.def, in
 * integrator_rdpk.c and in the schemes' own files: the largest c0 dt/h at which a run in steps dt
 * ends with the kinetic energy of a run in small steps, within 3 %.
 *
 * 2D Taylor-Green vortices, u = U sin(kx) cos(ky), v = -U cos(kx) sin(ky), k = 2 pi/L, in a
 * periodic box of 24 x 24 particles off their lattice by up to 0.1 dx; Wendland C2, h = 1.5 dx;
 * c0 = 10 U; laminar viscosity nu = 0.01 U L and density diffusion delta = 0.1; to t = 0.5 L/U,
 * 80 h/c0 (twice that lowers S by 1 to 5 %, a third raises it by 6 to 20 %).  dt rises from half of
 * the value that the table has, in factors of 1.03, to the first that fails; that gap is halved
 * until it is under 0.5 %. */
#include <sphode.h>

#include "bench.h"

enum { ACROSS = 24 };

static const double c0 = 10, nu = 0.01, t_end = 0.5, rho0 = 1000; /* U = L = 1 */

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static void start(sph_group *fluid, double dx)
{
  const double k = 2 * acos(-1);
  unsigned state = 1;
  double *x = sph_group_write(fluid, "position", 0), *y = sph_group_write(fluid, "position", 1);
  double *u = sph_group_write(fluid, "velocity", 0), *v = sph_group_write(fluid, "velocity", 1);
  for (long i = 0; x && y && u && v && i < sph_group_count(fluid); i++) {
    u[i] = sin(k * x[i]) * cos(k * y[i]);
    v[i] = -cos(k * x[i]) * sin(k * y[i]);
    x[i] += 0.2 * dx * noise(&state);
    y[i] += 0.2 * dx * noise(&state);
  }
}

/* Kinetic energy at the end of a run in steps of about `courant` h/c0; 0 if it fails. */
static double kinetic(const char *method, double courant)
{
  const double dx = 1.0 / ACROSS, h = 1.5 * dx;
  sph_balance balance = {.kinetic = 0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = dx,
                                               .kernel = "wendland-c2",
                                               .h_over_dx = h / dx,
                                               .periodic = {1, 1},
                                               .length = {1, 1},
                                               .speed = 1});
  sph_group *fluid = sph_group_box(sim, "fluid", (double[]){0, 0}, (double[]){1, 1}, rho0);
  sph_group_set_eos(fluid, sph_eos_tait(rho0, c0, 7));
  sph_group_set_viscosity(fluid, rho0 * nu);
  start(fluid, dx);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method,
                                                    .dt_fixed = courant * h / c0,
                                                    .tolerance = -1});
  if (sph_sim_run(sim, t_end) == SPH_OK) sph_sim_balance(sim, &balance);
  sph_sim_free(sim);
  return balance.kinetic;
}

static int stable(const char *method, double courant, double reference)
{
  return fabs(kinetic(method, courant) / reference - 1) < 0.03;
}

static void measure(const sph_integrator_info *info, double *reference)
{
  char name[80];
  snprintf(name, sizeof name, "stability/%s", info->name);
  if (!bench_wanted(name)) return;
  if (!*reference) *reference = kinetic("erk:bogacki-shampine-4-2-3", 0.1);
  double good = info->stability / 2;
  while (good > 1e-3 && !stable(info->name, good, *reference)) good /= 2;
  double bad = 1.03 * good;
  for (; bad < 20 && stable(info->name, bad, *reference); bad *= 1.03) good = bad;
  while (bad > 1.005 * good) {
    double middle = sqrt(good * bad);
    *(stable(info->name, middle, *reference) ? &good : &bad) = middle;
  }
  bench_report(name, "h/c", &good, 1);
}

void bench_stability(void)
{
  sph_integrator_info info;
  double reference = 0;
  if (!bench_filtered()) return; /* a minute, and the same figures on every machine */
  for (int k = 0; sph_integrator_info_get(k, &info); k++) {
    if (info.wants) continue; /* S is that of the explicit part: of the table of erk */
    measure(&info, &reference);
  }
}
