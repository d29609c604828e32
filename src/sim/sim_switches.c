/* The switches of artificial viscosity (term_switch.h), in two phases: behind `prepare` the
 * velocity gradient gives Balsara's factor and Morris & Monaghan's rate of alpha; behind `pairs`
 * the gradient of the accelerations, which are then known, gives Cullen & Dehnen's, on which
 * nothing else of this evaluation depends.
 *
 * Only fluid particles are seen, and images of them behind mirrors along which they slip: corrected
 * gradients are exact for linear fields at walls and surfaces too, and a wall along which a fluid
 * slips is no shear.  Images of all mirrors have the factor and alpha of their particles. */
#include <math.h>
#include <string.h>

#include "sim_mirror.h"
#include "sim_rhs.h"
#include "switch_loops.h"
#include "term_switch.h"

enum { PARALLEL_MIN = 2048 };
enum { V_SIG, DIVERGENCE, TRACE_LL, TRACE_SS }; /* kept in the records of the second pass */

/* The gradient [a][b] = d b_a/dx_b at sorted place s, from the sums. */
static void gradient(const sph_sim *sim, const sph_sorted *sorted, long s, double G[3][3])
{
  const int dim = sim->dim, first = switch_sum_G(dim);
  double factor[3][3];
  const int corrected = sph_sim_gradients_factor(sim, sorted->sum, s, factor);
  for (int a = 0; a < dim; a++) {
    for (int b = 0; b < dim; b++) G[a][b] = sim->F_scale * sorted->sum[first + a * dim + b][s];
    if (corrected) sph_sim_gradients_solve(dim, factor, G[a]);
  }
}

/* Sums over all particles of group g of what its neighbours in fluids give. */
static void sum(sph_sim *sim, int g, int pass)
{
  const int shock = pass == SPH_SWITCH_ACCELERATION, slots = switch_slots(sim->dim);
  sph_pair_function *loop = sph_switch_loop(sim->isa, sim->kernel_number, sim->dim, pass);
  sph_sim_pairs_clear(sim, g, switch_sum_more(sim->dim) + 1 + shock);
  for (int s = 0; s < sim->groups; s++) {
    const sph_group *source = sim->group[s];
    if ((source->wall && !sph_sim_mirror_slips(source)) ||
        !sph_sim_interaction_same_species(sim->group[g], source))
      continue;
    if (shock)
      sph_sim_pairs_loop_records(sim, loop, g, s, sim->sorted[g].shock, sim->sorted[s].shock, slots,
                                 &sim->constants);
    else
      sph_sim_pairs_loop(sim, loop, g, s, &sim->constants);
  }
}

static int acts(const sph_evaluation *e, int g)
{
  const sph_group *group = e->sim->group[g];
  return !group->wall && !group->eos.dust && e->view[g].n > 0;
}

/* ---- the velocity gradient ---- */

static double trace(int dim, double G[3][3])
{
  double sum = 0;
  for (int a = 0; a < dim; a++) sum += G[a][a];
  return sum;
}

static double curl(int dim, double L[3][3])
{
  if (dim < 2) return 0;
  const double z = L[1][0] - L[0][1];
  if (dim < 3) return fabs(z);
  const double x = L[2][1] - L[1][2], y = L[0][2] - L[2][0];
  return sqrt(x * x + y * y + z * z);
}

/* tr(L L) and tr(S S). */
static void traces(int dim, double L[3][3], double *LL, double *SS)
{
  const double mean = trace(dim, L) / dim;
  *LL = *SS = 0;
  for (int a = 0; a < dim; a++)
    for (int b = 0; b < dim; b++) {
      const double S = (L[a][b] + L[b][a]) / 2 - (a == b ? mean : 0);
      *LL += L[a][b] * L[b][a];
      *SS += S * S;
    }
}

/* What the second pass reads of particle i at sorted place s, but its acceleration. */
static void keep(const sph_sim *sim, const sph_view *view, sph_sorted *sorted, long s, long i,
                 double L[3][3])
{
  const int dim = sim->dim;
  const double *from = sorted->record + s * sorted->stride;
  double *to = sorted->shock + s * switch_slots(dim), *kept = to + switch_slot_kept(dim);
  const double divergence = trace(dim, L);
  for (int d = 0; d < dim; d++) to[d] = from[d];
  to[switch_slot_V(dim)] = from[slot_V(dim)];
  to[switch_slot_m(dim)] = view->m[i];
  to[switch_slot_sign(dim)] = divergence > 0 ? 1 : divergence < 0 ? -1 : 0;
  kept[V_SIG] = sorted->sum[switch_sum_more(dim)][s];
  kept[DIVERGENCE] = divergence;
  traces(dim, L, &kept[TRACE_LL], &kept[TRACE_SS]);
}

static void set(const sph_evaluation *e, int g, long s, long i)
{
  sph_sim *sim = e->sim;
  const sph_term_set *set = &sim->terms;
  const sph_view *view = &e->view[g];
  const int dim = sim->dim, q = sph_term_set_alpha(set);
  sph_sorted *sorted = &sim->sorted[g];
  double *record = sorted->record + s * sorted->stride, L[3][3];
  gradient(sim, sorted, s, L);
  const double divergence = trace(dim, L), c = view->c[i], compressed = fabs(divergence);
  const double all = compressed + curl(dim, L) + 1e-4 * c / sim->h;
  record[slot_f(dim)] = (set->bits & SPH_BALSARA) && all > 0 ? compressed / all : 1;
  record[slot_alpha(dim)] = q < 0 ? 1 : view->s[q][i] / sph_term_set_alpha_max(set);
  if (sorted->shock) keep(sim, view, sorted, s, i, L);
  if (!(set->bits & SPH_MORRIS_MONAGHAN) || !view->ds[q]) return; /* no rates are wanted */
  const double alpha = view->s[q][i];
  view->ds[q][i] += (set->alpha_min - alpha) * SPH_SWITCH_DECAY * c / sim->h +
                    fmax(-divergence, 0) * (sph_term_set_alpha_max(set) - alpha);
}

int sph_sim_switches(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  for (int g = 0; g < sim->groups && e->part->switches; g++) {
    if (!acts(e, g)) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    const long n = e->view[g].n;
    sum(sim, g, SPH_SWITCH_VELOCITY);
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s++) set(e, g, s, order[s]);
  }
  if (e->part->switches) sph_sim_mirror_copy(sim, slot_alpha(sim->dim), slot_f(sim->dim) + 1);
  return SPH_OK;
}

/* ---- Cullen & Dehnen: the gradient of the accelerations ---- */

static void take_accelerations(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const int *order = sph_neighbors_order(sim->neighbors, g), dim = sim->dim;
  const long n = e->view[g].n, stride = switch_slots(dim);
  double *record = sim->sorted[g].shock;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s++)
    for (int d = 0; d < dim; d++)
      record[s * stride + switch_slot_a(dim) + d] = e->view[g].dv[d][order[s]];
  for (long s = n; s < sim->sorted[g].room; s++) /* finite, and never stored */
    memcpy(record + s * stride, record + (n - 1) * stride, (size_t)stride * sizeof *record);
}

/* Images have acceleration and sign of their particles, reflected. */
static void show_images(const sph_evaluation *e, int g)
{
  const sph_sim *sim = e->sim;
  const sph_group *group = sim->group[g];
  const sph_sorted *sorted = &sim->sorted[g];
  const int *order = sph_neighbors_order(sim->neighbors, g), dim = sim->dim;
  const int slots = switch_slots(dim);
  const long n = e->view[g].n;
#pragma omp parallel for num_threads(sim->threads) schedule(static) if (n > PARALLEL_MIN)
  for (long s = 0; s < n; s++) {
    const sph_ghost *ghost = &group->ghost[order[s]];
    const double *record = sorted->record + s * sorted->stride;
    double *to = sorted->shock + s * slots;
    memcpy(to, sim->sorted[ghost->group].shock + sph_sim_mirror_parent(sim, ghost) * slots,
           (size_t)slots * sizeof *to);
    for (int d = 0; d < dim; d++) to[d] = record[d];
    sph_sim_mirror_turn(sim, ghost, to + switch_slot_a(dim));
  }
  for (long s = n; n > 0 && s < sorted->room; s++)
    memcpy(sorted->shock + s * slots, sorted->shock + (n - 1) * slots,
           (size_t)slots * sizeof *sorted->shock);
}

/* Returns the rate at which alpha is drawn to where it rises to, else 0 [1/s]. */
static double rise_or_fall(const sph_evaluation *e, int g, long s, long i)
{
  const sph_sim *sim = e->sim;
  const sph_term_set *set = &sim->terms;
  const sph_sorted *sorted = &sim->sorted[g];
  const int dim = sim->dim, q = sph_term_set_alpha(set), more = switch_sum_more(dim);
  const double *kept = sorted->shock + s * switch_slots(dim) + switch_slot_kept(dim);
  const double v_sig = kept[V_SIG], h = sim->h, alpha = e->view[g].s[q][i];
  double G[3][3];
  gradient(sim, sorted, s, G);
  const double R = sorted->sum[more][s] / sorted->sum[more + 1][s];
  const double b = 2 * pow(1 - R, 4) * kept[DIVERGENCE], both = b * b + kept[TRACE_SS];
  const double xi = both > 0 ? b * b / both : 0;
  const double A = xi * fmax(kept[TRACE_LL] - trace(dim, G), 0);
  const double scale = v_sig * v_sig + h * h * A;
  const double local = scale > 0 ? sph_term_set_alpha_max(set) * h * h * A / scale : 0;
  const double difference = fmax(local, set->alpha_min) - alpha;
  const double rate = v_sig / (h * (difference > 0 ? SPH_SWITCH_RISE : SPH_SWITCH_FALL));
  e->view[g].ds[q][i] += difference * rate;
  return difference > 0 ? rate : 0;
}

int sph_sim_switches_rates(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  if (!e->part->switches || !(sim->terms.bits & SPH_CULLEN_DEHNEN)) return SPH_OK;
  for (int g = 0; g < sim->groups; g++)
    if (acts(e, g)) take_accelerations(e, g);
  for (int g = 0; g < sim->groups; g++)
    if (sph_sim_mirror_slips(sim->group[g])) show_images(e, g);
  for (int g = 0; g < sim->groups; g++) {
    if (!acts(e, g)) continue;
    const int *order = sph_neighbors_order(sim->neighbors, g);
    const long n = e->view[g].n;
    double most = e->switch_rate;
    sum(sim, g, SPH_SWITCH_ACCELERATION);
#pragma omp parallel for num_threads(sim->threads) schedule(static) \
    reduction(max                                                   \
              : most) if (n > PARALLEL_MIN)
    for (long s = 0; s < n; s++) {
      const double rate = rise_or_fall(e, g, s, order[s]);
      most = rate > most ? rate : most;
    }
    e->switch_rate = most;
  }
  return SPH_OK;
}
