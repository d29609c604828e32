/* 04_own_eos -- an equation of state of your own: sound deep in the Earth's mantle.
 *
 * Equations  Birch-Murnaghan, x = rho/rho0:  p = (3/2) K0 [x^(7/3) - x^(5/3)],
 *            c^2 = dp/drho = (K0/rho0) [(7/2) x^(4/3) - (5/2) x^(2/3)],
 *            u_el = (9/8) (K0/rho0) (x^(2/3) - 1)^2
 *            A plane wave of small amplitude, v = V sin(k z - omega t), p' = rho c v, in rock
 *            compressed by 10 %, where c is far from c0: omega = c k.  On a lattice of particles
 *            omega^2 = (c^2 - 2p/rho) K^2 + (2p/rho) D, with the sums that tend to k and k^2:
 *            K = -sum_j dx r_ij F_ij sin(k r_ij),  D = sum_j dx W''_ij (1 - cos(k r_ij))
 * Reference  F. Birch (1947), Finite elastic strain of cubic crystals, Phys. Rev. 71, 809
 * Run        ./04_own_eos [particles, default 100]
 * See        the printed speed of sound
 * Check      after a period 2 pi/(c k) the speed of the measured wave is that of the lattice within
 *            0.1 %, and its amplitude holds within 1 % */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

/* Arrays in, arrays out.  The parameters are those of the struct: rho0, c0 = sqrt(K0/rho0). */
static void pressure(const sph_eos *eos, long n, const double *rho, const double *u, double *p,
                     double *c)
{
  (void)u; /* not thermal */
  for (long i = 0; i < n; i++) {
    double x = rho[i] / eos->rho0, a = cbrt(x), x23 = a * a;
    p[i] = 1.5 * eos->rho0 * eos->c0 * eos->c0 * x * x23 * (x23 - 1);
    c[i] = eos->c0 * sqrt(x23 * (3.5 * x23 - 2.5));
  }
}

/* The inverse rho(p), by Newton's method: walls and starts need it. */
static double density(const sph_eos *eos, double p, double u)
{
  (void)u;
  double rho = eos->rho0;
  for (int k = 0; k < 50; k++) {
    double found, c;
    pressure(eos, 1, &rho, NULL, &found, &c);
    double step = (p - found) / (c * c);
    rho += step;
    if (fabs(step) < 1e-15 * rho) break;
  }
  return rho;
}

static double elastic_energy(const sph_eos *eos, double rho)
{
  double s = pow(rho / eos->rho0, 2.0 / 3) - 1;
  return 1.125 * eos->c0 * eos->c0 * s * s;
}

static sph_eos birch_murnaghan(double rho0, double K0)
{
  return (sph_eos){.name = "birch-murnaghan",
                   .rho0 = rho0,
                   .c0 = sqrt(K0 / rho0),
                   .p_min = -INFINITY,
                   .pressure = pressure,
                   .density = density,
                   .elastic_energy = elastic_energy};
}

/* The wave of number k in the velocity: amplitude sin(k x + phase). */
static void measure(const sph_group *rock, double k, double *amplitude, double *phase)
{
  const double *x = sph_group_read(rock, "position", 0), *v = sph_group_read(rock, "velocity", 0);
  long n = sph_group_count(rock);
  double in_phase = 0, behind = 0;
  for (long i = 0; i < n; i++) {
    in_phase += v[i] * sin(k * x[i]) * 2 / (double)n;
    behind += v[i] * cos(k * x[i]) * 2 / (double)n;
  }
  *amplitude = hypot(in_phase, behind);
  *phase = atan2(behind, in_phase);
}

/* Pressure and velocity of the wave that travels to +x. */
static void start_wave(sph_group *rock, double k, double p1, double impedance, double V)
{
  long n = sph_group_count(rock);
  const double *x = sph_group_read(rock, "position", 0);
  double *v = sph_group_write(rock, "velocity", 0), *p = malloc((size_t)n * sizeof *p);
  for (long i = 0; x && v && p && i < n; i++) {
    v[i] = V * sin(k * x[i]);
    p[i] = p1 + impedance * v[i];
  }
  if (p) sph_group_set_pressure(rock, p);
  free(p);
}

/* omega/k of particles on a lattice, at sound speed c and P = p/rho [m/s]. */
static double lattice_speed(const sph_sim *sim, double k, double c, double P)
{
  const sph_kernel *kernel = sph_kernel_find(sph_sim_kernel(sim));
  double dx = sph_sim_dx(sim), h = sph_sim_h(sim), K = 0, D = 0;
  for (double r = dx; r < sph_kernel_support(kernel) * h; r += dx) {
    K -= 2 * dx * r * sph_kernel_f(kernel, 1, r, h) * sin(k * r);
    D += 2 * dx * sph_kernel_laplacian(kernel, 1, r, h) * (1 - cos(k * r));
  }
  return sqrt((c * c - 2 * P) * K * K + 2 * P * D) / k;
}

int main(int argc, char **argv)
{
  const double rho0 = 3220, K0 = 1.3e11, L = 1000; /* olivine [kg/m^3], [Pa]; length [m] */
  const double dx = L / (argc > 1 ? atof(argv[1]) : 100), k = 2 * acos(-1) / L;
  const sph_eos eos = birch_murnaghan(rho0, K0);

  double rho1 = 1.1 * rho0, p1, c1;
  eos.pressure(&eos, 1, &rho1, NULL, &p1, &c1);
  const double V = 1e-5 * c1, period = L / c1;

  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = dx, .periodic = {1}, .length = {L}, .speed = V});
  sph_group *rock = sph_group_box(sim, "rock", (double[]){0}, (double[]){L}, rho1);
  sph_group_set_eos(rock, eos);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-4});
  start_wave(rock, k, p1, rho1 * c1, V);

  int status = sph_sim_run(sim, period);
  double amplitude = 0, phase = 0, speed = 0, expected = 0;
  if (status == SPH_OK) {
    measure(rock, k, &amplitude, &phase);
    speed = c1 * (1 - phase / (k * L));
    expected = lattice_speed(sim, k, c1, p1 / rho1);
    printf("p = %.2f GPa: speed of sound %.1f m/s, on the lattice %.1f m/s (at p = 0: %.1f m/s)\n",
           p1 / 1e9, c1, expected, eos.c0);
    printf("measured %.1f m/s, amplitude %.5f of the start\n", speed, amplitude / V);
  } else
    fprintf(stderr, "04_own_eos: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return status != SPH_OK || !(fabs(speed / expected - 1) < 0.001) ||
         !(fabs(amplitude / V - 1) < 0.01);
}
