#include "wall_scene.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "exact.h"

const double wall_scene_times[WALL_TIMES] = {0.0225, 0.045, 0.1125, 0.225, 0.5};

static int is_mirror(const sph_boundary *b) { return !strcmp(b->name, "mirror"); }

sph_boundary wall_scene_boundary(const char *model, int no_slip)
{
  sph_boundary b = sph_boundary_adami();
  if (!strcmp(model, "dbc")) b = sph_boundary_dbc();
  if (!strcmp(model, "mirror")) b = sph_boundary_mirror();
  b.no_slip = no_slip;
  return b;
}

sph_group *wall_scene_box(sph_sim *sim, const char *name, sph_boundary boundary, const double *lo,
                          const double *hi, const char *open)
{
  sph_group *group = sph_group_create(sim, name, "wall");
  if (is_mirror(&boundary))
    sph_boundary_mirror_box(&boundary, lo, hi, open, sph_sim_dim(sim));
  else
    sph_group_add_layers(group, lo, hi, open, 1000);
  sph_group_set_boundary(group, boundary);
  return group;
}

/* ---- a tank at rest ---- */

static const double rho0 = 1000;

static sph_sim *tank(const char *model, const char *diffusion)
{
  const double H = 1, g = 1, dx = H / 20, c0 = 10 * sqrt(2 * g * H);
  const double lo[] = {0, 0}, hi[] = {H, 1.3 * H};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", lo, (double[]){H, H}, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_group *walls = wall_scene_box(sim, "walls", wall_scene_boundary(model, 0), lo, hi, "y+");
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta(diffusion, 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  sph_group_set_hydrostatic(water, 1, H, g);
  if (!strcmp(model, "dbc")) { /* they start from the column, too */
    sph_group_set_eos(walls, sph_eos_tait(rho0, c0, 7));
    sph_group_set_hydrostatic(walls, 1, H, g);
  }
  return sim;
}

static double pressure_error(const sph_group *water)
{
  const double *y = sph_group_read(water, "position", 1), *p = sph_group_read(water, "pressure", 0);
  const sph_exact_column column = {*sph_group_eos(water), 1, 0, 1};
  const long n = sph_group_count(water);
  double sum = 0, exact = NAN;
  for (long i = 0; i < n; i++) {
    if (sph_exact_column_at(&column, 1, &y[i], NULL, &exact, NULL)) return NAN;
    sum += fabs(p[i] - exact) / rho0;
  }
  return sum / (double)n;
}

wall_rest wall_scene_rest(const char *model, const char *diffusion, double t)
{
  wall_rest rest = {NAN, NAN, 0};
  sph_sim *sim = tank(model, diffusion);
  if (sph_sim_run(sim, t) == SPH_OK) {
    sph_balance balance;
    sph_sim_stats stats;
    sph_sim_balance(sim, &balance);
    sph_sim_get_stats(sim, &stats);
    rest.error = pressure_error(sph_sim_group(sim, "water"));
    rest.motion = balance.kinetic / (balance.mass / 2);
    rest.seconds = stats.seconds;
  } else
    fprintf(stderr, "%s: %s\n", model, sph_sim_error(sim));
  sph_sim_free(sim);
  return rest;
}

/* ---- channels ---- */

static void slide(void *ctx, double t, double displacement[3], double velocity[3],
                  double acceleration[3])
{
  (void)ctx, (void)t;
  for (int d = 0; d < 3; d++) displacement[d] = velocity[d] = acceleration[d] = 0;
  velocity[0] = 1;
}

static sph_sim *channel(const char *model, int couette, int n, double h_over_dx)
{
  const double dx = 1.0 / n, width = fmax(12, ceil(4.5 * h_over_dx)) * dx;
  const double lo[] = {0, 0}, hi[] = {width, 1};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = dx,
                                               .h_over_dx = h_over_dx,
                                               .periodic = {1},
                                               .length = {width, 1},
                                               .speed = 1});
  sph_group *water = sph_group_box(sim, "water", lo, hi, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, 10, 7));
  sph_group_set_viscosity(water, rho0);
  sph_boundary plate = wall_scene_boundary(model, 1);
  plate.tension = 1;
  wall_scene_box(sim, "lower", plate, lo, hi, "x- x+ y+");
  if (couette) plate.motion = slide;
  wall_scene_box(sim, "upper", plate, lo, hi, "x- x+ y-");
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  if (!couette) sph_sim_add_term(sim, sph_term_gravity((double[3]){8}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  return sim;
}

static double channel_error(const sph_sim *sim, int couette)
{
  const sph_exact_channel exact = {1, 1, couette ? 1 : 0, couette ? 0 : 8};
  const sph_group *water = sph_sim_group(sim, "water");
  const double *y = sph_group_read(water, "position", 1);
  const double *vx = sph_group_read(water, "velocity", 0);
  const long n = sph_group_count(water);
  double sum = 0, v = NAN;
  for (long i = 0; i < n; i++) {
    if (sph_exact_channel_at(&exact, sph_sim_time(sim), 1, &y[i], &v, NULL)) return NAN;
    sum += (vx[i] - v) * (vx[i] - v);
  }
  return sqrt(sum / (double)n);
}

void wall_scene_channel(const char *model, int couette, int n, double h_over_dx, int count,
                        double error[WALL_TIMES])
{
  sph_sim *sim = channel(model, couette, n, h_over_dx);
  for (int k = 0; k < count; k++) {
    error[k] = NAN;
    if (sph_sim_run(sim, wall_scene_times[k]) == SPH_OK) error[k] = channel_error(sim, couette);
  }
  if (sph_sim_status(sim)) fprintf(stderr, "%s: %s\n", model, sph_sim_error(sim));
  sph_sim_free(sim);
}

/* ---- cylinders ---- */

/* Rings of particles around the origin, radii r0 + (k + 1/2) dx for k in [from, to). */
static void add_rings(sph_group *group, double r0, long from, long to, double dx)
{
  for (long k = from; k < to; k++) {
    const double r = r0 + ((double)k + 0.5) * dx, around = round(2 * M_PI * r / dx);
    for (long a = 0; a < (long)around; a++) {
      const double angle = 2 * M_PI * ((double)a + 0.5 * (double)(k & 1)) / around;
      const double x = r * cos(angle), y = r * sin(angle);
      const double *const at[] = {&x, &y};
      sph_group_add_points(group, 1, at, rho0);
    }
  }
}

/* Each particle its share of its ring. */
static void share_rings(sph_group *group, double dx)
{
  const double *x = sph_group_read(group, "position", 0), *y = sph_group_read(group, "position", 1);
  double *m = sph_group_write(group, "mass", 0);
  for (long i = 0; m && i < sph_group_count(group); i++) {
    const double r = hypot(x[i], y[i]);
    m[i] = rho0 * 2 * M_PI * r * dx / round(2 * M_PI * r / dx);
  }
}

/* The inner cylinder turns, one radian a second. */
static void turn(void *ctx, double t, double turn[3])
{
  (void)ctx;
  turn[0] = t, turn[1] = 1, turn[2] = 0;
}

static double cylinders_error(const sph_group *water)
{
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  const double *u = sph_group_read(water, "velocity", 0), *v = sph_group_read(water, "velocity", 1);
  double sum = 0;
  const long n = sph_group_count(water);
  for (long i = 0; i < n; i++) { /* v = A r + B/r, 1 at r = 1, 0 at r = 2 */
    const double r = hypot(x[i], y[i]), exact = -r / 3 + 4 / (3 * r);
    const double off = (x[i] * v[i] - y[i] * u[i]) / r - exact;
    sum += off * off;
  }
  return sqrt(sum / (double)n);
}

double wall_scene_cylinders(const char *model, int n, double h_over_dx)
{
  const double dx = 1.0 / n;
  const long deep = (long)ceil(2 * h_over_dx - 1e-9);
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = h_over_dx, .speed = 1});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_group *inner = sph_group_create(sim, "inner", "wall");
  sph_group *outer = sph_group_create(sim, "outer", "wall");
  sph_boundary plate = wall_scene_boundary(model, 1);
  plate.tension = 1;
  add_rings(water, 1, 0, n, dx);
  add_rings(inner, 1, -deep, 0, dx);
  add_rings(outer, 2, 0, deep, dx);
  sph_group_set_eos(water, sph_eos_tait(rho0, 10, 7));
  sph_group_set_viscosity(water, rho0);
  sph_group_set_boundary(outer, plate);
  plate.rotation = turn;
  sph_group_set_boundary(inner, plate);
  share_rings(water, dx);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  double error = NAN;
  if (sph_sim_run(sim, 1) == SPH_OK) /* the slowest mode, exp(-9.75 t), is 6e-5 of its start */
    error = cylinders_error(water);
  else
    fprintf(stderr, "%s: %s\n", model, sph_sim_error(sim));
  sph_sim_free(sim);
  return error;
}

/* ---- heat ---- */

/* A surface behind x = 0 or x = 1 with these. */
static void surface(sph_sim *sim, const char *model, int left, double T, double q)
{
  const double lo[] = {0}, hi[] = {1};
  sph_boundary b = wall_scene_boundary(model, 0);
  b.temperature = T;
  b.heat_flux = q;
  wall_scene_box(sim, left ? "left" : "right", b, lo, hi, left ? "x+" : "x-");
}

/* T - 300 at x, t, of a slab with kappa = rho c_v = 1. */
static double slab_exact(const char *kind, double x, double t)
{
  double T = !strcmp(kind, "dirichlet") ? 1 : 0;
  for (int k = 1; k < 200; k += 2) /* 1 - sum 4/(pi k) sin(k pi x) exp(-k^2 pi^2 t) */
    if (!strcmp(kind, "dirichlet"))
      T -= 4 / (M_PI * k) * sin(k * M_PI * x) * exp(-k * k * M_PI * M_PI * t);
  if (!strcmp(kind, "neumann")) return cos(M_PI * x) * exp(-M_PI * M_PI * t);
  if (strcmp(kind, "flux")) return T;
  T = t + (3 * (1 - x) * (1 - x) - 1) / 6; /* q = 1 enters at x = 0 (Carslaw & Jaeger 1959, 3.8) */
  for (int k = 1; k < 100; k++)
    T -= 2 / (M_PI * M_PI) / (k * k) * exp(-k * k * M_PI * M_PI * t) * cos(k * M_PI * x);
  return T;
}

double wall_scene_slab(const char *model, const char *kind, int n)
{
  const double t = 0.1;
  const int given = !strcmp(kind, "dirichlet"), flux = !strcmp(kind, "flux");
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 1, .dx = 1.0 / n, .h_over_dx = 2 * sqrt(n / 20.), .speed = 1});
  sph_group *slab = sph_group_box(sim, "slab", (double[]){0}, (double[]){1}, 1);
  sph_eos eos = sph_eos_linear(1, 10, -INFINITY);
  eos.c_v = 1;
  sph_group_set_eos(slab, eos);
  sph_group_set_conductivity(slab, 1);
  sph_group_set_energy(slab, "temperature");
  surface(sim, model, 1, given ? 301 : 0, flux ? 1 : 0);
  surface(sim, model, 0, given ? 301 : 0, 0);
  sph_sim_add_term(sim, sph_term_continuity()); /* dbc asks for it; nothing moves */
  sph_sim_add_term(sim, sph_term_conduction());
  sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-6});
  double *u = sph_group_write(slab, "energy", 0);
  const double *x = sph_group_read(slab, "position", 0);
  const long count = sph_group_count(slab);
  for (long i = 0; u && i < count; i++)
    u[i] = 300 + (!strcmp(kind, "neumann") ? cos(M_PI * x[i]) : 0);
  double sum = 0;
  if (sph_sim_run(sim, t)) fprintf(stderr, "%s, %s: %s\n", model, kind, sph_sim_error(sim));
  const double *T = sph_group_read(slab, "temperature", 0);
  x = sph_group_read(slab, "position", 0); /* it has moved into the ODE vector */
  for (long i = 0; T && i < count; i++) {
    const double off = T[i] - 300 - slab_exact(kind, x[i], t);
    sum += off * off;
  }
  const int status = sph_sim_status(sim);
  sph_sim_free(sim);
  return status ? NAN : sqrt(sum / (double)count);
}

/* ---- impact ---- */

static double energy_of(sph_sim *sim)
{
  sph_balance b;
  sph_sim_balance(sim, &b);
  return b.kinetic + b.potential;
}

/* Distances to the walls of the tank [0, L] x [0, top]. */
typedef struct watch {
  double L, top, dx, least;
  long lost;
} watch;

static int look(void *ctx, sph_sim *sim, sph_error *error)
{
  watch *w = ctx;
  const sph_group *water = sph_sim_group(sim, "water");
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  (void)error;
  w->lost = 0;
  for (long i = 0; i < sph_group_count(water); i++) {
    const double near = fmin(fmin(x[i], w->L - x[i]), y[i]) / w->dx;
    w->least = fmin(w->least, near);
    w->lost += near < -1;
  }
  return SPH_OK;
}

wall_impact wall_scene_impact(const char *model, int n, double t_end)
{
  const double H = 0.6, g = 9.81, dx = H / n, L = dx * rint(5.366 * H / dx);
  const double lo[] = {0, 0}, hi[] = {L, 2.5 * H};
  watch w = {L, hi[1], dx, INFINITY, 0};
  wall_impact result = {.least = NAN};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", lo, (double[]){2 * H, H}, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, 10 * sqrt(2 * g * H), 7));
  wall_scene_box(sim, "tank", wall_scene_boundary(model, 0), lo, hi, "y+");
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g, 0}));
  sph_group_set_hydrostatic(water, 1, H, g);
  sph_sim_add_output(sim,
                     (sph_output){.name = "walls", .interval = 0.01, .frame = look, .ctx = &w});
  const double start = energy_of(sim);
  result.status = sph_sim_run(sim, t_end);
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  snprintf(result.error, sizeof result.error, "%s", sph_sim_error(sim));
  result.particles = sph_group_count(water);
  result.lost = w.lost;
  result.least = w.least;
  result.energy = energy_of(sim) / start;
  result.seconds = stats.seconds;
  sph_sim_free(sim);
  return result;
}

/* ---- a manufactured solution between plates ---- */

static double wavy(void *ctx, const double x[3], double t)
{
  (void)ctx, (void)t;
  return rho0 * (1 + 0.01 * cos(2 * M_PI * x[0]) * cos(2 * M_PI * x[1]));
}

/* rho v = curl psi, as in test_manufactured.c: at rest at y = 0, 1; sliding there without shear. */
static void sticking(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * M_PI, y = x[1], s = rho0 / wavy(ctx, x, t), c = cos(2 * M_PI * t);
  v[0] = s * (4 * y * (1 - y) + 4 * y * (1 - y) * (1 - 2 * y) * cos(k * x[0]) * c);
  v[1] = s * k * 2 * y * y * (1 - y) * (1 - y) * sin(k * x[0]) * c;
}

static void sliding(void *ctx, const double x[3], double t, double v[3])
{
  const double k = 2 * M_PI, s = rho0 / wavy(ctx, x, t), c = cos(2 * M_PI * t) / 2;
  v[0] = s * cos(M_PI * x[1]) * (1 + cos(k * x[0]) * c);
  v[1] = s * sin(M_PI * x[1]) * 2 * sin(k * x[0]) * c;
}

void wall_scene_manufactured(const char *model, int no_slip, int n, double h_over_dx, double *v,
                             double *p)
{
  const double lo[] = {0, 0}, hi[] = {1, 1};
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2,
                                    .dx = 1.0 / n,
                                    .h_over_dx = h_over_dx > 0 ? h_over_dx : 1.5 * sqrt(n / 16.),
                                    .periodic = {1},
                                    .length = {1, 1},
                                    .speed = 1});
  sph_group *water = sph_group_box(sim, "water", lo, hi, rho0);
  sph_group_set_eos(water, sph_eos_linear(rho0, 10, -INFINITY));
  sph_group_set_viscosity(water, rho0 * 0.05);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_laminar("morris"));
  sph_manufactured_attach(water, &(sph_manufactured){.velocity = no_slip ? sticking : sliding,
                                                     .density = wavy,
                                                     .length = 1,
                                                     .time = 1});
  sph_boundary boundary = wall_scene_boundary(model, no_slip);
  boundary.tension = 1;
  wall_scene_box(sim, "plates", boundary, lo, hi, "x- x+");
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  sph_manufactured_error of_v = {NAN, NAN, NAN}, of_p = {NAN, NAN, NAN};
  if (sph_sim_run(sim, 0.1) == SPH_OK) {
    sph_manufactured_error_of(water, "velocity", &of_v);
    sph_manufactured_error_of(water, "pressure", &of_p);
  } else
    fprintf(stderr, "%s: %s\n", model, sph_sim_error(sim));
  *v = of_v.L1;
  *p = of_p.L1 / rho0;
  sph_sim_free(sim);
}
