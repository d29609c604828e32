#include "scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

static const double rho0_of_all = 1000; /* [kg/m^3] */

static const char *const kernels[ORACLE_KERNELS] = {
    [ORACLE_WENDLAND_C2] = "wendland-c2",  [ORACLE_WENDLAND_C4] = "wendland-c4",
    [ORACLE_WENDLAND_C6] = "wendland-c6",  [ORACLE_CUBIC] = "cubic-spline",
    [ORACLE_QUINTIC] = "quintic-spline",   [ORACLE_GAUSSIAN] = "gaussian",
    [ORACLE_SHIFTED] = "gaussian-shifted", [ORACLE_SPIKY] = "spiky"};

double scene_random(unsigned long *state)
{
  uint64_t z = *state += 0x9e3779b97f4a7c15u; /* splitmix64 */
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double between(unsigned long *state, double lo, double hi)
{
  return lo + (hi - lo) * scene_random(state);
}

/* ---- the cloud ---- */

/* Closest to any of the first i particles that i may not meet, nearest images. */
static double distance(const oracle *o, long i, const double x[3])
{
  real least = INFINITY;
  for (long j = 0; j < i; j++) {
    real r2 = 0;
    int dust = o->group[o->particle[i].group].dust;
    if (dust && o->particle[j].group != o->particle[i].group) continue;
    for (int k = 0; k < o->dim; k++) {
      real d = x[k] - o->particle[j].x[k];
      if (o->periodic[k]) d -= o->length[k] * roundl(d / o->length[k]);
      r2 += d * d;
    }
    if (r2 < least) least = r2;
  }
  return (double)sqrtl(least);
}

/* Particle i in or near cell number `cell`. */
static void place(scene *s, const scene_def *def, long i, const int cell[3], unsigned long *state)
{
  double x[3] = {0};
  do
    for (int k = 0; k < def->dim; k++) {
      int top = k == def->dim - 1; /* walls keep their side */
      x[k] = s->dx * (cell[k] + 0.5 + between(state, -0.2, 0.2));
      if (def->random)
        x[k] = s->dx * (top ? cell[k] + scene_random(state) : scene_random(state) * def->n);
    }
  while (def->random && distance(&s->o, i, x) < 0.3 * s->dx);
  for (int k = 0; k < 3; k++) s->o.particle[i].x[k] = x[k];
}

/* 0: first fluid, 1: second, 2: wall below, 3: wall above; 4, 5: dust. */
static int group_of(const scene_def *def, const int cell[3], int layer)
{
  int up = cell[def->dim - 1];
  if (layer > 0) return 3 + layer;
  if (def->walls > 0 && up < 3) return 2;
  if (def->walls > 1 && up >= def->n - 3) return 3;
  return def->fluids > 1 && cell[0] >= def->n / 2;
}

static void fill(scene *s, const scene_def *def, oracle_particle *it, unsigned long *state)
{
  double rho0 = rho0_of_all, volume = pow(s->dx, def->dim);
  if (def->outside && scene_random(state) < 0.2)
    for (int k = 0; k < def->dim; k++)
      if (def->periodic[k])
        it->x[k] = (double)(it->x[k] + s->o.length[k] * floor(between(state, -2, 3)));
  it->m = rho0 * volume;
  it->rho = rho0;
  it->u = 0;
  if (s->o.group[it->group].wall) return;
  for (int k = 0; k < def->dim; k++) it->v[k] = between(state, -1, 1);
  it->m = (double)it->m * between(state, 0.5, 1.5);
  it->rho = rho0 * (def->thermal ? between(state, 0.5, 1.5) : between(state, 0.97, 1.06));
  int dust = s->o.group[it->group].dust;
  if (dust) it->rho = (double)it->rho * between(state, 0.1, 3);
  if (!dust && (def->thermal || def->laminar)) it->u = between(state, 5, 25);
}

/* In half of all scenes the lid has a conductivity of its own; else it takes that of the fluid. */
static double lid(const scene_def *def)
{
  unsigned long dice = def->seed;
  return scene_random(&dice) < 0.5 ? 60 : 0;
}

static void groups(scene *s, const scene_def *def)
{
  oracle_eos tait = {ORACLE_TAIT, 1000, 10, 7, 0, 0}, linear = {ORACLE_LINEAR, 1000, 12, 1, 500, 0};
  oracle_eos gas = {ORACLE_IDEAL_GAS, 0, 0, 1.4, 0, 0};

  s->o.groups = ORACLE_GROUPS;
  for (int g = 0; g < ORACLE_GROUPS; g++) {
    oracle_group *group = &s->o.group[g];
    *group = (oracle_group){.wall = g == 2 || g == 3, .dust = g > 3, .tension = def->tension};
    group->no_slip = def->no_slip;
    group->repulsion = g == 3 ? 0.3L : g == 2 ? 0.1L : 0;
    group->rho0 = rho0_of_all;
    group->eos = def->thermal ? gas : g == 1 ? linear : tait;
    if (def->laminar && !group->dust) {
      group->eos.c_v = g == 1 ? 0.7 : 0.5;
      group->viscosity = g == 1 ? 3 : 2;
      group->conductivity = g == 1 ? 40 : g == 3 ? lid(def) : 15;
      group->temperature = g == 3 ? 22 : 0;
    }
    for (int k = 0; k < def->dim && g == 3; k++) {
      group->velocity[k] = 0.25 * (k + 1);
      group->acceleration[k] = 1.5 - k;
    }
  }
}

void scene_make(scene *s, const scene_def *def)
{
  unsigned long state = def->seed;
  long cells = 1, i = 0;
  int wide = sph_kernel_support(sph_kernel_find(kernels[def->kernel])) > 2; /* in small boxes */
  double h_over_dx = wide ? 1.1 : def->kernel == ORACLE_CUBIC ? 1.3 : 1.5;
  *s = (scene){.dx = 0.1, .h_over_dx = h_over_dx, .thermal = def->thermal};
  s->o.dim = def->dim, s->o.kernel = (enum oracle_kernel)def->kernel;
  s->o.h = s->h_over_dx * s->dx;
  s->o.dx = s->dx;
  for (int k = 0; k < def->dim; k++) {
    cells *= def->n;
    s->o.periodic[k] = def->periodic[k];
    s->o.length[k] = def->n * s->dx;
  }
  groups(s, def);
  s->o.n = cells * (1 + def->dusts);
  s->o.particle = calloc((size_t)s->o.n, sizeof *s->o.particle);
  assert_non_null(s->o.particle);
  for (int g = 0; g < ORACLE_GROUPS; g++)
    for (long c = 0; c < cells && g <= 3 + def->dusts; c++) {
      int cell[3] = {(int)(c % def->n), (int)(c / def->n % def->n), (int)(c / def->n / def->n)};
      if (group_of(def, cell, g > 3 ? g - 3 : 0) != g) continue;
      s->o.particle[i].group = g;
      place(s, def, i++, cell, &state);
    }
  for (i = 0; i < s->o.n; i++) fill(s, def, &s->o.particle[i], &state);
}

void scene_free(scene *s) { free(s->o.particle); }

/* ---- the library's side ---- */

static const char *const names[ORACLE_GROUPS] = {"water", "oil", "floor", "lid", "dust", "sand"};

static void move(void *ctx, double t, double displacement[3], double velocity[3],
                 double acceleration[3])
{
  const oracle_group *group = ctx;
  (void)t;
  for (int k = 0; k < 3; k++) {
    displacement[k] = 0;
    velocity[k] = (double)group->velocity[k];
    acceleration[k] = (double)group->acceleration[k];
  }
}

static sph_eos library_eos(const oracle_eos *eos)
{
  sph_eos it = eos->kind == ORACLE_IDEAL_GAS ? sph_eos_ideal_gas((double)eos->gamma)
               : eos->kind == ORACLE_TAIT
                   ? sph_eos_tait((double)eos->rho0, (double)eos->c0, (double)eos->gamma)
                   : sph_eos_linear((double)eos->rho0, (double)eos->c0, -INFINITY);
  if (eos->kind != ORACLE_IDEAL_GAS) it.p_background = (double)eos->p_background;
  it.c_v = (double)eos->c_v;
  return it;
}

static const char *const energies[] = {"none", "u", "total", "entropy", "temperature"};
static const char *const energy_fields[] = {"energy", "energy", "total_energy", "entropic_function",
                                            "temperature"};

static int has_energy(const scene *s) { return s->thermal || s->o.energy; }

static long first_of(const oracle *o, int g)
{
  long i = 0;
  while (i < o->n && o->particle[i].group < g) i++;
  return i;
}

static void add_group(scene *s, sph_sim *sim, int g)
{
  oracle *o = &s->o;
  long first = first_of(o, g), n = first_of(o, g + 1) - first;
  if (n == 0) return;
  double *x[3];
  for (int k = 0; k < 3; k++) {
    x[k] = malloc((size_t)n * sizeof(double));
    for (long i = 0; i < n; i++) x[k][i] = (double)o->particle[first + i].x[k];
  }
  sph_group *group = sph_group_create(sim, names[g], o->group[g].wall ? "wall" : "fluid");
  sph_group_add_points(group, n, (const double *const *)x, rho0_of_all);
  for (int k = 0; k < 3; k++) free(x[k]);
  sph_group_set_viscosity(group, (double)o->group[g].viscosity);
  sph_group_set_conductivity(group, (double)o->group[g].conductivity);
  if (o->group[g].dust) {
    sph_group_set_eos(group, sph_eos_dust());
    return;
  }
  if (!o->group[g].wall) {
    sph_group_set_eos(group, library_eos(&o->group[g].eos));
    if (o->energy) sph_group_set_energy(group, energies[o->energy]);
    return;
  }
  sph_boundary boundary = o->group[g].no_slip ? sph_boundary_adami_no_slip() : sph_boundary_adami();
  boundary.tension = o->group[g].tension;
  sph_group_set_repulsion(group, (double)o->group[g].repulsion);
  boundary.temperature = (double)o->group[g].temperature;
  boundary.motion = g == 3 ? move : NULL;
  boundary.ctx = &o->group[g];
  sph_group_set_boundary(group, boundary);
}

static const char *const corrections[] = {NULL, "one-sided", "mean"};

static void add_rows(const oracle *o, sph_sim *sim)
{
  static const char *const continuity[] = {NULL, "c1", "c2"}, *const pressure[] = {NULL, "s", "c2",
                                                                                   "phi"};
  if (o->summed)
    sph_sim_add_term(sim, sph_term_summation(0));
  else if (o->continuity) {
    sph_term term = o->continuity == ORACLE_PHI
                        ? sph_term_continuity_phi((double)o->exponent)
                        : sph_term_continuity_form(continuity[o->continuity]);
    sph_sim_add_term(sim, sph_term_corrected(term, corrections[o->continuity_corrected]));
  }
  if (o->pressure)
    sph_sim_add_term(sim, sph_term_corrected(sph_term_pressure_form(pressure[o->pressure]),
                                             corrections[o->pressure_corrected]));
}

static void add_viscosity(const oracle *o, sph_sim *sim, sph_term term)
{
  static const char *const alpha[] = {"", "morris-monaghan", "cullen-dehnen"};
  char switches[64];
  snprintf(switches, sizeof switches, "%s %s", alpha[o->varied], o->balsara ? "balsara" : "none");
  sph_sim_add_term(sim, sph_term_switched(term, switches, (double)o->alpha_min));
}

static void add_terms(const oracle *o, sph_sim *sim)
{
  static const char *const delta[] = {NULL, "molteni", "antuono", "fourtakas"};
  add_rows(o, sim);
  if (o->alpha > 0 || o->beta > 0)
    add_viscosity(o, sim, sph_term_viscosity_artificial((double)o->alpha, (double)o->beta));
  if (o->signal_alpha > 0)
    add_viscosity(o, sim,
                  sph_term_viscosity_signal((double)o->signal_alpha, (double)o->signal_beta));
  if (o->laminar)
    sph_sim_add_term(sim, sph_term_corrected(sph_term_viscosity_laminar(
                                                 o->laminar == ORACLE_MCG ? "mcg" : "morris"),
                                             corrections[o->laminar_corrected]));
  if (o->conductivity > 0)
    sph_sim_add_term(sim, sph_term_conductivity_artificial((double)o->conductivity));
  if (o->conduction) sph_sim_add_term(sim, sph_term_conduction());
  if (o->epsilon > 0) sph_sim_add_term(sim, sph_term_xsph((double)o->epsilon));
  if (o->drag)
    sph_sim_add_term(sim, o->drag_rate > 0 ? sph_term_drag_time(1 / (double)o->drag_rate)
                                           : sph_term_drag((double)o->drag_K));
  if (o->diffusion) sph_sim_add_term(sim, sph_term_delta(delta[o->diffusion], (double)o->delta));
  double g[3] = {(double)o->g[0], (double)o->g[1], (double)o->g[2]};
  if (g[0] != 0 || g[1] != 0 || g[2] != 0) sph_sim_add_term(sim, sph_term_gravity(g));
  if (o->omega > 0) sph_sim_add_term(sim, sph_term_harmonic((double)o->omega));
}

void scene_write(const scene *s, sph_sim *sim)
{
  const oracle *o = &s->o;
  for (int g = 0; g < ORACLE_GROUPS; g++) {
    sph_group *group = sph_sim_group(sim, names[g]);
    long first = first_of(o, g), n = first_of(o, g + 1) - first;
    if (n == 0 || o->group[g].wall) continue;
    for (int k = 0; k < o->dim; k++) {
      double *x = sph_group_write(group, "position", k), *v = sph_group_write(group, "velocity", k);
      for (long i = 0; x && v && i < n; i++) {
        x[i] = (double)o->particle[first + i].x[k];
        v[i] = (double)o->particle[first + i].v[k];
      }
    }
    double *m = sph_group_write(group, "mass", 0), *rho = sph_group_write(group, "density", 0);
    double *u = has_energy(s) && !o->group[g].dust ? sph_group_write(group, "energy", 0) : NULL;
    double *alpha = o->varied ? sph_group_write(group, "alpha", 0) : NULL;
    for (long i = 0; alpha && i < n; i++) alpha[i] = (double)o->particle[first + i].alpha;
    for (long i = 0; m && rho && i < n; i++) {
      m[i] = (double)o->particle[first + i].m;
      rho[i] = (double)o->particle[first + i].rho;
      if (u) u[i] = (double)o->particle[first + i].u;
    }
  }
}

sph_sim *scene_sim(scene *s, scene_options options)
{
  const oracle *o = &s->o;
  sph_sim_def def = {.dim = o->dim,
                     .dx = s->dx,
                     .kernel = kernels[o->kernel],
                     .h_over_dx = s->h_over_dx,
                     .threads = options.threads,
                     .skin = options.skin,
                     .search = options.neighbors,
                     .isa = options.isa,
                     .precision = options.precision};
  for (int k = 0; k < o->dim; k++) {
    def.periodic[k] = o->periodic[k];
    def.length[k] = o->periodic[k] ? (double)o->length[k] : 0;
  }
  sph_sim *sim = sph_sim_create(&def);
  for (int g = 0; g < ORACLE_GROUPS; g++) add_group(s, sim, g);
  add_terms(o, sim);
  scene_write(s, sim);
  assert_string_equal(sph_sim_error(sim), "");
  return sim;
}

/* ---- what it found ---- */

static void copy(double *to, long first, long n, const double *from)
{
  assert_non_null(from);
  memcpy(to + first, from, (size_t)n * sizeof(double));
}

scene_rates scene_evaluate(const scene *s, sph_sim *sim)
{
  const oracle *o = &s->o;
  scene_rates r = {.n = o->n};
  double **all[] = {&r.dx[0], &r.dx[1], &r.dx[2], &r.a[0], &r.a[1], &r.a[2],
                    &r.drho,  &r.du,    &r.p,     &r.c,    &r.rho,  &r.dalpha};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++)
    *all[k] = calloc((size_t)o->n, sizeof(double));
  int status = sph_sim_evaluate(sim);
  if (status != SPH_OK) fail_msg("status %d: %s", status, sph_sim_error(sim));
  for (int g = 0; g < ORACLE_GROUPS; g++) {
    sph_group *group = sph_sim_group(sim, names[g]);
    long first = first_of(o, g), n = first_of(o, g + 1) - first;
    if (n == 0) continue;
    copy(r.p, first, n, sph_group_read(group, "pressure", 0));
    copy(r.rho, first, n, sph_group_read(group, "density", 0));
    if (o->group[g].wall) continue;
    copy(r.c, first, n, sph_group_read(group, "sound_speed", 0));
    if (o->varied) copy(r.dalpha, first, n, sph_group_rate(group, "alpha", 0));
    if (!o->summed) copy(r.drho, first, n, sph_group_rate(group, "density", 0));
    for (int k = 0; k < o->dim; k++) {
      copy(r.dx[k], first, n, sph_group_rate(group, "position", k));
      copy(r.a[k], first, n, sph_group_rate(group, "velocity", k));
    }
    if (has_energy(s) && !o->group[g].dust)
      copy(r.du, first, n, sph_group_rate(group, energy_fields[o->energy], 0));
  }
  return r;
}

void scene_rates_free(scene_rates *r)
{
  double *all[] = {r->dx[0], r->dx[1], r->dx[2], r->a[0], r->a[1], r->a[2],
                   r->drho,  r->du,    r->p,     r->c,    r->rho,  r->dalpha};
  for (size_t k = 0; k < sizeof all / sizeof *all; k++) free(all[k]);
}

int scene_rates_same(const scene_rates *a, const scene_rates *b)
{
  size_t bytes = (size_t)a->n * sizeof(double);
  return a->n == b->n && !memcmp(a->dx[0], b->dx[0], bytes) && !memcmp(a->a[0], b->a[0], bytes) &&
         !memcmp(a->a[1], b->a[1], bytes) && !memcmp(a->a[2], b->a[2], bytes) &&
         !memcmp(a->drho, b->drho, bytes) && !memcmp(a->du, b->du, bytes) &&
         !memcmp(a->p, b->p, bytes) && !memcmp(a->dalpha, b->dalpha, bytes) &&
         !memcmp(a->rho, b->rho, bytes);
}
