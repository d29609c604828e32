/* 09_implicit_viscosity -- viscosity that is too stiff for explicit steps: a part of f is implicit.
 *
 * Equations  dv_i/dt = sum_j m_j 2 eta/(rho_i rho_j) F_ij v_ij + pressure + F sin(k y_i) e_x: a
 *            viscous liquid starts to flow (Kolmogorov's flow), v = V (1 - exp(-t/tau)) sin(k y),
 *            tau = 1/(nu k^2), V = F tau.  Explicitly a step is at most 0.125 h^2/nu; with
 *            imex:<table> each stage solves (M + gamma L) v = b for the viscosity, and sound alone
 *            bounds the step
 * Reference  C. A. Kennedy and M. H. Carpenter (2003), Appl. Numer. Math. 44, 139-181
 * Run        ./09_implicit_viscosity [particles across]
 * See        steps and their sizes, explicit and implicit, at Re = V L/nu = 1, 0.1, 0.01
 * Check      at t = tau: the amplitude within 1 % of the exact one, both ways; the implicit way in
 *            at most a tenth of the steps */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

static const double L = 1e-3, rho = 900, V = 1e-3; /* [m], [kg/m^3], [m/s] */

typedef struct force {
  double k, F; /* [1/m], [m/s^2] */
} force;

static int push(const sph_term *term, const sph_particles *s)
{
  const force *f = term->ctx;
  for (long i = 0; i < s->n; i++) s->a[0][i] += f->F * sin(f->k * s->x[1][i]);
  return SPH_OK;
}

typedef struct result {
  double amplitude; /* of sin(k y) in the velocity, over V */
  long steps;
  double step; /* the longest [s] */
} result;

/* The flow at t = tau; 0 or a status. */
static int flow(long n, double nu, const char *method, result *r)
{
  const double dx = L / (double)n, k = 2 * acos(-1) / L, tau = 1 / (nu * k * k);
  const double c = 10 * sqrt(V * V + nu * V / L); /* inertia and viscous stress: 1 % of rho c^2 */
  force f = {k, V / tau};

  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = dx, .periodic = {1, 1}, .length = {10 * dx, L}, .speed = V});
  sph_group *oil = sph_group_box(sim, "oil", (double[]){0, 0}, (double[]){10 * dx, L}, rho);
  sph_group_set_eos(oil, sph_eos_tait(rho, c, 7));
  sph_group_set_viscosity(oil, rho * nu);

  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, (sph_term){.name = "push", .body = push, .ctx = &f});

  /* With imex: laminar viscosity, conduction and drag are implicit unless parts are set, as by
   * sph_sim_set_part(sim, "viscosity-laminar", "implicit"). */
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .tolerance = 1e-4});
  int status = sph_sim_run(sim, tau);
  if (status != SPH_OK) fprintf(stderr, "09_implicit_viscosity: %s\n", sph_sim_error(sim));

  const double *y = sph_group_read(oil, "position", 1), *v = sph_group_read(oil, "velocity", 0);
  for (long i = 0; y && v && i < sph_group_count(oil); i++)
    r->amplitude += 2 * v[i] * sin(k * y[i]) / (V * (double)sph_group_count(oil));
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  r->steps = stats.step.steps;
  r->step = stats.step.dt_largest;
  sph_sim_free(sim);
  return status;
}

int main(int argc, char **argv)
{
  const long n = argc > 1 ? atol(argv[1]) : 32;
  const double exact = 1 - exp(-1);
  int wrong = n < 10;

  printf("Re      explicit: steps  longest [s]  error    implicit: steps  longest [s]  error\n");
  for (double Re = 1; Re > 0.005 && !wrong; Re /= 10) {
    const double nu = V * L / Re;
    result out = {0}, in = {0};
    wrong |= flow(n, nu, "erk:bogacki-shampine-4-2-3", &out) != SPH_OK;
    wrong |= flow(n, nu, "imex:ark324l2sa-4-2-3", &in) != SPH_OK;
    printf("%-6g  %15ld  %11.3g  %5.2f %%  %15ld  %11.3g  %5.2f %%\n", Re, out.steps, out.step,
           100 * (out.amplitude / exact - 1), in.steps, in.step, 100 * (in.amplitude / exact - 1));
    wrong |= fabs(out.amplitude / exact - 1) > 0.01 || fabs(in.amplitude / exact - 1) > 0.01;
    wrong |= 10 * in.steps > out.steps;
  }
  return wrong;
}
