/* Manufactured solutions (sphode/manufactured.h): a term of the library's own that any simulation
 * may have, with the sources that make given fields a solution.  Derivatives of the fields are
 * central differences of order 8: the rounding of the second is some 1e-12 of it, and users give
 * plain functions. */
#include "sphode/manufactured.h"

#include <gsl/gsl_fit.h>
#include <math.h>
#include <string.h>

#include "memory.h"
#include "sim_data.h"

enum { V = 0, RHO = 3, P = 4, FIELDS = 5, POINTS = 4 };
static const char term_name[] = "manufactured";

typedef struct solution {
  const sph_group *group;
  sph_manufactured def;
} solution;

/* v, rho, p at (x, t). */
static void fields_at(const solution *s, const double x[3], double t, double f[FIELDS])
{
  const sph_eos *eos = &s->group->eos;
  double c;
  f[V] = f[V + 1] = f[V + 2] = 0;
  s->def.velocity(s->def.ctx, x, t, f);
  if (s->def.density) {
    f[RHO] = s->def.density(s->def.ctx, x, t);
    eos->pressure(eos, 1, &f[RHO], NULL, &f[P], &c);
  } else {
    f[P] = s->def.pressure(s->def.ctx, x, t);
    f[RHO] = eos->density(eos, f[P], 0);
  }
}

/* First and second derivative of the fields along x + s direction, t + s rate [per unit of s]. */
static void derive(const solution *s, const double x[3], double t, const double direction[3],
                   double rate, double step, double first[FIELDS], double second[FIELDS])
{
  static const double one[POINTS] = {4. / 5, -1. / 5, 4. / 105, -1. / 280};
  static const double two[POINTS] = {8. / 5, -1. / 5, 8. / 315, -1. / 560};
  double f0[FIELDS], f[2][FIELDS];
  fields_at(s, x, t, f0);
  for (int k = 0; k < FIELDS; k++) first[k] = second[k] = 0;
  for (int n = 0; n < POINTS; n++) {
    for (int side = 0; side < 2; side++) {
      const double by = (side ? -1 : 1) * (n + 1) * step;
      const double at[3] = {x[0] + by * direction[0], x[1] + by * direction[1],
                            x[2] + by * direction[2]};
      fields_at(s, at, t + by * rate, f[side]);
    }
    for (int k = 0; k < FIELDS; k++) {
      first[k] += one[n] * (f[0][k] - f[1][k]) / step;
      second[k] += two[n] * (f[0][k] - 2 * f0[k] + f[1][k]) / (step * step);
    }
  }
}

/* The fields and their derivatives at one place. */
typedef struct local {
  double f[FIELDS], t[FIELDS];            /* and d/dt */
  double x[3][FIELDS], second[3][FIELDS]; /* d/dx_d, d^2/dx_d^2 */
  double mixed[3][3];                     /* [a][b]: d^2 v_b/dx_a dx_b */
} local;

static local look(const solution *s, const double x[3], double t, int mixed)
{
  const int dim = s->group->dim;
  const double step = s->def.length / 100;
  local l = {0};
  double unused[FIELDS];
  fields_at(s, x, t, l.f);
  derive(s, x, t, (const double[3]){0}, 1, s->def.time / 100, l.t, unused);
  for (int d = 0; d < dim; d++) {
    double axis[3] = {0};
    axis[d] = 1;
    derive(s, x, t, axis, 0, step, l.x[d], l.second[d]);
  }
  for (int a = 0; mixed && a < dim; a++)
    for (int b = 0; b < dim; b++) {
      double both[3] = {0}, diagonal[FIELDS];
      both[a] = both[b] = 1;
      derive(s, x, t, both, 0, step, unused, diagonal);
      l.mixed[a][b] = a == b ? l.second[a][V + a]
                             : (diagonal[V + b] - l.second[a][V + b] - l.second[b][V + b]) / 2;
    }
  return l;
}

/* Laminar viscosity of the continuum, component a of the force per mass. */
static double friction(const solution *s, const local *l, unsigned terms, int a)
{
  const double nu = s->group->viscosity / l->f[RHO];
  double laplacian = 0, grad_div = 0;
  for (int d = 0; d < s->group->dim; d++) {
    laplacian += l->second[d][V + a];
    grad_div += l->mixed[a][d];
  }
  if (terms & SPH_MORRIS) return nu * laplacian;
  return terms & SPH_MCG ? nu * (laplacian + 2 * grad_div) : 0;
}

static void sources(const solution *s, const double x[3], double t, double s_v[3], double *s_rho)
{
  const sph_term_set *set = &s->group->sim->terms;
  const int dim = s->group->dim;
  const local l = look(s, x, t, (set->bits & SPH_MCG) != 0);
  *s_rho = l.t[RHO];
  for (int a = 0; a < dim; a++) {
    s_v[a] = l.t[V + a] + l.x[a][P] / l.f[RHO] - friction(s, &l, set->bits, a) - set->g[a];
    *s_rho += l.f[V + a] * l.x[a][RHO] + l.f[RHO] * l.x[a][V + a];
    for (int d = 0; d < dim; d++) s_v[a] += l.f[V + d] * l.x[d][V + a];
  }
}

static int body(const sph_term *term, const sph_particles *p)
{
  const solution *s = term->ctx;
  if (strcmp(p->group, s->group->name) != 0) return SPH_OK;
  if (s->group->eos.thermal || s->group->eos.dust) return SPH_ERR_ARGUMENT; /* set since */
  for (long i = 0; i < p->n; i++) {
    double x[3] = {0}, s_v[3] = {0}, s_rho = 0;
    for (int d = 0; d < p->dim; d++) x[d] = p->x[d][i];
    sources(s, x, p->t, s_v, &s_rho);
    for (int d = 0; d < p->dim; d++) p->a[d][i] += s_v[d];
    if (p->drho) p->drho[i] += s_rho;
  }
  return SPH_OK;
}

/* ---- attaching ---- */

/* The solution of the group; NULL: it has none. */
static const solution *solution_of(const sph_group *group)
{
  const sph_term_set *set = group ? &group->sim->terms : NULL;
  for (int k = 0; set && k < set->called; k++) {
    const sph_term *term = &set->call[k].term;
    if (term->body == body && ((const solution *)term->ctx)->group == group) return term->ctx;
  }
  return NULL;
}

static int check(sph_group *group, const sph_manufactured *def)
{
  sph_sim *sim = group->sim;
  if (!def || !def->velocity || !def->density == !def->pressure)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a manufactured solution needs a velocity, and either a density "
                        "or a pressure",
                        group->name);
  if (!(def->length > 0 && isfinite(def->length) && def->time > 0 && isfinite(def->time)))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a manufactured solution that changes over %g m and %g s; right "
                        "is > 0 and finite",
                        group->name, def->length, def->time);
  if (sim->prepared)
    return sph_sim_fail(sim, SPH_ERR_STATE,
                        "group %s: a manufactured solution is attached before the run",
                        group->name);
  if (group->wall || !group->has_eos || group->eos.thermal || group->eos.dust)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "group %s: a manufactured solution needs a fluid whose pressure depends on "
                        "its density alone; set its equation of state before",
                        group->name);
  if (solution_of(group))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "group %s has a manufactured solution already",
                        group->name);
  return SPH_OK;
}

/* Particles get the fields at t = 0. */
static int start(sph_group *group, const solution *s)
{
  for (long i = 0; i < group->n; i++) {
    double x[3] = {0}, f[FIELDS];
    for (int d = 0; d < group->dim; d++) x[d] = group->own[SPH_POSITION][d][i];
    fields_at(s, x, 0, f);
    for (int d = 0; d < group->dim; d++) group->own[SPH_VELOCITY][d][i] = f[V + d];
    if (!(f[RHO] > 0 && f[RHO] < INFINITY))
      return sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                          "group %s, particle %ld: manufactured density %g kg/m^3; right is > 0",
                          group->name, i, f[RHO]);
    group->own[SPH_MASS][0][i] *= f[RHO] / group->own[SPH_DENSITY][0][i];
    group->own[SPH_DENSITY][0][i] = f[RHO];
  }
  return SPH_OK;
}

void sph_manufactured_attach(sph_group *group, const sph_manufactured *def)
{
  if (!group || !sph_sim_data_ok(group->sim) || check(group, def)) return;
  solution *s = SPH_NEW(solution, 1, "a manufactured solution", &group->sim->error);
  if (!s) return;
  *s = (solution){group, *def};
  if (start(group, s)) {
    sph_memory_free(s);
    return;
  }
  sph_sim_add_term(
      group->sim,
      (sph_term){.name = term_name, .body = body, .reads = "", .ctx = s, .free = sph_memory_free});
}

/* ---- what is asked of one ---- */

static const solution *needed(const sph_group *group)
{
  const solution *s = solution_of(group);
  if (group && !s)
    sph_sim_fail(group->sim, SPH_ERR_ARGUMENT, "group %s has no manufactured solution",
                 group->name);
  return s;
}

int sph_manufactured_source(const sph_group *group, const double x[3], double t, double s_v[3],
                            double *s_rho)
{
  const solution *s = x ? needed(group) : NULL;
  double a[3] = {0}, rate = 0;
  if (!s) return SPH_ERR_ARGUMENT;
  sources(s, x, t, a, &rate);
  if (s_v) memcpy(s_v, a, sizeof a);
  if (s_rho) *s_rho = rate;
  return SPH_OK;
}

/* Distance of particle i from its solution; its field is components first .. first + n - 1. */
static double distance(const solution *s, double t, const double *const x[3],
                       const double *const field[3], long i, int first, int n)
{
  double at[3] = {0}, f[FIELDS], sum = 0;
  for (int d = 0; d < 3 && x[d]; d++) at[d] = x[d][i];
  fields_at(s, at, t, f);
  for (int c = 0; c < n; c++) sum += (field[c][i] - f[first + c]) * (field[c][i] - f[first + c]);
  return sqrt(sum);
}

int sph_manufactured_error_of(const sph_group *group, const char *field,
                              sph_manufactured_error *error)
{
  static const char *const names[] = {"velocity", "density", "pressure"};
  const double *x[3] = {0}, *value[3] = {0};
  const solution *s = error && field ? needed(group) : NULL;
  int k = 0;
  if (!s) return SPH_ERR_ARGUMENT;
  while (k < 3 && strcmp(field, names[k])) k++;
  if (k == 3)
    return sph_sim_fail(group->sim, SPH_ERR_ARGUMENT,
                        "a manufactured solution has no field \"%.60s\"; known: velocity, density, "
                        "pressure",
                        field);
  const int n = k ? 1 : group->dim, first = k ? RHO + k - 1 : V;
  for (int d = 0; d < group->dim; d++)
    if (!(x[d] = sph_group_read(group, "position", d))) return sph_sim_status(group->sim);
  for (int c = 0; c < n; c++)
    if (!(value[c] = sph_group_read(group, names[k], c))) return sph_sim_status(group->sim);
  if (!sph_sim_data_ok(group->sim)) return sph_sim_status(group->sim);
  *error = (sph_manufactured_error){0};
  for (long i = 0; i < group->n; i++) {
    const double e = distance(s, sph_sim_time(group->sim), x, value, i, first, n);
    error->L1 += e / (double)group->n;
    error->L2 += e * e / (double)group->n;
    error->max = fmax(error->max, e);
  }
  error->L2 = sqrt(error->L2);
  return SPH_OK;
}

double sph_manufactured_order(long n, const double *dx, const double *error)
{
  enum { MOST = 64 };
  double x[MOST], y[MOST], slope, unused[5];
  if (n < 2 || n > MOST || !dx || !error) return NAN;
  for (long k = 0; k < n; k++) {
    if (!(dx[k] > 0 && error[k] > 0)) return NAN;
    x[k] = log(dx[k]), y[k] = log(error[k]);
  }
  gsl_fit_linear(x, 1, y, 1, (size_t)n, &unused[0], &slope, &unused[1], &unused[2], &unused[3],
                 &unused[4]);
  return slope;
}
