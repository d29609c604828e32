/* Changes of what belongs to one particle alone, from the formulas of the phases: each map is the
 * differential of the function named beside it. */
#include <math.h>
#include <string.h>

#include "eos_table.h"
#include "gradient_pair.h"
#include "sim_tangent.h"
#include "wall_pair.h"

void sph_sim_tangent_map_transposed(sph_local_map *map, const sph_local *k, int n, int m,
                                    const double *bar_out, double *bar_in)
{
  double in[SPH_RATES_IN] = {0}, out[SPH_RATES_IN]; /* no map has more */
  for (int a = 0; a < n; a++) {
    memset(out, 0, sizeof out);
    in[a] = 1;
    map(k, in, out);
    in[a] = 0;
    for (int b = 0; b < m; b++) bar_in[a] += out[b] * bar_out[b];
  }
}

/* phi = rho^exponent; a user's phi is differenced (sim_tangent_call.c). */
static double phi(const sph_local *k, double rho)
{
  const sph_term *term = &k->tangent->sim->terms.phi;
  const double *phi = k->tangent->sim->sorted[k->group->index].phi;
  return phi && !term->phi ? term->exponent * phi[k->i] / k->view->rho[k->i] * rho : 0;
}

/* u of the energy that is integrated: sim_energy.c. */
static double internal(const sph_local *k, const sph_point *in)
{
  const sph_view *view = k->view;
  const sph_tangent_group *own = &k->tangent->group[k->group->index];
  const double rho = view->rho[k->i], g1 = k->group->eos.gamma - 1;
  double u = in->energy;
  switch (sph_group_data_energy(k->group)) {
  case SPH_TOTAL_ENERGY:
    for (int d = 0; d < k->group->dim; d++) u -= view->v[d][k->i] * in->v[d];
    return u;
  case SPH_ENTROPY: return pow(rho, g1) / g1 * in->energy + g1 * view->u[k->i] / rho * in->rho;
  case SPH_TEMPERATURE: return (in->energy - own->T_rho[k->i] * in->rho) / own->T_u[k->i];
  default: return u;
  }
}

/* sim_material.c, sim_energy.c */
void sph_sim_tangent_map_eos(const sph_local *k, const double *in, double *out)
{
  const sph_point *d = (const sph_point *)in;
  sph_point *to = (sph_point *)out;
  const sph_tangent_group *own = &k->tangent->group[k->group->index];
  const long i = k->i;
  double u = k->view->energy ? internal(k, d) : 0;
  to->u += u;
  to->p += own->p_rho[i] * d->rho + own->p_u[i] * u;
  to->c += own->c_rho[i] * d->rho + own->c_u[i] * u;
  to->phi += phi(k, d->rho);
  if (!k->view->T) return;
  to->T += k->view->T == k->view->energy ? d->energy : own->T_rho[i] * d->rho + own->T_u[i] * u;
}

int sph_sim_tangent_map_record(const sph_sim *sim, int g)
{
  int slots = slot_scalar(sim->dim) + sim->terms.scalars;
  return slots < sim->sorted[g].stride ? slots : (int)sim->sorted[g].stride;
}

/* pack of sim_pairs.c */
void sph_sim_tangent_map_pack(const sph_local *k, const double *in, double *out)
{
  const sph_sim *sim = k->tangent->sim;
  const sph_view *view = k->view;
  const sph_point *d = (const sph_point *)in;
  const int dim = sim->dim, slots = sph_sim_tangent_map_record(sim, k->group->index);
  const double *phi = sim->sorted[k->group->index].phi;
  const double rho = view->rho[k->i], p = view->p[k->i], rho2 = rho * rho;
  for (int a = 0; a < dim; a++) {
    out[a] += d->x[a];
    out[slot_v(dim) + a] += d->v[a];
  }
  double slot_of_p = sim->loop_terms & SPH_FORM_C2 ? d->p : (d->p - 2 * p / rho * d->rho) / rho2;
  if (phi) slot_of_p = slot_of_p * phi[k->i] + p / rho2 * d->phi;
  out[slot_rho(dim)] += d->rho;
  out[slot_p(dim)] += slot_of_p;
  out[slot_c(dim)] += d->c;
  out[slot_V(dim)] += (d->m - view->m[k->i] / rho * d->rho) / rho;
  if (slots <= slot_extra(dim)) return;
  for (int a = 0; a < dim; a++) out[slot_extra(dim) + a] += d->extra[a];
  if (sim->loop_terms & SPH_THERMAL) {
    out[slot_u(dim)] += d->u;
    out[slot_T(dim)] += d->T;
  }
  if (phi) out[slot_phi(dim)] += d->phi;
  for (int q = 0; slot_scalar(dim) + q < slots; q++)
    if (view->s[q]) out[slot_scalar(dim) + q] += d->s[q];
}

/* fill of sim_walls.c, and what pack makes of the sums.  rho = rho(p, u): the inverse of
 * p(rho, u). */
void sph_sim_tangent_map_wall(const sph_local *k, const double *in, double *out)
{
  const sph_sim *sim = k->tangent->sim;
  const sph_group *wall = k->group;
  const sph_view *view = k->view;
  const sph_eos *eos = &wall->eos;
  sph_point *to = (sph_point *)out;
  double *const *sum = sim->sorted[wall->index].sum, W = sum[SPH_WALL_W][k->s];
  double rho = view->rho[k->i], p = view->p[k->i], dp = 0, u = 0, du = 0;
  if (!(W > 0)) return;
  const double dW = in[SPH_WALL_W] / W;
  for (int d = 0; d < sim->dim; d++)
    to->extra[d] -= in[SPH_WALL_V + d] / W - sum[SPH_WALL_V + d][k->s] / W * dW;
  if (sph_group_data_isothermal(wall)) to->T -= in[SPH_WALL_T] / W - sum[SPH_WALL_T][k->s] / W * dW;
  if (eos->thermal) {
    u = sum[SPH_WALL_U][k->s] / W;
    du = in[SPH_WALL_U] / W - u * dW;
  }
  if (p != 0 || wall->boundary.tension) { /* else it was cut */
    dp = in[SPH_WALL_P] / W - p * dW;
    const sph_wall_motion *motion = &k->tangent->motion[wall->index];
    double x[3] = {0}, beside[3] = {0}, g_minus_a[3], moved[3]; /* linear in x */
    for (int d = 0; d < sim->dim; d++) x[d] = view->x[d][k->i], beside[d] = x[d] + to->x[d];
    sph_sim_walls_force(motion, sim->dim, sim->terms.g, x, g_minus_a);
    sph_sim_walls_force(motion, sim->dim, sim->terms.g, beside, moved);
    for (int d = 0; d < sim->dim; d++)
      dp += (g_minus_a[d] * in[SPH_WALL_RHO_R + d] +
             (moved[d] - g_minus_a[d]) * sum[SPH_WALL_RHO_R + d][k->s]) /
            W;
  }
  double p_rho, p_u, c_rho, c_u, drho = 0;
  sph_eos_slopes(eos, 1, &rho, &u, &p_rho, &p_u, &c_rho, &c_u);
  double there = eos->density(eos, p, u); /* else it is rho0 */
  if (there > 0 && there < INFINITY && p_rho > 0) drho = (dp - p_u * du) / p_rho;
  to->p += dp;
  to->rho += drho;
  to->m += drho * sim->wall_volume;
  to->phi += phi(k, drho);
  if (wall->boundary.no_slip && view->c[k->i] > 0) to->c += c_rho * drho + c_u * du;
}

/* Cholesky factors of M as finish of sim_gradients.c; g = M^-1 b: dg = M^-1 (db - dM g). */
void sph_sim_tangent_map_gradient(const sph_local *k, const double *in, double *out)
{
  const sph_sim *sim = k->tangent->sim;
  const sph_sorted *sorted = &sim->sorted[k->group->index];
  const int dim = sim->dim;
  const double *g = sorted->record + k->s * sorted->stride + slot_extra(dim);
  double L[3][3], right[3];
  int n = 0;
  if (!sph_sim_gradients_factor(sim, k->tangent->group[k->group->index].matrix, k->s, L)) return;
  for (int a = 0; a < dim; a++) right[a] = in[gradient_sums(dim) - dim + a];
  for (int a = 0; a < dim; a++)
    for (int b = a; b < dim; b++, n++) {
      right[a] -= in[n] * g[b];
      if (b > a) right[b] -= in[n] * g[a];
    }
  for (int a = 0; a < dim; a++) right[a] *= sim->F_scale;
  sph_sim_gradients_solve(dim, L, right);
  for (int a = 0; a < dim; a++) ((sph_point *)out)->extra[a] += right[a];
}

/* ---- rates: add_rates of sim_pairs.c, then sph_sim_energy_rate ---- */

/* The change of the rate of the energy; heat, compression: changes; `pressed`: compression
 * itself. */
static double energy_rate(const sph_local *k, const sph_point *d, const double dv[3], double heat,
                          double compression, double pressed)
{
  const sph_view *view = k->view;
  const sph_eos *eos = &k->group->eos;
  const long i = k->i;
  const double rho = view->rho[i], rho2 = rho * rho;
  const double work = pressed / rho2, dwork = compression / rho2 - 2 * work / rho * d->rho;
  double rate = heat;
  if (eos->thermal) rate += view->p[i] * dwork + d->p * work;
  switch (sph_group_data_energy(k->group)) {
  case SPH_TOTAL_ENERGY:
    for (int a = 0; a < k->group->dim; a++)
      rate += view->v[a][i] * dv[a] + view->dv[a][i] * d->v[a];
    return rate;
  case SPH_ENTROPY:
    return (eos->gamma - 1) * pow(rho, 1 - eos->gamma) * heat +
           (1 - eos->gamma) / rho * view->du[i] * d->rho;
  case SPH_TEMPERATURE:
    if (!eos->thermal) return heat / eos->c_v;
    double pT, pT_rho, pT_T;
    sph_eos_thermal_pressure(eos, 1, &rho, &view->energy[i], &pT);
    sph_eos_slopes_thermal_pressure(eos, 1, &rho, &view->energy[i], &pT_rho, &pT_T);
    return (heat + pT * dwork + (pT_rho * d->rho + pT_T * d->energy) * work) / eos->c_v;
  default: return rate;
  }
}

/* in: fluid sums, point, heating and acceleration by body terms. */
void sph_sim_tangent_map_rates(const sph_local *k, const double *in, double *out)
{
  const sph_sim *sim = k->tangent->sim;
  const sph_part *part = k->tangent->e.part;
  const sph_view *view = k->view;
  const sph_sorted *sorted = &sim->sorted[k->group->index];
  const sph_point *d = (const sph_point *)(in + SPH_PAIR_SUMS);
  const double *body = in + SPH_PAIR_SUMS + SPH_POINT, F = sim->F_scale;
  double compression = F * in[SPH_SUM_COMPRESSION];
  double pressed = part->pairs ? F * sorted->sum[SPH_SUM_COMPRESSION][k->s] : 0;
  if (sim->loop_terms & SPH_FORM_C2) {
    compression = compression * view->rho[k->i] + pressed * d->rho;
    pressed *= view->rho[k->i];
  }
  if (sorted->phi) {
    compression = compression * sorted->phi[k->i] + pressed * d->phi;
    pressed *= sorted->phi[k->i];
  }
  double dv[3] = {0};
  for (int a = 0; a < sim->dim; a++) {
    dv[a] = F * in[SPH_SUM_A + a] + body[1 + a];
    if (part->positions) out[a] += d->v[a];
    if (part->rates & SPH_XSPH) out[a] += sim->W_scale * in[SPH_SUM_DRIFT + a];
    out[3 + a] += dv[a];
  }
  if (part->rates & SPH_CONTINUITY) out[6] += compression;
  if (part->rates & SPH_DIFFUSION)
    out[6] += sim->terms.delta * sim->h * k->group->eos.c0 * F * in[SPH_SUM_DIFFUSION];
  if (part->tiles) out[6] += F * in[SPH_SUM_DENSITY];
  for (int q = 0; q < k->group->scalars && part->tiles; q++)
    out[8 + q] += F * in[SPH_SUM_SCALAR + q];
  if (!view->du) return;
  if (!(part->rates & SPH_PRESSURE_FORCE)) compression = pressed = 0;
  out[7] += energy_rate(k, d, dv, body[0] + F * in[SPH_SUM_HEAT], compression, pressed);
}
