/* 15_manufactured_solution -- the order of a whole scheme, walls and steps included, for a flow
 * without an exact solution: take any fields, and add the force that makes them one.
 *
 * Equations  drho/dt = - rho div v,  dv/dt = - (1/rho) grad p + nu lap v + s_v,  p = c0^2 (rho -
 *            rho0), between plates y = 0, L without slip, periodic in x:
 *            rho = rho0 (1 + a cos kx cos ky),  rho v = curl psi,  k = 2 pi/L,
 *            psi = rho0 U L (2 y^2 - 4/3 y^3 + 2 y^2 (1 - y)^2 cos kx cos(2 pi t)), y in L
 *            s_v = dv/dt + (v.grad) v + (1/rho) grad p - nu lap v, worked out by the library
 * Reference  P. J. Roache (2002), J. Fluids Eng. 124, 4
 * Run        ./15_manufactured_solution [particles across the finest channel]
 * See        errors of velocity and pressure at three resolutions, h/dx growing as dx^-1/4, and the
 *            orders that they show
 * Check      velocity and pressure converge with order 1 at least */
#include <math.h>
#include <sphode.h>
#include <stdlib.h>

static const double L = 1, U = 1, nu = 0.05, rho0 = 1000, c0 = 10, a = 0.01; /* SI */
static const double t_end = 0.1, pi = 3.14159265358979323846;

static double density(void *ctx, const double x[3], double t)
{
  (void)ctx, (void)t;
  const double k = 2 * pi / L;
  return rho0 * (1 + a * cos(k * x[0]) * cos(k * x[1]));
}

static void velocity(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * pi / L, y = x[1] / L, s = U * rho0 / density(ctx, x, t), c = cos(2 * pi * t);
  v[0] = s * 4 * y * (1 - y) * (1 + (1 - 2 * y) * cos(k * x[0]) * c);
  v[1] = s * k * L * 2 * y * y * (1 - y) * (1 - y) * sin(k * x[0]) * c;
}

static sph_sim *channel(int n)
{
  const double lo[] = {0, 0}, hi[] = {L, L};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = L / n,
                                               .h_over_dx = 1.5 * pow(n / 16., 0.25),
                                               .periodic = {1},
                                               .length = {L, L},
                                               .speed = U});
  sph_group *water = sph_group_box(sim, "water", lo, hi, rho0);
  sph_group *plates = sph_group_create(sim, "plates", "wall");
  sph_boundary plate = sph_boundary_adami();
  plate.no_slip = plate.tension = 1;
  sph_group_add_layers(plates, lo, hi, "x- x+", rho0);
  sph_group_set_boundary(plates, plate);
  sph_group_set_eos(water, sph_eos_linear(rho0, c0, -INFINITY));
  sph_group_set_viscosity(water, rho0 * nu);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_manufactured_attach(
      water, &(sph_manufactured){.velocity = velocity, .density = density, .length = L, .time = 1});
  return sim;
}

int main(int argc, char **argv)
{
  enum { COUNT = 3 };
  const int finest = argc > 1 ? atoi(argv[1]) : 64;
  double dx[COUNT], of_v[COUNT], of_p[COUNT];
  printf("across  h/dx    L1(v)/U   L1(p)/(rho0 U^2)\n");
  for (int k = 0; k < COUNT; k++) {
    sph_manufactured_error v = {0}, p = {0};
    sph_sim *sim = channel(finest >> (COUNT - 1 - k));
    sph_sim_run(sim, t_end);
    sph_manufactured_error_of(sph_sim_group(sim, "water"), "velocity", &v);
    sph_manufactured_error_of(sph_sim_group(sim, "water"), "pressure", &p);
    dx[k] = sph_sim_dx(sim), of_v[k] = v.L1 / U, of_p[k] = p.L1 / (rho0 * U * U);
    printf("%6.0f  %.2f  %9.2e  %9.2e\n", L / dx[k], sph_sim_h(sim) / dx[k], of_v[k], of_p[k]);
    if (*sph_sim_error(sim)) fprintf(stderr, "15_manufactured_solution: %s\n", sph_sim_error(sim));
    sph_sim_free(sim);
  }
  const double order_v = sph_manufactured_order(COUNT, dx, of_v);
  const double order_p = sph_manufactured_order(COUNT, dx, of_p);
  printf("order of velocity %.2f, of pressure %.2f\n", order_v, order_p);
  return !(order_v >= 1 && order_p >= 1);
}
