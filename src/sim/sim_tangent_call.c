/* Differences of what has no derivatives: callbacks of the user along s and theta, and what the
 * simulation makes of a parameter.
 *
 *   g'(0) = [8 (g(e) - g(-e)) - (g(2e) - g(-2e))]/(12 e) + O(e^4)
 *
 * e moves nothing by more than 2^-15 of its scale: rounding leaves 1e-11, a kink, as of a kernel
 * at the end of its support, 1e-7 of the pair that lies on it. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "sim_energy.h"
#include "sim_tangent.h"

enum { POINTS = 4 };
/* In this order sums of equal values are exactly zero: what does not depend on a parameter is
 * known. */
static const double at[POINTS] = {-1, 1, -2, 2};
static const double weight[POINTS] = {-8.0 / 12, 8.0 / 12, 1.0 / 12, -1.0 / 12};
static const double STEP = 0x1p-15;

/* Of formulas that are smooth in the parameter: larger, so that rounding leaves less. */
static const double SMOOTH = 0x1p-10;

static double theta_step(const sph_tangent *t, double step)
{
  return t->theta ? step * t->theta->scale : 0;
}

static int acts(const sph_tangent *t, unsigned where)
{
  return t->theta && (t->theta->acts & where);
}

/* Sets the parameter beside its value, by a multiple of a step; 0 restores it. */
static void set_theta(sph_tangent *t, double value, double by)
{
  if (t->theta) sph_sim_parameter_set(t->sim, t->theta, value + by);
}

static double theta_value(const sph_tangent *t)
{
  return t->theta && t->theta->value ? *t->theta->value : 0;
}

/* ---- along theta alone ---- */

double sph_sim_tangent_call_number(sph_tangent *t, const double *number)
{
  const double value = theta_value(t), step = theta_step(t, SMOOTH);
  double slope = 0;
  for (int k = 0; t->theta && k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    slope += weight[k] / step * *number;
  }
  set_theta(t, value, 0);
  return slope;
}

/* [SPH_FLUID_NUMBERS] */
static double *numbers_of(fluid_constants *k)
{
  void *numbers = (char *)k + offsetof(fluid_constants, inverse_h);
  return numbers;
}

fluid_constants sph_sim_tangent_call_constants(sph_tangent *t, int pass, int target, int source)
{
  const double value = theta_value(t), step = theta_step(t, SMOOTH);
  fluid_constants slope = {0};
  double *sum = numbers_of(&slope);
  for (int k = 0; t->theta && k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    fluid_constants there = sph_sim_tangent_loop_constants(t, pass, target, source);
    const double *number = numbers_of(&there);
    for (int n = 0; n < SPH_FLUID_NUMBERS; n++) sum[n] += weight[k] / step * number[n];
  }
  set_theta(t, value, 0);
  return slope;
}

int sph_sim_tangent_call_eos(sph_tangent *t)
{
  const double value = theta_value(t), step = theta_step(t, STEP);
  int status = SPH_OK;
  for (int k = 0; acts(t, SPH_ACTS_EOS) && !status && k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    status = sph_sim_material_eos(&t->e);
    for (int g = 0; !status && g < t->sim->groups; g++) {
      const sph_view *view = &t->e.view[g];
      sph_point *point = t->group[g].point;
      for (long i = 0; i < view->n && !t->sim->group[g]->wall; i++) {
        point[i].p += weight[k] / step * view->p[i];
        point[i].c += weight[k] / step * view->c[i];
        if (view->u) point[i].u += weight[k] / step * view->u[i];
        if (view->T) point[i].T += weight[k] / step * view->T[i];
      }
    }
  }
  set_theta(t, value, 0);
  return acts(t, SPH_ACTS_EOS) && !status ? sph_sim_material_eos(&t->e) : status;
}

/* Walls move as their callbacks say. */
void sph_sim_tangent_call_motion(sph_tangent *t, int g)
{
  const sph_group *wall = t->sim->group[g];
  const double value = theta_value(t), step = theta_step(t, SMOOTH);
  const int dim = t->sim->dim;
  sph_point *point = t->group[g].point;
  if (!t->theta || !t->theta->is_own || !sph_sim_walls_moves(&wall->boundary)) return;
  for (long i = 0; i < wall->n; i++)
    for (int d = 0; d < dim; d++) point[i].x[d] = point[i].v[d] = 0;
  for (int k = 0; k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    const sph_wall_motion m = sph_sim_walls_motion(&wall->boundary, t->e.t);
    for (long i = 0; i < wall->n; i++) {
      double start[3] = {0}, x[3], v[3];
      for (int d = 0; d < dim; d++) start[d] = wall->start[d][i];
      sph_sim_walls_at(&m, dim, start, x, v);
      for (int d = 0; d < dim; d++) {
        point[i].x[d] += weight[k] / step * (x[d] - start[d]);
        point[i].v[d] += weight[k] / step * v[d];
      }
    }
  }
  set_theta(t, value, 0);
  for (long i = 0; i < wall->n; i++)
    for (int d = 0; d < dim; d++) point[i].extra[d] = 2 * point[i].v[d]; /* slip_velocity */
}

/* 2 T - <T_fluid> where T is that of a callback. */
void sph_sim_tangent_call_heat(sph_tangent *t, int g)
{
  const double value = theta_value(t), step = theta_step(t, SMOOTH);
  const sph_view *view = &t->e.view[g];
  if (!t->theta || !t->theta->is_own || !view->T || !t->sim->group[g]->boundary.temperature_at)
    return;
  for (int k = 0; k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    sph_sim_walls_heat(&t->e);
    for (long i = 0; i < view->n; i++) t->group[g].point[i].T += 2 * weight[k] / step * view->T[i];
  }
  set_theta(t, value, 0);
  sph_sim_walls_heat(&t->e);
}

void sph_sim_tangent_call_walls(sph_tangent *t, int g)
{
  const double value = theta_value(t), step = theta_step(t, STEP);
  const sph_view *view = &t->e.view[g];
  const sph_term *phi = &t->sim->terms.phi;
  const int powers = t->sim->sorted[g].phi && !phi->phi; /* the user's follows later */
  sph_point *point = t->group[g].point;
  if (!acts(t, SPH_ACTS_WALLS)) return;
  for (int k = 0; k < POINTS; k++) {
    set_theta(t, value, at[k] * step);
    sph_sim_walls_finish(&t->e, g);
    for (long i = 0; i < view->n; i++) {
      point[i].p += weight[k] / step * view->p[i];
      point[i].rho += weight[k] / step * view->rho[i];
      point[i].m += weight[k] / step * view->m[i];
      point[i].c += weight[k] / step * view->c[i];
      if (powers) point[i].phi += weight[k] / step * pow(view->rho[i], phi->exponent);
    }
  }
  set_theta(t, value, 0);
  sph_sim_walls_finish(&t->e, g);
}

int sph_sim_tangent_call_rates(sph_tangent *t, double *out)
{
  const double value = theta_value(t), step = theta_step(t, SMOOTH);
  int status = SPH_OK;
  for (int k = 0; acts(t, SPH_ACTS_RATES) && !status && k < POINTS; k++) {
    sph_evaluation e = t->e;
    for (int g = 0; g < t->sim->groups; g++)
      e.view[g] = sph_group_data_view(t->sim->group[g], t->y, t->beside_rate);
    set_theta(t, value, at[k] * step);
    status = sph_sim_bodies_add(&e);
    for (long i = 0; i < t->sim->layout.length; i++) t->beside_rate[i] += t->drag[i];
    for (int g = 0; !status && g < t->sim->groups; g++)
      if (!t->sim->group[g]->wall) sph_sim_pairs_rates(&e, g);
    for (long i = 0; !status && i < t->sim->layout.length; i++)
      out[i] += weight[k] / step * t->beside_rate[i];
  }
  set_theta(t, value, 0);
  return status;
}

/* ---- along s and theta ---- */

/* Which pointer of a view each member of sph_point is a change of. */
static const struct {
  size_t point, view;
  int count;
} fields[] = {
#define FIELD(member, count)                                       \
  {                                                                \
    offsetof(sph_point, member), offsetof(sph_view, member), count \
  }
    FIELD(x, 3), FIELD(v, 3), FIELD(rho, 1), FIELD(energy, 1), FIELD(s, SPH_SCALARS_MAX),
    FIELD(u, 1), FIELD(T, 1), FIELD(p, 1),   FIELD(c, 1),      FIELD(m, 1),
#undef FIELD
};
enum { FIELDS = sizeof fields / sizeof *fields };

/* The largest change of any particle, relative to a scale of each field. */
static double size_of(const sph_tangent *t)
{
  const sph_sim *sim = t->sim;
  double most = t->theta ? 1 / t->theta->scale : 0;
  for (int g = 0; g < sim->groups; g++) {
    const sph_view *view = &t->e.view[g];
    const double *scale = sim->scale[g];
    int energy = sph_group_data_energy(sim->group[g]);
    for (long i = 0; i < view->n && !sim->group[g]->wall; i++) { /* walls follow fluids */
      const sph_point *d = &t->group[g].point[i];
      for (int a = 0; a < sim->dim; a++) {
        most = fmax(most, fabs(d->x[a]) / sim->h);
        most = fmax(most, fabs(d->v[a]) / scale[SPH_VELOCITY]);
      }
      most = fmax(most, fabs(d->rho) / view->rho[i]);
      if (energy >= 0) most = fmax(most, fabs(d->energy) / scale[energy]);
      for (int q = 0; q < sim->terms.scalars; q++)
        most = fmax(most, fabs(d->s[q]) / scale[SPH_SCALAR + q]);
    }
  }
  return most;
}

static const double *member_of(const sph_point *point, size_t offset)
{
  const void *member = (const char *)point + offset;
  return member;
}

/* The view of group g, moved by `by` times its changes; rates go to beside_rate. */
static sph_view moved(const sph_tangent *t, int g, double by)
{
  const long capacity = t->sim->group[g]->capacity;
  sph_view view = sph_group_data_view(t->sim->group[g], t->y, t->beside_rate);
  double *to = t->beside[g];
  for (int f = 0; f < FIELDS; f++) {
    double **array = (double **)((char *)&view + fields[f].view);
    const sph_point *point = t->group[g].point;
    for (int c = 0; c < fields[f].count; c++) {
      if (!array[c]) continue;
      for (long i = 0; i < view.n; i++)
        to[i] = array[c][i] + by * member_of(&point[i], fields[f].point)[c];
      array[c] = to;
      to += capacity;
    }
  }
  return view;
}

/* Is there a callback among the body terms? */
int sph_sim_tangent_call_has_bodies(const sph_tangent *t)
{
  const sph_term_set *set = &t->sim->terms;
  for (int k = 0; k < set->called; k++)
    if (set->call[k].term.body && (t->e.part->called >> k & 1)) return 1;
  return 0;
}

static int difference_bodies(sph_tangent *t, double size)
{
  const sph_sim *sim = t->sim;
  int status = SPH_OK;
  memset(t->body, 0, (size_t)sim->layout.length * sizeof *t->body);
  if (!sph_sim_tangent_call_has_bodies(t) || size == 0) return SPH_OK;
  for (int k = 0; !status && k < POINTS; k++) {
    sph_evaluation e = t->e;
    for (int g = 0; g < sim->groups; g++) e.view[g] = moved(t, g, at[k] * STEP / size);
    status = sph_sim_bodies_add(&e);
    for (long i = 0; !status && i < sim->layout.length; i++)
      t->body[i] += weight[k] * size / STEP * t->beside_rate[i];
  }
  return status;
}

int sph_sim_tangent_call_bodies(sph_tangent *t) { return difference_bodies(t, size_of(t)); }

/* The scale of each member of a point that body terms read; 0: of none other. */
static double scale_of(const sph_tangent *t, int g, long i, size_t member)
{
  const sph_sim *sim = t->sim;
  const sph_view *view = &t->e.view[g];
  const size_t first_s = offsetof(sph_point, s), last_s = first_s + sizeof((sph_point){0}.s);
  if (member < offsetof(sph_point, v)) return sim->h;
  if (member < offsetof(sph_point, rho)) return sim->scale[g][SPH_VELOCITY];
  if (member == offsetof(sph_point, rho)) return view->rho[i];
  if (member == offsetof(sph_point, u)) return view->u ? sim->scale[g][SPH_ENERGY] : 0;
  if (member == offsetof(sph_point, p)) return view->rho[i] * view->c[i] * view->c[i];
  if (member == offsetof(sph_point, c)) return view->c[i];
  if (member < first_s || member >= last_s) return 0;
  const int q = (int)((member - first_s) / sizeof(double));
  return q < sim->terms.scalars ? sim->scale[g][SPH_SCALAR + q] : 0;
}

int sph_sim_tangent_call_field(sph_tangent *t, int member)
{
  const sph_sim *sim = t->sim;
  double most = 0;
  for (int g = 0; g < sim->groups; g++) {
    sph_point *point = t->group[g].point;
    memset(point, 0, (size_t)sim->group[g]->n * sizeof *point);
    for (long i = 0; !sim->group[g]->wall && i < sim->group[g]->n; i++) {
      double scale = scale_of(t, g, i, (size_t)member * sizeof(double));
      ((double *)&point[i])[member] = scale;
      most = fmax(most, scale);
    }
  }
  return most > 0 ? difference_bodies(t, 1) : SPH_OK;
}

void sph_sim_tangent_call_phi(sph_tangent *t, int walls)
{
  sph_sim *sim = t->sim;
  const sph_term *term = &sim->terms.phi;
  const double size = size_of(t), value = theta_value(t);
  for (int g = 0; g < sim->groups && term->phi && size > 0; g++) {
    if (sim->group[g]->wall != walls) continue;
    double *phi = sim->sorted[g].phi;
    sph_evaluation e = t->e;
    for (int k = 0; k < POINTS; k++) {
      set_theta(t, value, t->theta ? at[k] * STEP / size : 0);
      e.view[g] = moved(t, g, at[k] * STEP / size);
      const sph_particles particles = sph_sim_bodies_particles(&e, g);
      term->phi(term, &particles, phi);
      for (long i = 0; i < e.view[g].n; i++)
        t->group[g].point[i].phi += weight[k] * size / STEP * phi[i];
    }
  }
  set_theta(t, value, 0);
  if (term->phi) sph_sim_material_phi(&t->e, walls);
}

/* ---- registered pair terms: records are moved, and the loop with tiles runs alone ---- */

static void move_records(sph_tangent *t, double by)
{
  const sph_sim *sim = t->sim;
  for (int g = 0; g < sim->groups; g++) {
    const long length = sim->sorted[g].room * sim->sorted[g].stride;
    for (long i = 0; i < length; i++)
      sim->sorted[g].record[i] = t->record[g][i] + by * t->group[g].record_d[i];
  }
}

static void copy_records(sph_tangent *t)
{
  for (int g = 0; g < t->sim->groups; g++)
    memcpy(t->record[g], t->sim->sorted[g].record,
           (size_t)(t->sim->sorted[g].room * t->sim->sorted[g].stride) * sizeof(double));
}

typedef struct adding {
  const sph_tangent *t;
  int g;
} adding;

static void add_share(void *ctx, const sph_share *share)
{
  const adding *a = ctx;
  const sph_sim *sim = a->t->sim;
  for (int s = 0; s < sim->groups && !sim->group[a->g]->eos.dust; s++)
    if (sph_sim_interaction_same_species(sim->group[a->g], sim->group[s]))
      sph_sim_interaction_tiles(&a->t->e, share, a->g, s);
}

static void add_tiles(sph_tangent *t, double factor)
{
  sph_sim *sim = t->sim;
  for (int g = 0; g < sim->groups; g++) {
    adding a = {.t = t, .g = g};
    if (sim->group[g]->wall) continue;
    sph_sim_pairs_share(sim, g, sim->fluid_sums, 0, add_share, &a);
    for (int q = 0; q < sim->fluid_sums; q++)
      for (long i = 0; i < sim->group[g]->n; i++)
        t->group[g].sum_d[q][i] += factor * sim->sorted[g].sum[q][i];
  }
}

void sph_sim_tangent_call_tiles(sph_tangent *t)
{
  const double size = size_of(t), value = theta_value(t);
  if (!t->e.part->tiles || size == 0) return;
  copy_records(t);
  for (int k = 0; k < POINTS; k++) {
    set_theta(t, value, t->theta ? at[k] * STEP / size : 0);
    move_records(t, at[k] * STEP / size);
    add_tiles(t, weight[k] * size / STEP);
  }
  set_theta(t, value, 0);
  move_records(t, 0);
}
