/* Eigenvalues of the Jacobian against spectra known in closed form: sound and viscosity on periodic
 * lattices, mode by mode. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "sim_tangent.h"
#include "sphode.h"

static const double pi = 3.14159265358979323846;

static int rising(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Both sorted: the largest difference over the largest entry. */
static double distance(double *a, double *b, long n)
{
  double most = 0, error = 0;
  qsort(a, (size_t)n, sizeof *a, rising);
  qsort(b, (size_t)n, sizeof *b, rising);
  for (long k = 0; k < n; k++) {
    most = fmax(most, fabs(b[k]));
    error = fmax(error, fabs(a[k] - b[k]));
  }
  return error / most;
}

/* ---- sound in 1D: lambda = +- i omega_k, omega_k = c0 |sum_j V r F sin(k r)| ---- */

static void sound(void **state)
{
  (void)state;
  enum { N = 40 };
  const double c0 = 3, rho0 = 2, dx = 1.0 / N;
  static const char *const forms[][2] = {{"c1", "s"}, {"c2", "c2"}};
  for (int k = 0; sph_kernel_get(k); k++)
    for (int form = 0; form < 2; form++) {
      const sph_kernel *kernel = sph_kernel_get(k);
      sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 1,
                                                   .dx = dx,
                                                   .kernel = sph_kernel_name(kernel),
                                                   .h_over_dx = 1.3,
                                                   .periodic = {1},
                                                   .length = {1}});
      sph_group *gas = sph_group_box(sim, "gas", (double[]){0}, (double[]){1}, rho0);
      sph_group_set_eos(gas, sph_eos_linear(rho0, c0, -INFINITY));
      sph_sim_add_term(sim, sph_term_continuity_form(forms[form][0]));
      sph_sim_add_term(sim, sph_term_pressure_form(forms[form][1]));
      sph_jacobian *J = sph_jacobian_create(sim, NULL);
      assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
      double re[3 * N], im[3 * N], expected[2 * N];
      assert_int_equal(sph_jacobian_eigenvalues(J, 1, re, im), 2 * N);
      for (int wave = 0; wave < N; wave++) {
        double omega = 0, h = 1.3 * dx;
        for (int j = 1; j < N / 2; j++)
          omega += 2 * c0 * dx * j * dx * sph_kernel_f(kernel, 1, j * dx, h) *
                   sin(2 * pi * wave * j * dx);
        expected[2 * wave] = fabs(omega);
        expected[2 * wave + 1] = -fabs(omega);
      }
      double error = distance(im, expected, 2 * N), most = 0;
      for (int n = 0; n < 2 * N; n++) most = fmax(most, fabs(re[n]));
      if (!(error < 1e-10 && most < 1e-6 * c0 / dx))
        fail_msg("%s, %s: |Im| off by %.3g, Re %.3g", sph_kernel_name(kernel), forms[form][0],
                 error, most);
      sph_jacobian_free(J);
      sph_sim_free(sim);
    }
}

/* ---- viscosity: lambda = 2 nu sum_j V F (1 - cos k.r), once for each component ---- */

static sph_sim *honey(int dim, int n, double nu)
{
  const double rho0 = 3, side = 1;
  sph_sim_def def = {.dim = dim, .dx = side / n, .h_over_dx = 1.5};
  for (int d = 0; d < dim; d++) def.periodic[d] = 1, def.length[d] = side;
  sph_sim *sim = sph_sim_create(&def);
  sph_group *honey = sph_group_box(sim, "honey", (double[3]){0}, (double[]){1, 1, 1}, rho0);
  sph_group_set_eos(honey, sph_eos_linear(rho0, 1, -INFINITY));
  sph_group_set_viscosity(honey, rho0 * nu);
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  return sim;
}

/* The rate of the wave with that many periods along each direction. */
static double decay(const sph_sim *sim, int n, double nu, const int wave[3])
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  const int dim = sph_sim_dim(sim), reach = n / 2, y = dim > 1 ? reach : 0, z = dim > 2 ? reach : 0;
  const double dx = sph_sim_dx(sim), V = pow(dx, dim);
  double sum = 0;
  for (int a = -reach; a <= reach; a++)
    for (int b = -y; b <= y; b++)
      for (int c = -z; c <= z; c++) {
        double r = dx * sqrt(a * a + b * b + c * c);
        double phase = 2 * pi * (wave[0] * a + wave[1] * b + wave[2] * c) / n;
        sum += 2 * nu * V * sph_kernel_f(kernel, dim, r, sph_sim_h(sim)) * (1 - cos(phase));
      }
  return sum;
}

static void friction(void **state)
{
  (void)state;
  enum { N = 8, MODES = N * N };
  const double nu = 0.7;
  sph_sim *sim = honey(2, N, nu);
  sph_jacobian *J = sph_jacobian_create(sim, NULL);
  assert_int_equal(sph_jacobian_evaluate(J), SPH_OK);
  static double re[5 * MODES], im[5 * MODES], expected[3 * MODES];
  assert_int_equal(sph_jacobian_eigenvalues(J, 1, re, im), 3 * MODES); /* density rests */
  double fastest = 0, h = sph_sim_h(sim);
  for (int k = 0; k < MODES; k++) {
    const int wave[3] = {k % N, k / N, 0};
    expected[k] = expected[MODES + k] = decay(sim, N, nu, wave);
    expected[2 * MODES + k] = 0;
    fastest = fmax(fastest, -expected[k]);
  }
  print_message("# largest lambda h^2/nu in 2D: %.4f\n", fastest * h * h / nu);
  assert_true(distance(re, expected, 3 * MODES) < 1e-12);
  assert_true(fabs(fastest * h * h / nu - 6.523) < 5e-4);
  assert_true(fabs(sph_stability_step("erk:heun-euler-2-1-2", 3 * MODES, re, im) * fastest - 2) <
              1e-2);
  sph_jacobian_free(J);
  sph_sim_free(sim);
}

/* In 3D waves are eigenvectors: products with them, all that have whole or no periods of 2 dx. */
static void friction_in_3d(void **state)
{
  (void)state;
  enum { N = 8 };
  const double nu = 0.7;
  sph_sim *sim = honey(3, N, nu);
  N_Vector y = sph_sim_vector(sim), v = N_VClone(y), Jv = N_VClone(y);
  const sph_group *honey = sph_sim_group(sim, "honey");
  double fastest = 0, h = sph_sim_h(sim), *start = N_VGetArrayPointer(y);
  for (int k = 0; k < 8; k++) {
    const int wave[3] = {k % 2 * N / 2, k / 2 % 2 * N / 2, k / 4 * N / 2};
    const double *x[3], lambda = decay(sim, N, nu, wave);
    double *in = N_VGetArrayPointer(v), *out = N_VGetArrayPointer(Jv);
    long at = sph_group_read(honey, "velocity", 1) - start;
    for (int d = 0; d < 3; d++) x[d] = sph_group_read(honey, "position", d);
    N_VConst(0, v);
    for (long i = 0; i < sph_group_count(honey); i++)
      in[at + i] = cos(2 * pi * (wave[0] * x[0][i] + wave[1] * x[1][i] + wave[2] * x[2][i]) + k);
    assert_int_equal(sph_sim_jacobian_times(v, Jv, 0, y, NULL, sim, NULL), SPH_OK);
    for (long i = 0; i < sph_group_count(honey); i++)
      assert_true(fabs(out[at + i] - lambda * in[at + i]) < 1e-11 * nu / (h * h));
    fastest = fmax(fastest, -lambda);
  }
  print_message("# largest lambda h^2/nu in 3D: %.4f\n", fastest * h * h / nu);
  assert_true(fabs(fastest * h * h / nu - 6.878) < 5e-4);
  N_VDestroy(v), N_VDestroy(Jv);
  sph_sim_free(sim);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sound),
      cmocka_unit_test(friction),
      cmocka_unit_test(friction_in_3d),
  };
  return cmocka_run_group_tests_name("spectrum", tests, NULL, NULL);
}
