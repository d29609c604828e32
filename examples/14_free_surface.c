/* 14_free_surface -- operators on the particles of a run: where its free surface is, its normals,
 * and gradients that are right up to it.
 *
 * Equations  a disc of liquid with v = (A x, -A y) becomes an ellipse, semi-axes a and b = R^2/a:
 *            da/dt = A a,  dA/dt = A^2 (b^2 - a^2)/(a^2 + b^2);
 *            surface: least eigenvalue of M = -sum V r (x) r F, and a scan of the cone around the
 *            normal -M^-1 sum V grad W;  dv/dx = sum V (v_j - v_i) grad W with and without M^-1
 * Reference  J. J. Monaghan (1994), J. Comput. Phys. 110, 399; S. Marrone et al. (2010), J. Comput.
 *            Phys. 229, 3652; J. Bonet & T.-S. L. Lok (1999), Comput. Methods Appl. Mech. Eng. 180,
 *            97
 * Run        ./14_free_surface [particles per radius]
 * See        how many particles are at the surface, how far they are from the ellipse, how far
 *            their normals turn from its own; the mean of dv_x/dx there, which should be A: without
 *            M^-1 half of the neighbours are missing, and so is nearly half of it
 * Check      all particles at the surface are within 1.5 dx of the ellipse, and all within dx/2 of
 *            it are found; normals within 5 degrees (rms); corrected dv_x/dx within 5 % of A */
#include <math.h>
#include <sphode.h>
#include <stdlib.h>

static const double R = 1, rate = 100, rho0 = 1000, c0 = 1400, t_end = 0.004; /* SI */

typedef struct ellipse {
  double a, A; /* semi-axis along x [m], dv_x/dx [1/s] */
} ellipse;

static ellipse slope(ellipse e)
{
  const double a2 = e.a * e.a, b2 = pow(R, 4) / a2;
  return (ellipse){e.A * e.a, e.A * e.A * (b2 - a2) / (a2 + b2)};
}

static ellipse add(ellipse e, double dt, ellipse k)
{
  return (ellipse){e.a + dt * k.a, e.A + dt * k.A};
}

/* The exact one at time t, by Kutta's method. */
static ellipse exact(double t)
{
  ellipse e = {R, rate};
  const double dt = t / 1000;
  for (int k = 0; k < 1000; k++) {
    const ellipse k1 = slope(e), k2 = slope(add(e, dt / 2, k1)), k3 = slope(add(e, dt / 2, k2));
    const ellipse k4 = slope(add(e, dt, k3));
    e = add(add(add(add(e, dt / 6, k1), dt / 3, k2), dt / 3, k3), dt / 6, k4);
  }
  return e;
}

static sph_sim *patch(int n)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = R / n, .h_over_dx = 2});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group_add_ball(water, (double[]){0, 0}, R, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *vx = sph_group_write(water, "velocity", 0), *vy = sph_group_write(water, "velocity", 1);
  double *p = calloc((size_t)sph_group_count(water) + 1, sizeof *p);
  for (long i = 0; p && vx && vy && i < sph_group_count(water); i++) {
    vx[i] = rate * x[i], vy[i] = -rate * y[i];
    p[i] = 0.5 * rho0 * rate * rate * (R * R - x[i] * x[i] - y[i] * y[i]);
  }
  sph_group_set_pressure(water, p);
  free(p);
  return sim;
}

/* What operators say of the particles; [n] each. */
typedef struct surface {
  int *state;
  double *normal[2], *difference[4], *corrected[4], *volume;
} surface;

static double *array(long n)
{
  double *a = calloc((size_t)n + 1, sizeof *a);
  if (!a) fprintf(stderr, "14_free_surface: out of memory\n"), exit(1);
  return a;
}

/* The points of an operator are those of the group, their volumes m/rho. */
static int find(sph_sim *sim, surface *s, sph_error *error)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *const x[] = {sph_group_read(water, "position", 0),
                             sph_group_read(water, "position", 1)};
  const double *const v[] = {sph_group_read(water, "velocity", 0),
                             sph_group_read(water, "velocity", 1)};
  const double *m = sph_group_read(water, "mass", 0), *rho = sph_group_read(water, "density", 0);
  const long n = sph_group_count(water);
  s->state = calloc((size_t)n + 1, sizeof *s->state);
  s->volume = array(n);
  for (int d = 0; d < 2; d++) s->normal[d] = array(n);
  for (int k = 0; k < 4; k++) s->difference[k] = array(n), s->corrected[k] = array(n);
  for (long i = 0; i < n; i++) s->volume[i] = m[i] / rho[i];
  sph_operator *op = sph_operator_create(
      &(sph_operator_def){.dim = 2, .h = sph_sim_h(sim), .kernel = sph_sim_kernel(sim)}, error);
  sph_operator_set_points(op, n, x, s->volume, rho, error);
  sph_operator_surface(op, "cone", s->state, NULL, s->normal, error);
  sph_operator_gradient_vector(op, "difference", v, s->difference, error);
  sph_operator_gradient_vector(op, "corrected", v, s->corrected, error);
  sph_operator_free(op);
  return error->status;
}

static void drop(surface *s)
{
  free(s->state), free(s->volume);
  for (int d = 0; d < 2; d++) free(s->normal[d]);
  for (int k = 0; k < 4; k++) free(s->difference[k]), free(s->corrected[k]);
}

/* Against the exact ellipse; 0: as it should be. */
static int compare(sph_sim *sim, const surface *s)
{
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  const ellipse e = exact(t_end);
  const double a2 = e.a * e.a, b2 = pow(R, 4) / a2, dx = sph_sim_dx(sim), degree = acos(-1) / 180;
  const long n = sph_group_count(water);
  double farthest = 0, turn = 0, rough = 0, right = 0;
  long count = 0, missed = 0;
  for (long i = 0; i < n; i++) {
    const double gx = 2 * x[i] / a2, gy = 2 * y[i] / b2, g = hypot(gx, gy); /* along the normal */
    const double depth = (1 - x[i] * x[i] / a2 - y[i] * y[i] / b2) / g;     /* near the ellipse */
    missed += depth < 0.5 * dx && s->state[i] == SPH_INSIDE;
    if (s->state[i] == SPH_INSIDE) continue;
    const double along = (s->normal[0][i] * gx + s->normal[1][i] * gy) / g;
    farthest = fmax(farthest, fabs(depth) / dx);
    turn += pow(acos(fmin(along, 1)) / degree, 2);
    rough += s->difference[0][i] / e.A - 1;
    right += s->corrected[0][i] / e.A - 1;
    count++;
  }
  turn = sqrt(turn / (double)count);
  rough /= (double)count, right /= (double)count;
  printf("semi-axes %.4f m and %.4f m, dv_x/dx = %.3f 1/s\n", e.a, R * R / e.a, e.A);
  printf("at the surface: %ld of %ld particles, at most %.2f dx from it; %ld missed\n", count, n,
         farthest, missed);
  printf("normals: within %.1f degrees (rms)\n", turn);
  printf("mean dv_x/dx at the surface: off by %+.1f %%, corrected by %+.1f %%\n", 100 * rough,
         100 * right);
  return !(farthest < 1.5) || missed || !(turn < 5) || !(fabs(right) < 0.05);
}

int main(int argc, char **argv)
{
  sph_sim *sim = patch(argc > 1 ? atoi(argv[1]) : 20);
  sph_error error = {0};
  surface s = {0};
  int failed = sph_sim_run(sim, t_end) || find(sim, &s, &error) || compare(sim, &s);
  if (*sph_sim_error(sim)) fprintf(stderr, "14_free_surface: %s\n", sph_sim_error(sim));
  if (error.status) fprintf(stderr, "14_free_surface: %s\n", error.text);
  drop(&s);
  sph_sim_free(sim);
  return failed;
}
