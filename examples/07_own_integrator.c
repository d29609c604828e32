/* 07_own_integrator -- an integrator of your own: Kutta's method of order four.
 *
 * Equations  k1 = f(t, y),  k2 = f(t + h/2, y + h/2 k1),  k3 = f(t + h/2, y + h/2 k2),
 *            k4 = f(t + h, y + h k3),  y(t + h) = y + h/6 (k1 + 2 k2 + 2 k3 + k4)
 *            steps a sound wave of finite amplitude, v = V sin(k x), in a periodic box
 * Reference  W. Kutta (1901), Beitrag zur naeherungsweisen Integration totaler
 *            Differentialgleichungen, Z. Math. Phys. 46, 435
 * Run        ./07_own_integrator
 * See        the errors of the velocities with steps of h, h/2, h/4, and the order
 * Check      the order, from the errors against a run of order eight with far smaller steps, is 4
 *            within 0.1: particles feel nothing but smooth forces, no pair enters or leaves a
 *            kernel's support */
#include <sphode.h>
#include <stdio.h>

enum { N = 64 }; /* particles */

/* y = y0 + a k */
static void move(sph_ode *o, double a, const double *k)
{
  for (long i = 0; i < o->n; i++) o->y[i] = o->y0[i] + a * k[i];
}

/* The whole integrator: the library brings k1 = f0, asks for the next h, repeats what fails. */
static int kutta_step(void *ctx, sph_ode *o)
{
  const double *k1 = o->f0, h = o->h;
  double *k2 = o->work[0], *k3 = o->work[1], *k4 = o->work[2];
  (void)ctx;
  move(o, h / 2, k1);
  int status = sph_ode_rhs(o, o->t + h / 2, o->y, k2);
  if (!status) move(o, h / 2, k2);
  if (!status) status = sph_ode_rhs(o, o->t + h / 2, o->y, k3);
  if (!status) move(o, h, k3);
  if (!status) status = sph_ode_rhs(o, o->t1, o->y, k4);
  for (long i = 0; !status && i < o->n; i++)
    o->y[i] = o->y0[i] + h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return status;
}

static const sph_scheme kutta = {
    .name = "kutta", .order = 4, .stages = 4, .stability = 2.8, .work = 3, .step = kutta_step};

/* Velocities after the wave has run half the box; 0 or a failure, told. */
static int run(const sph_integrator_def *integrator, double v[N])
{
  const double c0 = 10, V = 0.1 * c0, L = 1, k = 2 * acos(-1) / L; /* [m/s], [m] */
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 1, .dx = L / N, .h_over_dx = 1.3, .periodic = {1}, .length = {L}, .speed = V});
  sph_group *fluid = sph_group_box(sim, "fluid", (double[]){0}, (double[]){L}, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_set_integrator(sim, integrator);
  const double *x = sph_group_read(fluid, "position", 0);
  double *start = sph_group_write(fluid, "velocity", 0);
  for (int i = 0; x && start && i < N; i++) start[i] = V * sin(k * x[i]);

  int status = sph_sim_run(sim, L / 2 / c0);
  const double *end = sph_group_read(fluid, "velocity", 0);
  for (int i = 0; end && i < N; i++) v[i] = end[i];
  if (status) fprintf(stderr, "07_own_integrator: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return status;
}

int main(void)
{
  double v[N], exact[N], error[3];
  int failed = run(&(sph_integrator_def){.method = "erk:fehlberg-13-7-8", .dt_fixed = 1e-4}, exact);
  for (int k = 0; !failed && k < 3; k++) {
    double h = 1e-3 / (1 << k);
    failed = run(&(sph_integrator_def){.own = &kutta, .dt_fixed = h}, v);
    error[k] = 0;
    for (int i = 0; i < N; i++) error[k] = fmax(error[k], fabs(v[i] - exact[i]));
    printf("h = %.2e s: largest error of v %.3e m/s", h, error[k]);
    printf(k ? ", order %.2f\n" : "\n", k ? log2(error[k - 1] / error[k]) : 0);
  }
  return failed || !(fabs(log2(error[1] / error[2]) - 4) < 0.1);
}
