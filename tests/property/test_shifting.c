/* Shifting, transport velocity and artificial stress against a brute force in long double, written
 * from the equations alone (docs/theory.md): dv, the surface that it keeps, what follows; and what
 * is conserved, where particles go, what is refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "cpu.h"
#include "scene.h"

/* ---- the brute force ---- */

typedef struct numbers {                        /* of the terms */
  int transport, surface, advection, corrected; /* corrected: gradients of continuity */
  real speed, strength, crowding, background, time, stress_alpha, stress_beta;
} numbers;

typedef struct place {
  real dv[3], normal[3], size, least;
  int flag;
} place;

typedef struct brute {
  const scene *s;
  numbers k;
  place *at; /* [n] */
  long surface;
} brute;

static real dot(const real a[3], const real b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static real norm(const real a[3]) { return sqrtl(dot(a, a)); }

static int is_wall(const oracle *o, long i) { return o->group[o->particle[i].group].wall; }

static real volume(const oracle *o, long j)
{
  const oracle_particle *it = &o->particle[j];
  return is_wall(o, j) ? it->volume : it->m / it->rho;
}

/* r = x_i - x_j of the nearest image; 0: out of the support. */
static real apart(const scene *s, long i, long j, real r[3])
{
  const oracle *o = &s->o;
  for (int d = 0; d < 3; d++) {
    r[d] = o->particle[i].x[d] - o->particle[j].x[d];
    if (d < o->dim && o->periodic[d]) r[d] -= o->length[d] * roundl(r[d] / o->length[d]);
  }
  real distance = norm(r);
  return i != j && oracle_w(o, distance) > 0 ? distance : 0;
}

/* The least eigenvalue of a symmetric matrix (3D: Smith 1961). */
static real least_of(int dim, real M[3][3])
{
  if (dim == 1) return M[0][0];
  if (dim == 2) return (M[0][0] + M[1][1]) / 2 - hypotl((M[0][0] - M[1][1]) / 2, M[0][1]);
  real q = (M[0][0] + M[1][1] + M[2][2]) / 3, p2 = 0, B[3][3];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) p2 += powl(M[a][b] - (a == b ? q : 0), 2);
  real p = sqrtl(p2 / 6);
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) B[a][b] = (M[a][b] - (a == b ? q : 0)) / p;
  real det = B[0][0] * (B[1][1] * B[2][2] - B[1][2] * B[2][1]) -
             B[0][1] * (B[1][0] * B[2][2] - B[1][2] * B[2][0]) +
             B[0][2] * (B[1][0] * B[2][1] - B[1][1] * B[2][0]);
  real angle = acosl(fmaxl(-1, fminl(1, det / 2))) / 3;
  return q + 2 * p * cosl(angle + 2 * acosl(-1) / 3);
}

/* x = M^-1 x by Cramer's rule, in 1D to 3D. */
static void solve(int dim, real M[3][3], real x[3])
{
  real A[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, y[3] = {0};
  for (int a = 0; a < dim; a++)
    for (int b = 0; b < dim; b++) A[a][b] = M[a][b];
  real det = 0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      int a1 = (a + 1) % 3, a2 = (a + 2) % 3, b1 = (b + 1) % 3, b2 = (b + 2) % 3;
      real minor = A[a1][b1] * A[a2][b2] - A[a1][b2] * A[a2][b1];
      y[b] += minor * x[a];
      if (a == 0) det += A[0][b] * minor;
    }
  for (int d = 0; d < 3; d++) x[d] = y[d] / det;
}

static void drift(const brute *b, long i)
{
  const oracle *o = &b->s->o;
  place *it = &b->at[i];
  const real W0 = oracle_w(o, (real)b->s->dx), h = o->h;
  const oracle_particle *particle = &o->particle[i];
  real M[3][3] = {{0}}, C[3] = {0}, V_i = volume(o, i);
  for (long j = 0; j < o->n; j++) {
    real r[3], distance = apart(b->s, i, j, r), V = volume(o, j), weight;
    if (distance == 0) continue;
    real F = oracle_f(o, distance);
    if (b->k.transport) {
      const oracle_eos *eos = &o->group[particle->group].eos;
      real tau = b->k.time > 0 ? b->k.time : 0.1L * h / eos->c0;
      real p_b = b->k.background > 0 ? b->k.background : eos->rho0 * eos->c0 * eos->c0;
      weight = tau * p_b / particle->m * (V_i * V_i + V * V);
    } else
      weight = 2 * b->k.strength * h * b->k.speed * V *
               (1 + b->k.crowding * powl(oracle_w(o, distance) / W0, 4));
    for (int d = 0; d < 3; d++) it->dv[d] -= weight * F * r[d], C[d] += V * F * r[d];
    it->size += weight * fabsl(F) * distance * (1 + 8 / (1 - distance / (3 * h)));
    for (int d = 0; d < 3; d++)
      for (int c = 0; c < 3; c++) M[d][c] -= V * F * r[d] * r[c];
  }
  real length = norm(it->dv), most = b->k.speed / 2;
  for (int d = 0; d < 3 && !b->k.transport && length > most; d++) it->dv[d] *= most / length;
  it->least = least_of(o->dim, M);
  if (it->least > 0.75L) return;
  if (it->least < 0.2L) {
    for (int d = 0; d < 3 && b->k.surface; d++) it->dv[d] = 0;
    return;
  }
  it->flag = 1;
  solve(o->dim, M, C);
  for (int d = 0; d < 3; d++) it->normal[d] = -C[d] / norm(C);
}

/* Is anybody in the cone around the normal, or the half ball on top of it? */
static int covered(const brute *b, long i)
{
  const oracle *o = &b->s->o;
  const int wide =
      o->kernel == ORACLE_QUINTIC || o->kernel == ORACLE_GAUSSIAN || o->kernel == ORACLE_SHIFTED;
  const real L = (wide ? 3 : 2) * o->h / 2;
  for (long j = 0; j < o->n; j++) {
    real r[3], top[3], distance = apart(b->s, i, j, r);
    if (distance == 0) continue;
    for (int d = 0; d < 3; d++) top[d] = -r[d] - L * b->at[i].normal[d];
    real angle = acosl(-dot(r, b->at[i].normal) / distance);
    if (distance < sqrtl(2) * L ? angle < acosl(-1) / 4 : norm(top) < L) return 1;
  }
  return 0;
}

static void project(const brute *b, long i)
{
  const oracle *o = &b->s->o;
  place *it = &b->at[i];
  real n[3] = {0};
  int near = 0;
  for (long j = 0; j < o->n; j++) {
    real r[3], distance = apart(b->s, i, j, r);
    if ((distance == 0 && j != i) || !b->at[j].flag) continue;
    near = 1;
    for (int d = 0; d < 3; d++) n[d] += oracle_w(o, distance) * b->at[j].normal[d];
  }
  if (!near) return;
  real along = dot(it->dv, n) / dot(n, n);
  for (int d = 0; d < 3; d++) it->dv[d] -= along * n[d];
  it->size *= 100; /* normals solve with M */
}

static void follow(const brute *b, long i)
{
  const oracle *o = &b->s->o;
  oracle_particle *it = &o->particle[i];
  const real *dv_i = b->at[i].dv, V_i = volume(o, i);
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    real r[3], gradient[3], distance = apart(b->s, i, j, r), V = volume(o, j);
    if (distance == 0) continue;
    const real F = oracle_f(o, distance), *dv_j = b->at[j].dv;
    for (int d = 0; d < 3; d++) gradient[d] = r[d] * F;
    real from_i = dot(dv_i, gradient), from_j = dot(dv_j, gradient);
    real most = (b->at[i].size + b->at[j].size) * distance * fabsl(F);
    if (b->k.corrected)
      it->drho += V * (other->rho - it->rho) * from_j;
    else
      it->drho += it->rho * V * (from_i - from_j) + V * (it->rho * from_i + other->rho * from_j);
    it->drho_size += 4 * V * it->rho * most;
    for (int d = 0; d < 3; d++)
      if (b->k.transport)
        it->a[d] += (V_i * V_i + V * V) / it->m / 2 *
                    (it->rho * it->v[d] * from_i + other->rho * other->v[d] * from_j);
      else if (!is_wall(o, j))
        it->a[d] += V * (other->v[d] - it->v[d]) * from_i;
    it->a_size += 4 * (V + V_i) * (norm(it->v) + norm(other->v)) * most;
  }
}

static void stress(const brute *b, long i)
{
  const oracle *o = &b->s->o;
  oracle_particle *it = &o->particle[i];
  const real W0 = oracle_w(o, (real)b->s->dx), alpha = b->k.stress_alpha, beta = b->k.stress_beta;
  for (long j = 0; j < o->n; j++) {
    const oracle_particle *other = &o->particle[j];
    real r[3], distance = apart(b->s, i, j, r), rv = 0;
    if (distance == 0) continue;
    real s_i = it->p / (it->rho * it->rho), s_j = other->p / (other->rho * other->rho);
    real R = (s_i < 0 ? -alpha * s_i : 0) + (s_j < 0 ? -alpha * s_j : 0);
    if (s_i > 0 && s_j > 0) R = beta * (s_i + s_j);
    R *= other->rho * volume(o, j) * powl(oracle_w(o, distance) / W0, 4) * oracle_f(o, distance);
    real size = fabsl(R) * distance * (1 + 40 / (1 - distance / (3 * o->h))) +
                (alpha + beta) *
                    (it->p_size / (it->rho * it->rho) + other->p_size / (other->rho * other->rho)) *
                    other->m * powl(oracle_w(o, distance) / W0, 4) * fabsl(oracle_f(o, distance)) *
                    distance;
    for (int d = 0; d < 3; d++) it->a[d] -= R * r[d], rv += r[d] * (it->v[d] - other->v[d]);
    it->a_size += size;
    it->du += R * rv / 2;
    it->du_size += size * (norm(it->v) + norm(other->v));
  }
}

/* On top of what oracle_evaluate found. */
static brute brute_evaluate(const scene *s, numbers k)
{
  const oracle *o = &s->o;
  brute b = {s, k, calloc((size_t)o->n, sizeof(place)), 0};
  assert_non_null(b.at);
  const int moves = k.transport || k.strength > 0;
  for (long i = 0; moves && i < o->n; i++)
    if (!is_wall(o, i)) drift(&b, i);
  for (long i = 0; moves && i < o->n; i++)
    if (b.at[i].flag && covered(&b, i)) b.at[i].flag = 0;
  for (long i = 0; i < o->n; i++) b.surface += b.at[i].flag;
  for (long i = 0; moves && k.surface && i < o->n; i++)
    if (!is_wall(o, i)) project(&b, i);
  for (long i = 0; i < o->n; i++) {
    if (is_wall(o, i)) continue;
    for (int d = 0; d < 3; d++) o->particle[i].dx[d] += b.at[i].dv[d];
    o->particle[i].dx_size += b.at[i].size;
    if (moves && k.advection) follow(&b, i);
    if (k.stress_alpha + k.stress_beta > 0) stress(&b, i);
  }
  return b;
}

/* ---- the library ---- */

static void add_terms(sph_sim *sim, const numbers *k)
{
  if (k->transport) {
    sph_term term = sph_term_transport_velocity((double)k->background, (double)k->time);
    term.advection = k->advection;
    sph_sim_add_term(sim, term);
  } else if (k->strength > 0) {
    sph_term term = sph_term_shifting(k->crowding > 0 ? "delta-plus" : "fick", (double)k->speed);
    term.strength = (double)k->strength;
    term.crowding = (double)k->crowding;
    term.surface = k->surface;
    term.advection = k->advection;
    sph_sim_add_term(sim, term);
  }
  if (k->stress_alpha + k->stress_beta > 0)
    sph_sim_add_term(sim,
                     sph_term_stress_artificial((double)k->stress_alpha, (double)k->stress_beta));
}

static double worst;

static void same(const char *what, const scene_def *def, long i, double found, real expected,
                 real size)
{
  double error = size > 0 ? (double)(fabsl(found - expected) / size) : fabs(found);
  if (error > worst) worst = error;
  if (error <= 1e-14) return; /* NaN fails */
  fail_msg("%s of particle %ld (seed %lu, %dD, kernel %d): %.17g, brute force %.17Lg, error %g of "
           "size %Lg",
           what, i, def->seed, def->dim, def->kernel, found, expected, error, size);
}

static void compare(const scene *s, const scene_def *def, const scene_rates *r)
{
  for (long i = 0; i < s->o.n; i++) {
    const oracle_particle *it = &s->o.particle[i];
    if (is_wall(&s->o, i)) continue;
    for (int d = 0; d < def->dim; d++) {
      same("dx", def, i, r->dx[d][i], it->dx[d], it->dx_size);
      same("a", def, i, r->a[d][i], it->a[d], it->a_size);
    }
    if (!s->o.summed) same("drho", def, i, r->drho[i], it->drho, it->drho_size);
    if (def->thermal || s->o.energy) same("du", def, i, r->du[i], it->du, it->du_size);
  }
}

/* Returns the particles at the surface. */
static long check(scene_def def, numbers k, int even, int energy)
{
  static const char *const isa[] = {NULL, "reference", SPH_ISA_TWO_LANES};
  scene s;
  def.n = def.dim == 1 ? 40 : def.dim == 2 ? 14 : 8;
  scene_make(&s, &def);
  s.o.continuity = s.o.pressure = ORACLE_C2;
  if (k.corrected)
    s.o.continuity_corrected = ORACLE_ONE_SIDED, s.o.pressure_corrected = ORACLE_MEAN;
  s.o.energy = energy ? ORACLE_U : ORACLE_DEFAULT;
  for (long i = 0; i < s.o.n && even; i++)
    s.o.particle[i].m = (double)(s.o.particle[i].rho * powl(s.dx, def.dim));
  oracle_evaluate(&s.o);
  brute b = brute_evaluate(&s, k);
  for (int q = 0; q < 3; q++) {
    sph_sim *sim = scene_sim(&s, (scene_options){.isa = isa[q], .threads = 1 + q % 2});
    add_terms(sim, &k);
    scene_rates rates = scene_evaluate(&s, sim);
    compare(&s, &def, &rates);
    scene_rates_free(&rates);
    sph_sim_free(sim);
  }
  free(b.at);
  scene_free(&s);
  return b.surface;
}

static void shifting(void **state)
{
  (void)state;
  long surface = 0;
  worst = 0;
  for (int k = 0; k < 12; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .kernel = k % ORACLE_KERNELS,
                     .fluids = 1 + (k % 6 == 5),
                     .walls = k / 2 % 3,
                     .random = k / 3 % 2,
                     .seed = 700 + (unsigned long)k};
    def.periodic[0] = def.dim > 1 && k % 2;
    surface += check(def,
                     (numbers){.speed = k % 4 ? 3 : 0.125L,
                               .strength = 0.5L + k % 2,
                               .crowding = k % 3 == 1 ? 0 : 0.25L,
                               .surface = k % 4 != 3,
                               .advection = k % 6 != 5,
                               .corrected = k % 3 == 2},
                     k % 5 == 0, 0);
  }
  print_message("# %ld particles at surfaces; largest error: %.2g of size\n", surface, worst);
  assert_true(surface > 100);
}

static void transport(void **state)
{
  (void)state;
  worst = 0;
  for (int k = 0; k < 9; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .kernel = k % 7, /* not spiky */
                     .fluids = 1,
                     .walls = k / 3 % 2 ? 2 : 0,
                     .seed = 800 + (unsigned long)k};
    for (int d = 0; d < def.dim; d++) def.periodic[d] = !def.walls || d < def.dim - 1;
    long surface = check(def,
                         (numbers){.transport = 1,
                                   .background = k % 2 ? 5e4L : 0,
                                   .time = k % 3 ? 0.0009765625L : 0,
                                   .advection = k % 4 != 3},
                         1, 0);
    assert_int_equal(surface, 0);
  }
  print_message("# largest error: %.2g of size\n", worst);
}

static void artificial_stress(void **state)
{
  (void)state;
  worst = 0;
  for (int k = 0; k < 9; k++) {
    scene_def def = {.dim = 1 + k % 3,
                     .kernel = k % 7,
                     .fluids = 1 + k % 2,
                     .walls = k / 2 % 3,
                     .tension = k % 2,
                     .thermal = k % 4 == 1,
                     .random = k / 3 % 2,
                     .laminar = 1,
                     .seed = 900 + (unsigned long)k};
    check(def,
          (numbers){.stress_alpha = k % 3 ? 0.25L : 0, .stress_beta = k % 3 == 1 ? 0 : 0.0625L}, 0,
          k % 2 == 0);
  }
  print_message("# largest error: %.2g of size\n", worst);
}

/* ---- what stays ---- */

static scene periodic_scene(int dim, int thermal, unsigned long seed, int even)
{
  scene s;
  scene_def def = {
      .dim = dim, .n = dim == 3 ? 9 : 14, .fluids = 1, .thermal = thermal, .seed = seed};
  for (int d = 0; d < dim; d++) def.periodic[d] = 1;
  scene_make(&s, &def);
  s.o.continuity = s.o.pressure = ORACLE_C2;
  for (long i = 0; i < s.o.n && even; i++)
    s.o.particle[i].m = (double)(s.o.particle[i].rho * powl(s.dx, dim));
  return s;
}

/* Equal volumes: sum V dv = 0; the transport velocity keeps momentum whatever the volumes; so does
 * artificial stress, which keeps energy, too. */
static void sums(int dim, numbers k, int thermal, int even, int moves, int keeps)
{
  scene s = periodic_scene(dim, thermal, 40 + (unsigned long)dim, even);
  sph_sim *sim = scene_sim(&s, (scene_options){0});
  add_terms(sim, &k);
  scene_rates r = scene_evaluate(&s, sim);
  real energy = 0, energies = 0;
  for (int d = 0; d < dim; d++) {
    real drift = 0, drifts = 0, force = 0, forces = 0;
    for (long i = 0; i < s.o.n; i++) {
      const oracle_particle *it = &s.o.particle[i];
      real dv = r.dx[d][i] - it->v[d];
      drift += dv, drifts += fabsl(dv);
      force += it->m * r.a[d][i], forces += it->m * fabs(r.a[d][i]);
      energy += it->m * it->v[d] * r.a[d][i], energies += it->m * fabsl(it->v[d] * r.a[d][i]);
    }
    if (moves) assert_true(fabsl(drift) <= 1e-13 * drifts && drifts > 0);
    if (keeps) assert_true(fabsl(force) <= 1e-13 * forces && forces > 0);
  }
  for (long i = 0; i < s.o.n && thermal; i++) energy += s.o.particle[i].m * r.du[i];
  if (thermal) assert_true(fabsl(energy) <= 1e-13 * energies && energies > 0);
  scene_rates_free(&r);
  sph_sim_free(sim);
  scene_free(&s);
}

static void conservation(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    sums(dim, (numbers){.speed = 1, .strength = 0.25L, .crowding = 0.2L}, 0, 1, 1, 1);
    sums(dim, (numbers){.transport = 1, .advection = 1}, 0, 0, 0, 1);
    sums(dim, (numbers){.stress_alpha = 0.2L, .stress_beta = 0.01L}, 1, 0, 0, 1);
  }
}

/* Particles of a uniform flow are moved, its velocity not, to the last bit. */
static void a_uniform_flow_stays(void **state)
{
  (void)state;
  for (int dim = 2; dim <= 3; dim++) {
    scene s = periodic_scene(dim, 0, 60 + (unsigned long)dim, 0);
    const numbers k = {.speed = 1, .strength = 1, .crowding = 0.2L, .advection = 1};
    scene_rates rates[2];
    for (long i = 0; i < s.o.n; i++)
      for (int d = 0; d < dim; d++) s.o.particle[i].v[d] = 1 + d;
    for (int shifts = 0; shifts < 2; shifts++) {
      sph_sim *sim = scene_sim(&s, (scene_options){0});
      if (shifts) add_terms(sim, &k);
      rates[shifts] = scene_evaluate(&s, sim);
      sph_sim_free(sim);
    }
    const size_t bytes = (size_t)s.o.n * sizeof(double);
    for (int d = 0; d < dim; d++) {
      assert_memory_equal(rates[0].a[d], rates[1].a[d], bytes);
      assert_memory_not_equal(rates[0].dx[d], rates[1].dx[d], bytes);
    }
    scene_rates_free(&rates[0]), scene_rates_free(&rates[1]);
    scene_free(&s);
  }
}

/* ---- where particles go ---- */

static double crowd(const scene *s, scene_rates *r) /* rms of dv */
{
  double sum = 0;
  for (long i = 0; i < s->o.n; i++)
    for (int d = 0; d < s->o.dim; d++) sum += pow(r->dx[d][i] - (double)s->o.particle[i].v[d], 2);
  return sqrt(sum / (double)s->o.n);
}

/* Away from where they are many: dv, which is along grad C, becomes less on the way; on the
 * opposite way more. */
static void from_the_crowd(void **state)
{
  (void)state;
  for (int q = 0; q < 3; q++) {
    double rms[3];
    for (int way = 0; way < 3; way++) {
      scene s = periodic_scene(2, 0, 77, 1);
      const numbers k = {.transport = q == 2, .speed = 1, .strength = 1, .crowding = q ? 0.2L : 0};
      sph_sim *sim = scene_sim(&s, (scene_options){0});
      add_terms(sim, &k);
      scene_rates r = scene_evaluate(&s, sim);
      double dt = (way - 1) * 0.15 * (double)s.o.h; /* of speeds of about 1 */
      for (int steps = 0; steps < 4; steps++) {
        for (long i = 0; i < s.o.n; i++)
          for (int d = 0; d < 2; d++)
            s.o.particle[i].x[d] =
                (double)(s.o.particle[i].x[d] + dt / 4 * (r.dx[d][i] - s.o.particle[i].v[d]));
        scene_rates_free(&r);
        sph_sim_free(sim);
        sim = scene_sim(&s, (scene_options){0});
        add_terms(sim, &k);
        r = scene_evaluate(&s, sim);
      }
      rms[way] = crowd(&s, &r);
      scene_rates_free(&r);
      sph_sim_free(sim);
      scene_free(&s);
    }
    print_message("# rms of dv: %.3g behind a step against it, %.3g at the start, %.3g behind one "
                  "with it\n",
                  rms[0], rms[1], rms[2]);
    assert_true(rms[2] < 0.6 * rms[1] && rms[0] > 1.2 * rms[1]);
  }
}

/* A block at rest on its lattice, free on all sides, and a particle alone. */
static sph_sim *block(int surface)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){2, 2}, 1000);
  sph_group_add_box(water, (double[]){5, 5}, (double[]){5.1, 5.1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_term term = sph_term_shifting("delta-plus", 1);
  term.surface = surface;
  sph_sim_add_term(sim, term);
  return sim;
}

/* Particles of an edge stay on it, those of the middle of a face exactly; without that it
 * spreads. */
static void free_surface(void **state)
{
  (void)state;
  double most[2] = {0, 0};
  for (int surface = 0; surface < 2; surface++) {
    sph_sim *sim = block(surface);
    sph_group *water = sph_sim_group(sim, "water");
    assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
    const double *y = sph_group_read(water, "position", 1),
                 *x = sph_group_read(water, "position", 0);
    const double *up = sph_group_rate(water, "position", 1);
    long n = sph_group_count(water);
    for (long i = 0; i < n; i++)
      if (x[i] > 0.8 && x[i] < 1.2 && y[i] < 3) most[surface] = fmax(most[surface], fabs(up[i]));
    if (surface) assert_true(up[n - 1] == 0); /* alone */
    char text[200];
    int told = 0;
    for (int k = 0; sph_sim_warning(sim, k, text, sizeof text); k++)
      told |= strstr(text, "free surface") != NULL;
    assert_int_equal(told, !surface);
    sph_sim_free(sim);
  }
  print_message("# speed off the surface: %.3g, kept: %.3g\n", most[0], most[1]);
  assert_true(most[0] > 0.1 && most[1] < 1e-12);
}

/* ---- between steps ---- */

static sph_sim *waves(int shifts, long steps)
{
  sph_sim *sim =
      sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_jitter(water, 0.2, 3);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_term term = sph_term_shifting(NULL, 1);
  term.steps = steps;
  if (shifts) sph_sim_add_term(sim, term);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "midpoint", .dt_fixed = 2e-3});
  const long n = sph_group_count(water);
  const double *x = sph_group_read(water, "position", 0);
  double *v = sph_group_write(water, "velocity", 1);
  for (long i = 0; i < n; i++) v[i] = sin(6.283185307179586 * x[i]);
  return sim;
}

static const struct {
  const char *field;
  int component;
} fields[] = {{"position", 0}, {"position", 1}, {"velocity", 0}, {"velocity", 1}, {"density", 0}};
enum { FIELDS = sizeof fields / sizeof *fields };

static void copy_state(sph_group *to, const sph_group *from)
{
  for (int k = 0; k < FIELDS; k++)
    memcpy(sph_group_write(to, fields[k].field, fields[k].component),
           sph_group_read(from, fields[k].field, fields[k].component),
           (size_t)sph_group_count(to) * sizeof(double));
}

/* The sixth step, and the second shift, by tau times the rates that shifting adds to f there. */
static void between_steps(void **state)
{
  (void)state;
  sph_sim *plain = waves(0, 0), *between = waves(1, 3), *rates = waves(1, 0);
  sph_group *group[] = {sph_sim_group(plain, "water"), sph_sim_group(between, "water"),
                        sph_sim_group(rates, "water")};
  for (int k = 0; k < 5; k++) assert_int_equal(sph_sim_step(between), SPH_OK);
  copy_state(group[0], group[1]);
  assert_int_equal(sph_sim_step(between), SPH_OK);
  assert_int_equal(sph_sim_step(plain), SPH_OK);
  assert_int_equal(sph_sim_evaluate(plain), SPH_OK);
  copy_state(group[2], group[0]);
  assert_int_equal(sph_sim_evaluate(rates), SPH_OK);
  const double tau = 3 * sph_sim_time(plain); /* less than h/(8 U) = 0.019 s */
  const long n = sph_group_count(group[0]);
  double most = 0;
  for (int k = 0; k < FIELDS; k++) {
    const double *part[3], *rate[3];
    for (int q = 0; q < 3; q++) {
      part[q] = sph_group_read(group[q], fields[k].field, fields[k].component);
      rate[q] = sph_group_rate(group[q], fields[k].field, fields[k].component);
    }
    for (long i = 0; i < n; i++) {
      const double shift = tau * (rate[2][i] - rate[0][i]);
      const double scale = fabs(part[0][i]) + tau * fabs(rate[0][i]);
      assert_true(fabs(part[1][i] - part[0][i] - shift) <= 1e-13 * scale);
      most = fmax(most, fabs(shift) / scale);
    }
  }
  assert_true(most > 1e-4);
  sph_sim_free(plain), sph_sim_free(between), sph_sim_free(rates);
}

/* A run that goes on from a checkpoint between two shifts has the same bits. */
static void restart(void **state)
{
  (void)state;
  char directory[] = "shifting-XXXXXX", path[100];
  assert_non_null(mkdtemp(directory));
  snprintf(path, sizeof path, "%s/checkpoint_00000005.hdf", directory);
  sph_sim *whole = waves(1, 3), *late = waves(1, 3), *other = waves(1, 4);
  sph_checkpoint_set(whole, &(sph_checkpoint_def){.directory = directory});
  for (int k = 0; k < 5; k++) assert_int_equal(sph_sim_step(whole), SPH_OK);
  assert_int_equal(sph_checkpoint_write(whole), SPH_OK);
  if (sph_checkpoint_read(late, path)) fail_msg("%s", sph_sim_error(late));
  for (int k = 0; k < 5; k++) {
    assert_int_equal(sph_sim_step(whole), SPH_OK);
    assert_int_equal(sph_sim_step(late), SPH_OK);
  }
  for (int k = 0; k < 10; k++) assert_int_equal(sph_sim_step(other), SPH_OK);
  sph_group *group[] = {sph_sim_group(whole, "water"), sph_sim_group(late, "water"),
                        sph_sim_group(other, "water")};
  const size_t bytes = (size_t)sph_group_count(group[0]) * sizeof(double);
  for (int k = 0; k < FIELDS; k++) {
    const double *a = sph_group_read(group[0], fields[k].field, fields[k].component);
    const double *b = sph_group_read(group[1], fields[k].field, fields[k].component);
    const double *c = sph_group_read(group[2], fields[k].field, fields[k].component);
    assert_memory_equal(a, b, bytes);
    assert_memory_not_equal(a, c, bytes);
  }
  sph_sim_free(whole), sph_sim_free(late), sph_sim_free(other);
  remove(path);
  remove(directory);
}

/* Leapfrog goes without the rates of positions where these are velocities; shifted ones are not.
 * Beside it another scheme of second order. */
static void leapfrog(void **state)
{
  (void)state;
  sph_sim *sim[2] = {waves(1, 0), waves(1, 0)};
  const double *x[2][2], dt = 1e-3;
  for (int k = 0; k < 2; k++) {
    const char *method = k ? "leapfrog" : "midpoint";
    sph_sim_set_integrator(sim[k], &(sph_integrator_def){.method = method, .dt_fixed = dt});
    for (int step = 0; step < 20; step++) assert_int_equal(sph_sim_step(sim[k]), SPH_OK);
    for (int d = 0; d < 2; d++)
      x[k][d] = sph_group_read(sph_sim_group(sim[k], "water"), "position", d);
  }
  double apart = 0;
  for (long i = 0; i < sph_group_count(sph_sim_group(sim[0], "water")); i++)
    for (int d = 0; d < 2; d++) apart = fmax(apart, fabs(x[0][d][i] - x[1][d][i]));
  print_message("# leapfrog and midpoint are apart by %.2g m after 0.02 s at up to 1 m/s\n", apart);
  assert_true(apart > 0 && apart < 1e-4);
  sph_sim_free(sim[0]), sph_sim_free(sim[1]);
}

/* ---- what is refused ---- */

static sph_sim *liquid(int periodic)
{
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {periodic, periodic}, .length = {1, 1}});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  return sim;
}

static void refused(sph_sim *sim, const char *text)
{
  if (sph_sim_status(sim) == SPH_OK) sph_sim_run(sim, 1e-3);
  if (!strstr(sph_sim_error(sim), text))
    fail_msg("\"%s\" is not in \"%s\"", text, sph_sim_error(sim));
  assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
  sph_sim_free(sim);
}

static void with(sph_sim *sim, sph_term term, const char *text)
{
  sph_sim_add_term(sim, term);
  refused(sim, text);
}

/* Does this SUNDIALS have it? */
static int built(const char *method)
{
  sph_integrator_info info;
  for (int k = 0; sph_integrator_info_get(k, &info); k++)
    if (!strcmp(info.name, method)) return 1;
  return 0;
}

static void refusals(void **state)
{
  (void)state;
  with(liquid(1), sph_term_shifting("fickle", 1), "form \"fickle\"; known: delta-plus, fick");
  with(liquid(1), sph_term_shifting(NULL, 0), "speed = 0 m/s; right is > 0 and finite");
  with(liquid(1), sph_term_transport_velocity(-1, 0), "background = -1");
  with(liquid(1), sph_term_stress_artificial(0.2, -1), "beta = -1");
  with(liquid(0), sph_term_transport_velocity(0, 0), "start at a free surface");
  sph_sim *sim = liquid(1);
  sph_sim_add_term(sim, sph_term_shifting(NULL, 1));
  with(sim, sph_term_transport_velocity(0, 0), "moved by shifting already");
  sim = liquid(1);
  sph_group_set_energy(sph_sim_group(sim, "water"), "u");
  with(
      sim, sph_term_shifting(NULL, 1),
      "follow the particles of water, but not its u; right is advection = 0 (in a case: advection: "
      "false)");
  sim = liquid(1);
  sph_group_set_eos(sph_sim_group(sim, "water"), sph_eos_ideal_gas(1.4));
  double *u = sph_group_write(sph_sim_group(sim, "water"), "energy", 0);
  for (long i = 0; i < sph_group_count(sph_sim_group(sim, "water")); i++) u[i] = 1;
  with(sim, sph_term_transport_velocity(1, 1),
       "right is a liquid, or shifting with advection = 0 (in a case: advection: false)");
  if (built("sprk:leapfrog-2-2")) {
    sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1, .periodic = {1, 1}, .length = {1, 1}});
    sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){1, 1}, 1000);
    sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
    sph_sim_add_term(sim, sph_term_summation(1));
    sph_sim_add_term(sim, sph_term_pressure_form("s"));
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "sprk:leapfrog-2-2"});
    with(sim, sph_term_shifting(NULL, 1), "shifting may depend on velocities");
  }
  if (built("lsrk:rkc-2")) {
    sim = liquid(1);
    sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "lsrk:rkc-2"});
    with(sim, sph_term_shifting(NULL, 1), "and there is none of shifting");
  }
  sim = liquid(1);
  sph_sim_add_term(sim, sph_term_shifting(NULL, 1));
  assert_int_equal(sph_sim_evaluate(sim), SPH_OK);
  sph_jacobian *jacobian = sph_jacobian_create(sim, NULL);
  sph_jacobian_evaluate(jacobian);
  sph_jacobian_free(jacobian);
  refused(sim, "no derivatives of a right-hand side with shifting");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shifting),          cmocka_unit_test(transport),
      cmocka_unit_test(artificial_stress), cmocka_unit_test(conservation),
      cmocka_unit_test(from_the_crowd),    cmocka_unit_test(free_surface),
      cmocka_unit_test(between_steps),     cmocka_unit_test(restart),
      cmocka_unit_test(refusals),          cmocka_unit_test(a_uniform_flow_stays),
      cmocka_unit_test(leapfrog),
  };
  return cmocka_run_group_tests_name("shifting", tests, NULL, NULL);
}
