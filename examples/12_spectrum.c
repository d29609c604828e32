/* 12_spectrum -- stiffness: eigenvalues of the right-hand side, and what they leave of the step.
 *
 * Equations  small changes of a state go as exp(lambda t), lambda the eigenvalues of df/dy.  On a
 *            lattice of a fluid at rest sound has lambda = +- i omega_k,
 *            omega_k = c0 |sum_j V r F sin(k r)|, and friction
 *            lambda_k = 2 nu sum_j V F (1 - cos k r).  A Runge-Kutta step multiplies
 *            each by R(lambda dt): stable where |R| <= 1
 * Reference  E. Hairer & G. Wanner (1996), Solving Ordinary Differential Equations II, chapter IV;
 *            J. J. Monaghan (2005), Rep. Prog. Phys. 68, 1703
 * Run        ./12_spectrum [particles]
 * See        the spectrum's extent for water and for honey; the longest stable step of a few
 *            integrators, bound by sound in one and by friction in the other; runs on both sides
 * Check      the fastest sound and friction are those of the lattice within 1e-9; noise stays what
 *            it is 2 % below the longest step of Bogacki and Shampine's scheme, and grows beyond
 *            all measure 2 % above */
#include <sphode.h>
#include <stdlib.h>

static const double rho0 = 1000, c0 = 10, L = 1; /* [kg/m], [m/s], [m] */

/* A lattice at rest, with friction of kinematic viscosity nu [m^2/s]. */
static sph_sim *fluid(int n, double nu, double dt)
{
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = L / n, .periodic = {1}, .length = {L}, .speed = 1e-3 * c0});
  sph_group *group = sph_group_box(sim, "fluid", (double[]){0}, (double[]){L}, rho0);
  sph_group_set_eos(group, sph_eos_linear(rho0, c0, -INFINITY));
  sph_group_set_viscosity(group, rho0 * nu);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  if (nu > 0) sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.dt_fixed = dt});
  return sim;
}

/* The largest omega_k and -lambda_k of all waves of the lattice. */
static void lattice(const sph_sim *sim, int n, double nu, double *omega, double *friction)
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  const double dx = L / n, h = sph_sim_h(sim);
  *omega = *friction = 0;
  for (int wave = 0; wave < n; wave++) {
    double k = 2 * acos(-1) * wave / L, sound = 0, decay = 0;
    for (int j = 1; j < n / 2; j++) {
      double VF = dx * sph_kernel_f(kernel, 1, j * dx, h);
      sound += 2 * c0 * VF * j * dx * sin(k * j * dx);
      decay += 4 * nu * VF * (1 - cos(k * j * dx));
    }
    *omega = fmax(*omega, fabs(sound));
    *friction = fmax(*friction, -decay);
  }
}

/* Extent of the spectrum, and the longest step of Bogacki and Shampine's scheme; 0 or a failure. */
static int look(const char *name, int n, double nu, double *step)
{
  static const char *const methods[] = {"erk:bogacki-shampine-4-2-3", "erk:dormand-prince-7-4-5",
                                        "erk:rdpk3sp49-9-3-4"};
  sph_sim *sim = fluid(n, nu, 1e-3);
  sph_jacobian *J = sph_jacobian_create(sim, NULL);
  double *re = calloc((size_t)n * 3, sizeof *re), *im = calloc((size_t)n * 3, sizeof *im);
  double decay = 0, oscillation = 0, slowest = INFINITY, omega, friction;
  long count = -1;
  if (re && im && !sph_jacobian_evaluate(J)) count = sph_jacobian_eigenvalues(J, 1, re, im);
  for (long k = 0; k < count; k++) {
    double size = hypot(re[k], im[k]);
    decay = fmax(decay, -re[k]);
    oscillation = fmax(oscillation, fabs(im[k]));
    if (size > 1e-3 * c0 / L) slowest = fmin(slowest, size);
  }
  if (count < 0) fprintf(stderr, "12_spectrum: %s\n", sph_sim_error(sim));
  lattice(sim, n, nu, &omega, &friction);
  printf("%s: %ld eigenvalues, |Im| to %.1f 1/s, -Re to %.1f 1/s, stiffness %.0f\n", name, count,
         oscillation, decay, fmax(decay, oscillation) / slowest);
  for (int m = 0; m < 3; m++)
    printf("  %-28s dt <= %.3e s\n", methods[m], sph_stability_step(methods[m], count, re, im));
  *step = sph_stability_step(methods[0], count, re, im);
  int failed = count != 2 * n;
  if (nu == 0) failed |= !(fabs(oscillation / omega - 1) < 1e-9) || !(decay < 1e-9 * omega);
  if (nu > 0) printf("  friction alone would reach %.1f 1/s\n", friction);
  /* Where friction rules, its fastest wave has no sound: both roots of
   * lambda^2 - lambda_k lambda + omega_k^2 with omega_k = 0. */
  if (nu > 0) failed |= !(fabs(decay / friction - 1) < 1e-9);
  free(re), free(im);
  sph_jacobian_free(J);
  sph_sim_free(sim);
  return failed;
}

/* How noise of 1e-6 c0 has changed after 3000 steps of dt. */
static double growth(int n, double nu, double dt)
{
  sph_sim *sim = fluid(n, nu, dt);
  sph_group *group = sph_sim_group(sim, "fluid");
  double *v = sph_group_write(group, "velocity", 0), start = 0, end = 0;
  for (int i = 0; i < n; i++) {
    v[i] = 1e-6 * c0 * sin(12.9898 * i * i); /* all waves */
    start = fmax(start, fabs(v[i]));
  }
  int failed = sph_sim_run(sim, 3000 * dt); /* may end early: nothing is left of the state */
  const double *found = sph_group_read(group, "velocity", 0);
  for (int i = 0; i < n; i++) end = fmax(end, fabs(found[i]));
  sph_sim_free(sim);
  return failed ? INFINITY : end / start;
}

int main(int argc, char **argv)
{
  const int n = argc > 1 ? atoi(argv[1]) : 40;
  static const char *const name[] = {"water", "honey"};
  const double nu[] = {0, 0.5};
  int failed = 0;
  for (int k = 0; k < 2; k++) {
    double step = 0;
    failed |= look(name[k], n, nu[k], &step);
    double below = growth(n, nu[k], 0.98 * step), above = growth(n, nu[k], 1.02 * step);
    printf("  noise after 3000 steps: times %.3g just below, %.3g just above\n", below, above);
    failed |= !(below < 2) || !(above > 1e3);
  }
  return failed;
}
