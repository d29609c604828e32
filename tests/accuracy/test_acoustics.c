/* Sound on a lattice has a frequency known in closed form: the linear response of the right-hand
 * side to a standing wave of wave number k, with density rho0 (1 + e cos kx) or velocity e sin kx,
 * is
 *
 *   d rho/dt = - e rho0 (omega/c0) cos kx,   a = e c0 omega sin kx,
 *   omega = c0 |sum_j V r_ij F_ij sin(k r_ij)|
 *
 * (p = 0 at rest).  All sums run over the lattice here, with the kernels' shapes written out
 * again. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>

#include "exact.h"
#include "sphode.h"

enum { N = 40 };
static const double c0 = 3, rho0 = 2, pi = 3.14159265358979323846; /* [m/s], [kg/m] */

enum { C2, C4, C6, CUBIC, QUINTIC, GAUSSIAN, SHIFTED, SPIKY, KERNELS };
static const char *const kernels[KERNELS] = {"wendland-c2",      "wendland-c4",    "wendland-c6",
                                             "cubic-spline",     "quintic-spline", "gaussian",
                                             "gaussian-shifted", "spiky"};

/* w'(q) sigma in 1D, q > 0 */
static double slope(int kernel, double q)
{
  const double t = fmax(1 - q / 2, 0), e = exp(-9), a = sqrt(pi) * erf(3);
  switch (kernel) {
  case C2: return -3 * q * t * t * 5 / 8;
  case C4: return -7 * q * (1 + 2 * q) * pow(t, 4) / 2 * 3 / 4;
  case C6: return -3 * q * (12 + 36 * q + 35 * q * q) * pow(t, 6) / 8 * 55 / 64;
  case CUBIC: return (q < 1 ? -3 * q + 9 * q * q / 4 : -3 * t * t) * 2 / 3;
  case QUINTIC:
    return (-5 * pow(fmax(3 - q, 0), 4) + 30 * pow(fmax(2 - q, 0), 4) -
            75 * pow(fmax(1 - q, 0), 4)) /
           120;
  case SPIKY: return -12 * t * t / 8;
  }
  return q < 3 ? -2 * q * exp(-q * q) / (kernel == GAUSSIAN ? a : a - 6 * e) : 0;
}

static double frequency(int kernel, double h, double k)
{
  double sum = 0, dx = 1.0 / N;
  for (int j = 1; j < N / 2; j++)
    sum += 2 * dx * slope(kernel, j * dx / h) / (h * h) * sin(k * j * dx);
  return c0 * fabs(sum);
}

/* Amplitude of the answer to a wave of size e, along its shape: cos kx of drho/dt, sin kx of a. */
static double response(sph_sim *sim, int of_density, double k, double e)
{
  sph_group *gas = sph_sim_group(sim, "gas");
  const double *x = sph_group_read(gas, "position", 0);
  double *v = sph_group_write(gas, "velocity", 0), *rho = sph_group_write(gas, "density", 0);
  assert_non_null(x);
  for (int i = 0; i < N; i++) {
    v[i] = of_density ? 0 : e * sin(k * x[i]);
    rho[i] = rho0 * (1 + (of_density ? e * cos(k * x[i]) : 0));
  }
  sph_sim_changed(sim);
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  x = sph_group_read(gas, "position", 0);
  const double *rate = sph_group_rate(gas, of_density ? "velocity" : "density", 0);
  double sum = 0;
  for (int i = 0; i < N; i++) sum += rate[i] * (of_density ? sin(k * x[i]) : cos(k * x[i]));
  return 2 * sum / N;
}

static sph_sim *lattice(int kernel, double h_over_dx, const char *form)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / N,
                                               .kernel = kernels[kernel],
                                               .h_over_dx = h_over_dx,
                                               .periodic = {1},
                                               .length = {1}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, rho0);
  sph_group_set_eos(gas, sph_eos_linear(rho0, c0, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity_form(form));
  sph_sim_add_term(sim, sph_term_pressure_form(form[1] == '1' ? "s" : "c2"));
  assert_int_equal(sph_group_count(gas), N);
  return sim;
}

/* omega from both answers; even orders of e cancel. */
static double measured(int kernel, double h_over_dx, const char *form, double k)
{
  sph_sim *sim = lattice(kernel, h_over_dx, form);
  const double e = 1e-5;
  double force = (response(sim, 1, k, e) - response(sim, 1, k, -e)) / (2 * e);
  double compression = (response(sim, 0, k, e) - response(sim, 0, k, -e)) / (2 * e);
  assert_string_equal(sph_sim_error(sim), "");
  sph_sim_free(sim);
  return sqrt(-force * compression / rho0);
}

static void published_example(void **state)
{
  (void)state;
  double omega = measured(0, 1.5, "c1", 2 * pi);
  if (fabs(omega / 18.426249613 - 1) > 1e-9) fail_msg("omega %.12g", omega);
}

static void all_waves(void **state)
{
  (void)state;
  double largest = 0;
  for (int kernel = 0; kernel < KERNELS; kernel++)
    for (int form = 0; form < 2; form++)
      for (int wave = 1; wave < N / 2; wave += 3) {
        double h_over_dx = 1.2 + 0.1 * kernel, k = 2 * pi * wave;
        double expected = frequency(kernel, h_over_dx / N, k);
        double omega = measured(kernel, h_over_dx, form ? "c2" : "c1", k);
        largest = fmax(largest, fabs(omega - expected) / (c0 * k));
        if (fabs(omega - expected) > 1e-9 * c0 * k) /* near the end of the band omega -> 0 */
          fail_msg("wave %d, %s: %.12g, expected %.12g", wave, kernels[kernel], omega, expected);
      }
  print_message("# all waves: error %.2g of c0 k\n", largest);
}

/* With h/dx large, the kernel's own dispersion: its transform is 1 - (k h sigma_k)^2/2.  Not of
 * spiky, whose kink at r = 0 no lattice resolves. */
static void long_waves(void **state)
{
  (void)state;
  for (int kernel = 0; kernel < SPIKY; kernel++) {
    double omega = measured(kernel, 4, "c2", 2 * pi), kh = 2 * pi * 4 / N;
    double sigma_k = sph_kernel_deviation(sph_kernel_find(kernels[kernel]), 1);
    double loss = 1 - omega / (c0 * 2 * pi), expected = kh * kh * sigma_k * sigma_k / 2;
    print_message("# %s, k h = %.3g: omega/(c0 k) = %.6f, expected %.6f\n", kernels[kernel], kh,
                  1 - loss, 1 - expected);
    assert_true(fabs(loss - expected) < 0.1 * expected);
  }
}

/* A run of one period of the lattice, T = 2 pi/omega, ends as it began.  The continuum's period is
 * 2 % off, which is 0.14 here. */
static double after_a_period(const char *method, double step)
{
  const double e = 1e-6, k = 2 * pi, period = 2 * pi / frequency(0, 1.5 / N, k);
  sph_sim *sim = lattice(0, 1.5, "c1");
  sph_group *gas = sph_sim_group(sim, "gas");
  const double *x = sph_group_read(gas, "position", 0);
  double *rho = sph_group_write(gas, "density", 0), start[N], largest = 0;
  for (int i = 0; i < N; i++) start[i] = rho[i] = rho0 * (1 + e * cos(k * x[i]));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method, .dt_fixed = step * period});
  if (sph_sim_run(sim, period) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  const double *end = sph_group_read(gas, "density", 0), *v = sph_group_read(gas, "velocity", 0);
  for (int i = 0; i < N; i++) {
    largest = fmax(largest, fabs(end[i] - start[i]) / (rho0 * e));
    largest = fmax(largest, fabs(v[i]) / (c0 * e));
  }
  sph_sim_free(sim);
  return largest;
}

static void one_period(void **state)
{
  (void)state;
  static const char *const method[] = {"erk:bogacki-shampine-4-2-3", "leapfrog", "verlet"};
  static const int order[] = {3, 2, 2};
  for (int m = 0; m < 3; m++) {
    double coarse = after_a_period(method[m], 1.0 / 100),
           fine = after_a_period(method[m], 1.0 / 200);
    print_message("# %s: error %.2g, %.2g with half the step\n", method[m], coarse, fine);
    assert_true(coarse < (order[m] == 3 ? 2e-4 : 0.02));
    assert_true(fabs(log2(coarse / fine) - order[m]) < 0.15);
  }
}

/* A running wave of relative amplitude 1e-6 after one period, against the linear solution: rms of
 * velocity over e c0.  A cubic spline of integer h/dx reproduces straight lines on a lattice: its
 * error is its dispersion, of second order in dx.  (That of a gas almost vanishes at h = dx, and
 * what is left, 6e-6, is no linear sound.) */
static double running_wave(int n, int thermal)
{
  const double e = 1e-6, gamma = 1.4, p0 = thermal ? rho0 * c0 * c0 / gamma : 0;
  const sph_exact_wave wave = {rho0, p0, c0, e, 2 * pi, 0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                               .dx = 1.0 / n,
                                               .kernel = "cubic-spline",
                                               .h_over_dx = thermal ? 2 : 1,
                                               .speed = c0,
                                               .periodic = {1},
                                               .length = {1}});
  sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, rho0);
  sph_group_set_eos(gas, thermal ? sph_eos_ideal_gas(gamma) : sph_eos_linear(rho0, c0, -INFINITY));
  sph_sim_add_term(sim, sph_term_continuity_form("c1"));
  sph_sim_add_term(sim, sph_term_pressure_form("s"));
  const double *x = sph_group_read(gas, "position", 0);
  double *v = sph_group_write(gas, "velocity", 0), *rho = sph_group_write(gas, "density", 0),
         *m = sph_group_write(gas, "mass", 0), *u = sph_group_write(gas, "energy", 0), sum = 0;
  for (int i = 0; i < n; i++) {
    sph_exact_gas start = sph_exact_wave_at(&wave, 0, x[i]);
    v[i] = start.u, rho[i] = start.rho, m[i] = start.rho / n;
    if (thermal) u[i] = start.p / ((gamma - 1) * start.rho);
  }
  sph_sim_set_integrator(sim, &(sph_integrator_def){.cfl = 0.2});
  if (sph_sim_run(sim, 1 / c0) != SPH_OK) fail_msg("%s", sph_sim_error(sim));
  x = sph_group_read(gas, "position", 0);
  const double *found = sph_group_read(gas, "velocity", 0);
  for (int i = 0; i < n; i++)
    sum += pow((found[i] - sph_exact_wave_at(&wave, 1 / c0, x[i]).u) / (e * c0), 2) / n;
  sph_sim_free(sim);
  return sqrt(sum);
}

static void order_of_a_wave(void **state)
{
  (void)state;
  for (int thermal = 0; thermal < 2; thermal++) {
    double coarse = running_wave(32, thermal), fine;
    for (int n = 64; n <= 512; n *= 2, coarse = fine) {
      fine = running_wave(n, thermal);
      print_message("# %s, %d particles: %.3g, order %.3f (bar 1.9)\n", thermal ? "gas" : "liquid",
                    n, fine, log2(coarse / fine));
      assert_true(log2(coarse / fine) >= 1.9);
    }
    /* h = dx: omega = c0 sin(k dx)/dx, a phase 2 pi (k dx)^2/6 late after a period */
    if (!thermal)
      assert_true(fabs(coarse / (pow(2 * pi, 3) / (6 * sqrt(2) * 512 * 512)) - 1) < 0.01);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(published_example), cmocka_unit_test(all_waves),
      cmocka_unit_test(long_waves),        cmocka_unit_test(one_period),
      cmocka_unit_test(order_of_a_wave),
  };
  return cmocka_run_group_tests_name("acoustics", tests, NULL, NULL);
}
