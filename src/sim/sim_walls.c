/* Phase walls: prescribed motion; then p, rho and v of the three models.  Mirrors: sim_mirror.c.
 *
 * Adami, Hu & Adams (2012), from the fluid:
 *   p_w = [sum p_f W + (g - a_w) . sum rho_f r_wf W]/sum W,
 *   rho_w from p_w by the inverse equation of state,  m_w = rho_w dx^d,
 *   v_w = 2 v_prescribed - sum v_f W/sum W in viscous terms (no slip; where the wall turns, in its
 *   frame: v_f + omega x r_wf for v_f, wall_pair.h),
 *   T_w = 2 T_prescribed - sum T_f W/sum W in conduction (isothermal).   No fluid near: p_w = 0.
 *
 * Dynamic boundary particles (Crespo, Gomez-Gesteira & Dalrymple 2007): rho_w is integrated, m_w
 * stays,
 *   d rho_w/dt = continuity with the fluid, p_w = p(rho_w), rho_w >= rho0.
 * Here the last is part of f: no pressure is less than p(rho0), and rho_w at rho0 does not fall. */
#include <math.h>

#include "fluid_loops.h"
#include "sim_mirror.h"
#include "wall_loops.h"

enum { PARALLEL_MIN = 512 };

int sph_sim_walls_moves(const sph_boundary *b) { return b->motion || b->rotation; }

sph_wall_motion sph_sim_walls_motion(const sph_boundary *b, double t)
{
  sph_wall_motion m = {.turns = b->rotation != NULL};
  if (b->motion) b->motion(b->ctx, t, m.displacement, m.velocity, m.acceleration);
  if (!b->rotation) return m;
  b->rotation(b->ctx, t, m.turn);
  for (int d = 0; d < 3; d++) {
    m.centre[d] = b->centre[d] + m.displacement[d];
    m.axis[d] = b->axis[d];
  }
  return m;
}

static void cross(const double a[3], const double b[3], double c[3])
{
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* Rodrigues: x = centre + r_n + cos(angle) (r - r_n) + sin(angle) n x r,  v = v + omega n x r. */
void sph_sim_walls_at(const sph_wall_motion *m, int dim, const double *start, double *x, double *v)
{
  double r[3] = {0}, n_r[3], along = 0;
  for (int d = 0; d < dim; d++) {
    x[d] = start[d] + m->displacement[d];
    v[d] = m->velocity[d];
  }
  if (!m->turns) return;
  for (int d = 0; d < dim; d++) r[d] = x[d] - m->centre[d];
  for (int d = 0; d < 3; d++) along += m->axis[d] * r[d];
  cross(m->axis, r, n_r);
  const double c = cos(m->turn[0]), s = sin(m->turn[0]);
  for (int d = 0; d < 3; d++) r[d] = along * m->axis[d] * (1 - c) + c * r[d] + s * n_r[d];
  cross(m->axis, r, n_r);
  for (int d = 0; d < dim; d++) {
    x[d] = m->centre[d] + r[d];
    v[d] += m->turn[1] * n_r[d];
  }
}

/* a_w = a + d omega/dt n x r + omega^2 n x (n x r) */
void sph_sim_walls_force(const sph_wall_motion *m, int dim, const double *g, const double *x,
                         double *force)
{
  double r[3] = {0}, n_r[3], n_n_r[3];
  for (int d = 0; d < 3; d++) force[d] = g[d] - m->acceleration[d];
  if (!m->turns) return;
  for (int d = 0; d < dim; d++) r[d] = x[d] - m->centre[d];
  cross(m->axis, r, n_r);
  cross(m->axis, n_r, n_n_r);
  for (int d = 0; d < dim; d++)
    force[d] -= m->turn[2] * n_r[d] + m->turn[1] * m->turn[1] * n_n_r[d];
}

/* No shorter step makes it finite. */
static int check_motion(sph_evaluation *e, const sph_group *wall, const sph_wall_motion *m)
{
  static const char *const name[4] = {"displacement along x", "displacement along y",
                                      "displacement along z", "angle"};
  for (int k = 0; k < 4; k++) {
    const double sum = k < 3 ? m->displacement[k] + m->velocity[k] + m->acceleration[k]
                             : m->turn[0] + m->turn[1] + m->turn[2];
    if (isfinite(sum)) continue;
    return sph_sim_fail(e->sim, SPH_ERR_STEP,
                        "%s has no finite value, velocity or acceleration at t = %.9g s (wall %s); "
                        "right is one that is finite up to the end of the run, as sqrt(max(0, "
                        "...)) is",
                        wall->boundary.source[k] ? wall->boundary.source[k] : name[k], e->t,
                        wall->name);
  }
  return SPH_OK;
}

int sph_sim_walls_move(sph_evaluation *e)
{
  const sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups && e->part->lists; g++) {
    const sph_group *wall = sim->group[g];
    const int moves = wall->wall && sph_sim_walls_moves(&wall->boundary);
    sph_wall_motion m = {.turns = 0};
    if (moves) m = sph_sim_walls_motion(&wall->boundary, e->t);
    if (moves && check_motion(e, wall, &m)) return sim->error.status;
    if (wall->wall && wall->model == SPH_MODEL_MIRROR) sph_sim_mirror_place(e, g);
    if (!moves || wall->model == SPH_MODEL_MIRROR) continue;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (wall->n > PARALLEL_MIN)
    for (long i = 0; i < wall->n; i++) {
      double start[3] = {0}, x[3], v[3];
      for (int d = 0; d < sim->dim; d++) start[d] = wall->start[d][i];
      sph_sim_walls_at(&m, sim->dim, start, x, v);
      for (int d = 0; d < sim->dim; d++) {
        e->view[g].x[d][i] = x[d];
        e->view[g].v[d][i] = v[d];
      }
    }
  }
  return SPH_OK;
}

int sph_sim_walls_surface(const sph_evaluation *e, const sph_group *wall, int heats, double value,
                          const double x[3])
{
  if (isfinite(value) && (heats || value > 0)) return SPH_OK;
  return sph_sim_admit_retry(
      e->sim, "wall %s: %s of its surface is %g %s at (%g, %g, %g) m, t = %g s; right is %s",
      wall->name, heats ? "the heat flux" : "the temperature", value, heats ? "W/m^2" : "K", x[0],
      x[1], x[2], e->t, heats ? "a finite one" : "> 0");
}

int sph_sim_walls_heat(sph_evaluation *e)
{
  int status = SPH_OK;
  for (int g = 0; g < e->sim->groups; g++) {
    const sph_group *wall = e->sim->group[g];
    const sph_view *view = &e->view[g];
    if (!wall->wall || wall->model == SPH_MODEL_MIRROR || !view->T ||
        !wall->boundary.temperature_at)
      continue;
    wall->boundary.temperature_at(wall->boundary.ctx, e->t, view->n, (const double *const *)view->x,
                                  view->T);
    for (long i = 0; i < view->n && !status; i++) {
      double x[3] = {0};
      if (view->T[i] > 0 && view->T[i] < INFINITY) continue;
      for (int d = 0; d < e->sim->dim; d++) x[d] = view->x[d][i];
      status = sph_sim_walls_surface(e, wall, 0, view->T[i], x);
    }
  }
  return status;
}

/* One wall particle at sorted place s, from its sums.  A part of f that knows no pressure has none
 * here either: what the last evaluation left would count, if only in the last bit of m/rho. */
static void fill(const sph_evaluation *e, const sph_group *wall, long s, long i,
                 const sph_wall_motion *motion)
{
  const sph_sim *sim = e->sim;
  const sph_view *view = &e->view[wall->index];
  double *const *sum = sim->sorted[wall->index].sum;
  double W = e->part->eos ? sum[SPH_WALL_W][s] : 0, p = 0, u = 0;
  if (W > 0) {
    double x[3] = {0}, g_minus_a[3];
    for (int d = 0; d < sim->dim; d++) x[d] = view->x[d][i];
    sph_sim_walls_force(motion, sim->dim, sim->terms.g, x, g_minus_a);
    p = sum[SPH_WALL_P][s];
    // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): dim <= 3
    for (int d = 0; d < sim->dim; d++) p += g_minus_a[d] * sum[SPH_WALL_RHO_R + d][s];
    p /= W;
    u = wall->eos.thermal ? sum[SPH_WALL_U][s] / W : 0;
  }
  if (p < 0 && !wall->boundary.tension) p = 0;
  double rho = NAN, unused;
  if (!wall->eos.thermal || W > 0) rho = wall->eos.density(&wall->eos, p, u);
  if (!(rho > 0 && rho < INFINITY)) rho = wall->rho0;
  if (wall->boundary.no_slip) {
    wall->eos.pressure(&wall->eos, 1, &rho, &u, &unused, &view->c[i]);
    if (isnan(view->c[i])) view->c[i] = 0; /* u = 0 where no fluid is near */
  }
  view->rho[i] = rho;
  view->m[i] = rho * sim->wall_volume; /* it always fills its place on the lattice */
  view->p[i] = p;
}

void sph_sim_walls_finish(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const sph_group *wall = sim->group[g];
  const int *order = sph_neighbors_order(sim->neighbors, g);
  const sph_wall_motion m = sph_sim_walls_motion(&wall->boundary, e->t);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (wall->n > 512)
  for (long s = 0; s < wall->n; s++) fill(e, wall, s, order[s], &m);
}

/* ---- dynamic boundary particles ---- */

/* Below it there is no pressure; 0: walls that may pull. */
static double least_density(const sph_group *wall)
{
  if (wall->boundary.tension) return 0;
  return wall->eos.rho0 > 0 ? wall->eos.rho0 : wall->rho0;
}

/* p and c of wall g; a part of f that knows no pressure has none here either. */
static void dynamic(const sph_evaluation *e, int g)
{
  const sph_group *wall = e->sim->group[g];
  const sph_view *view = &e->view[g];
  const double least = least_density(wall);
#pragma omp parallel for num_threads(e->sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long i = 0; i < view->n; i++) {
    const double rho = fmax(view->rho[i], least);
    view->p[i] = view->c[i] = 0;
    if (e->part->eos) wall->eos.pressure(&wall->eos, 1, &rho, NULL, &view->p[i], &view->c[i]);
  }
}

void sph_sim_walls_rates(sph_evaluation *e, int g)
{
  sph_sim *sim = e->sim;
  const sph_group *wall = sim->group[g];
  const sph_view *view = &e->view[g];
  const double least = least_density(wall);
  const int acts = e->part->pairs && (e->part->rates & SPH_CONTINUITY);
  const int *order = sph_neighbors_order(sim->neighbors, g);
  if (!view->drho) return;
  if (acts) sph_sim_pairs_clear(sim, g, SPH_FLUID_SUMS_ALL);
  for (int f = 0; acts && f < sim->groups; f++) {
    fluid_constants k = sim->constants;
    k.terms &= SPH_CONTINUITY | SPH_FORM_C2 | SPH_FORM_PHI | SPH_THERMAL;
    if (!sim->group[f]->wall && !sim->group[f]->eos.dust)
      sph_sim_pairs_loop(sim, sph_fluid_loop(sim->isa, sim->kernel_number, sim->dim, k.terms), g, f,
                         &k);
  }
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (view->n > PARALLEL_MIN)
  for (long s = 0; s < view->n; s++) {
    const long i = order ? order[s] : s;
    double rate = acts ? sim->F_scale * sim->sorted[g].sum[SPH_SUM_COMPRESSION][s] : 0;
    if (sim->loop_terms & SPH_FORM_C2) rate *= view->rho[i];
    if (sim->sorted[g].phi) rate *= sim->sorted[g].phi[i];
    view->drho[i] = view->rho[i] <= least && rate < 0 ? 0 : rate;
  }
}

fluid_constants sph_sim_walls_constants(const sph_sim *sim, const sph_group *wall, double t)
{
  const sph_wall_motion m = sph_sim_walls_motion(&wall->boundary, t);
  fluid_constants k = sim->constants;
  for (int d = 0; d < 3; d++) k.omega[d] = m.turn[1] * m.axis[d];
  return k;
}

/* The sums of an adami wall over all fluids. */
static void extrapolate(sph_evaluation *e, int g)
{
  sph_sim *sim = e->sim;
  const sph_group *wall = sim->group[g];
  const fluid_constants k = sph_sim_walls_constants(sim, wall, e->t);
  sph_pair_function *loop =
      sph_wall_loop(sim->isa, sim->kernel_number, sim->dim, wall->boundary.rotation != NULL,
                    (sim->loop_terms & SPH_THERMAL) != 0);
  sph_sim_pairs_pack_positions(e, g);
  sph_sim_pairs_clear(sim, g, SPH_WALL_SUMS);
  for (int f = 0; f < sim->groups; f++)
    if (!sim->group[f]->wall && !sim->group[f]->eos.dust) sph_sim_pairs_loop(sim, loop, g, f, &k);
}

int sph_sim_walls_fill(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->pairs) return SPH_OK;
  sph_sim_material_phi(e, 0);
  sph_sim_pairs_pack(e, 0);
  int status = e->part->walls ? sph_sim_walls_heat(e) : SPH_OK;
  for (int g = 0; g < sim->groups && e->part->walls && !status; g++) {
    if (!sim->group[g]->wall) continue;
    if (sim->group[g]->model == SPH_MODEL_MIRROR) status = sph_sim_mirror_fill(e, g);
    if (sim->group[g]->model == SPH_MODEL_DBC) dynamic(e, g);
    if (sim->group[g]->model != SPH_MODEL_ADAMI) continue;
    extrapolate(e, g);
    sph_sim_walls_finish(e, g);
  }
  if (status || !e->part->walls) return status;
  sph_sim_material_phi(e, 1);
  sph_sim_pairs_pack(e, 1);
  return SPH_OK;
}
