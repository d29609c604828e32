/* 11_sensitivities -- what a result owes to parameters, and to each entry of the start.
 *
 * Equations  a shear wave v_x = A(t) cos(k y) in a periodic box decays by viscosity,
 *            A = A_0 exp(-nu k^2 t).  Forward: s = dy/dtheta is integrated with the state,
 *            ds/dt = (df/dy) s + df/dtheta.  Backward: the adjoint of the Runge-Kutta scheme gives
 *            dA(T)/dtheta and dA(T)/dv_i(0), for all particles i, in one run back
 * Reference  A. C. Hindmarsh et al. (2005), SUNDIALS, ACM Trans. Math. Softw. 31, 363;
 *            W. W. Hager (2000), Runge-Kutta methods in optimal control, Numer. Math. 87, 247
 * Run        ./11_sensitivities [particles along the box]
 * See        dA/deta and dA/dc0 by both ways and by the difference of two runs; the viscosity of an
 *            unknown liquid from one measured amplitude, in three Newton steps
 * Check      dA/deta is -k^2 t A/rho within 3 %, both ways agree within 1e-9 and with differences
 *            within 1e-6; dA(T)/dv_i(0) is the wave that decays backwards, within 2 % of its
 *            largest; the viscosity comes out within 1e-6 of itself */
#include <sphode.h>
#include <stdlib.h>

static const double L = 1, rho0 = 1000, c0 = 10, V = 0.1; /* [m], [kg/m^3], [m/s] */
static const double T = 0.25, dt = 8e-3;                  /* [s] */

static double wave_number(void) { return 2 * acos(-1) / L; }

static sph_sim *liquid(int n, double eta, double c)
{
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = L / n, .periodic = {1, 1}, .length = {L, L}, .speed = V});
  sph_group *oil = sph_group_box(sim, "oil", (double[]){0, 0}, (double[]){L, L}, rho0);
  sph_group_set_eos(oil, sph_eos_tait(rho0, c, 7));
  sph_group_set_viscosity(oil, eta);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.dt_fixed = dt});
  const double *y = sph_group_read(oil, "position", 1);
  double *v = sph_group_write(oil, "velocity", 0);
  for (long i = 0; y && v && i < sph_group_count(oil); i++) v[i] = V * cos(wave_number() * y[i]);
  return sim;
}

/* A = 2/N sum_i v_x cos(k y), of the state shown. */
static double amplitude(void *ctx, sph_sim *sim)
{
  const sph_group *oil = sph_sim_group(sim, "oil");
  const double *y = sph_group_read(oil, "position", 1), *v = sph_group_read(oil, "velocity", 0);
  double sum = 0;
  long n = sph_group_count(oil);
  (void)ctx;
  for (long i = 0; i < n; i++) sum += v[i] * cos(wave_number() * y[i]);
  return 2 * sum / (double)n;
}

/* Its derivatives with respect to y and v_x of each particle. */
static void amplitude_gradient(void *ctx, sph_sim *sim, sph_adjoint *adjoint)
{
  const sph_group *oil = sph_sim_group(sim, "oil");
  const double *y = sph_group_read(oil, "position", 1), *v = sph_group_read(oil, "velocity", 0);
  double *by_y = sph_adjoint_gradient(adjoint, oil, "position", 1);
  double *by_v = sph_adjoint_gradient(adjoint, oil, "velocity", 0);
  double k = wave_number();
  long n = sph_group_count(oil);
  (void)ctx;
  for (long i = 0; i < n; i++) {
    by_v[i] += 2 * cos(k * y[i]) / (double)n;
    by_y[i] += -2 * k * v[i] * sin(k * y[i]) / (double)n;
  }
}

static int measure(void *ctx, sph_sim *sim, double *value)
{
  *value = amplitude(ctx, sim);
  return SPH_OK;
}

static int told(sph_sim *sim)
{
  if (sph_sim_status(sim)) fprintf(stderr, "11_sensitivities: %s\n", sph_sim_error(sim));
  return sph_sim_status(sim);
}

static const sph_sensitivity_parameter theta[] = {{"oil.viscosity", NULL}, {"oil.c0", NULL}};

/* A(T) and its derivatives, forward; 0 or a failure. */
static int forward(int n, double eta, double *A, double slope[2])
{
  sph_sim *sim = liquid(n, eta, c0);
  sph_sensitivity *s = sph_sensitivity_create(sim, 2, theta);
  sph_sensitivity_run(s, T);
  for (int k = 0; k < 2; k++) sph_sensitivity_of(s, k, measure, NULL, &slope[k]);
  if (!sph_sim_status(sim)) *A = amplitude(NULL, sim);
  int failed = told(sim);
  sph_sensitivity_free(s);
  sph_sim_free(sim);
  return failed;
}

static int amplitude_of(int n, double eta, double c, double *A)
{
  sph_sim *sim = liquid(n, eta, c);
  sph_sim_run(sim, T);
  if (!sph_sim_status(sim)) *A = amplitude(NULL, sim);
  int failed = told(sim);
  sph_sim_free(sim);
  return failed;
}

/* The largest difference of dA(T)/dv_i(0) from 2/N exp(-nu k^2 T) cos(k y_i), over its largest. */
static double start_error(const sph_sim *sim, const sph_adjoint *a, double eta)
{
  const sph_group *oil = sph_sim_group(sim, "oil");
  const double *by_v = sph_adjoint_start(a, oil, "velocity", 0);
  const double *y = sph_group_read(oil, "position", 1);
  double k = wave_number(), worst = 0;
  long n = sph_group_count(oil);
  double most = 2 / (double)n * exp(-eta / rho0 * k * k * T);
  for (long i = 0; i < n; i++) worst = fmax(worst, fabs(by_v[i] - most * cos(k * y[i])) / most);
  return worst;
}

static int backward(int n, double eta, double slope[2], double *error)
{
  sph_sim *sim = liquid(n, eta, c0);
  sph_adjoint *a =
      sph_adjoint_create(sim, &(sph_adjoint_def){.functional = {.end = amplitude,
                                                                .end_gradient = amplitude_gradient},
                                                 .n = 2,
                                                 .parameters = theta});
  sph_adjoint_run(a, T);
  for (int k = 0; k < 2; k++) slope[k] = sph_adjoint_parameter(a, k);
  if (!sph_sim_status(sim)) *error = start_error(sim, a, eta);
  int failed = told(sim);
  sph_adjoint_free(a);
  sph_sim_free(sim);
  return failed;
}

/* Newton's method for A(T; eta) = measured. */
static int identify(int n, double measured, double *eta)
{
  for (int step = 0; step < 4; step++) {
    double A, slope[2];
    if (forward(n, *eta, &A, slope)) return 1;
    printf("  eta = %.9f Pa s: A = %.9f m/s, %+.1e off\n", *eta, A, A - measured);
    *eta -= (A - measured) / slope[0];
  }
  return 0;
}

int main(int argc, char **argv)
{
  const int n = argc > 1 ? atoi(argv[1]) : 16;
  const double eta = 20, e = 1e-4; /* [Pa s]; relative change for differences */
  double A, ahead[2], back[2], start = 1, plus[2], minus[2], unknown = 10;
  if (forward(n, eta, &A, ahead) || backward(n, eta, back, &start)) return 1;
  if (amplitude_of(n, eta * (1 + e), c0, &plus[0]) ||
      amplitude_of(n, eta * (1 - e), c0, &minus[0]) ||
      amplitude_of(n, eta, c0 * (1 + e), &plus[1]) || amplitude_of(n, eta, c0 * (1 - e), &minus[1]))
    return 1;
  const double k = wave_number(), expected = -k * k * T * A / rho0, size[2] = {eta, c0};
  int failed = !(fabs(ahead[0] / expected - 1) < 0.03) || !(start < 0.02);
  printf("A(T) = %.6f m/s; dA/deta expected %.6g\n", A, expected);
  for (int p = 0; p < 2; p++) {
    double difference = (plus[p] - minus[p]) / (2 * e * size[p]);
    printf("dA/d(%s): forward %.9g, backward %.9g, difference of runs %.9g\n", theta[p].name,
           ahead[p], back[p], difference);
    failed |= !(fabs(back[p] - ahead[p]) < 1e-9 * A / size[p]);
    failed |= !(fabs(difference - ahead[p]) < 1e-6 * A / size[p]);
  }
  printf("dA(T)/dv_i(0): off the wave that decays backwards by %.2g of its largest\n", start);
  printf("an unknown liquid with this A(T):\n");
  failed |= identify(n, A, &unknown) || !(fabs(unknown / eta - 1) < 1e-6);
  printf("  eta = %.9f Pa s\n", unknown);
  return failed;
}
