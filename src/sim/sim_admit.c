/* Phase admit: are the rates finite, the particles apart?  And the step limits that this evaluation
 * gives. */
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "count_pair.h"
#include "sim_extremes.h"
#include "sim_failure.h"
#include "sim_rhs.h"
#include "term_scalar_diffusion.h"

enum { PARALLEL_MIN = 4096 };

int sph_sim_admit_retry(sph_sim *sim, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sim->retry, sizeof sim->retry, format, arguments);
  va_end(arguments);
  return SPH_RETRY;
}

/* What one share of the targets counts, each in a place of its own of the group's first sums. */
typedef struct counting {
  const sph_sim *sim;
  int g;
  count_constants constants;
} counting;

static void count_share(void *ctx, const sph_share *share)
{
  const counting *k = ctx;
  const sph_sim *sim = k->sim;
  const sph_group *group = sim->group[k->g];
  sph_pair_function *loop = sph_count_loop(sim->isa, sim->dim);
  double *const *sum = share->sum, near = 0, pairs = 0;
  const long place = share->begin / SPH_SHARE_BLOCKS;
  const long n = sph_sim_pairs_targets(sim, k->g, share);
  for (int s = 0; s < sim->groups; s++)
    if (sph_sim_interaction_same_species(group, sim->group[s]))
      sph_sim_pairs_loop_share(sim, share, loop, k->g, s, &k->constants);
  for (long s = 0; s < n; s++) near += sum[SPH_COUNT_NEAR][s] > 0 || sum[SPH_COUNT_ZERO][s] > 1;
  for (int s = 0; s < sim->groups; s++) /* these may be as near as they like */
    if (sph_sim_drag_acts(sim, group, sim->group[s]))
      sph_sim_pairs_loop_share(sim, share, loop, k->g, s, &k->constants);
  for (long s = 0; s < n; s++) pairs += sum[SPH_COUNT_PAIRS][s];
  sim->sorted[k->g].sum[0][place] = near;
  sim->sorted[k->g].sum[1][place] = pairs;
}

/* After some list builds: pairs inside the support, and particles nearer than 0.1 dx to another.
 * These are reported, not refused: lone particles of spray may stick together, and a smaller step
 * would not part them. */
static void count(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  double near = 0;
  sim->pairs_now = 0;
  for (int g = 0; g < sim->groups; g++) {
    counting k = {sim, g, {.H2 = sim->H * sim->H, .near2 = 0.01 * sim->dx * sim->dx}};
    if (sim->group[g]->wall) continue;
    const long shares = sph_sim_pairs_share(sim, g, SPH_COUNT_SUMS, 1, count_share, &k);
    for (long c = 0; c < shares; c++) {
      near += sim->sorted[g].sum[0][c];
      sim->pairs_now += sim->sorted[g].sum[1][c];
    }
  }
  sim->near = (long)near;
  sim->fresh = 0;
}

/* What one group's rates say. */
typedef struct extremes {
  double v2, a2, speed; /* max v^2, max a^2, max of c signal + |v| */
  double alpha;         /* of the artificial viscosities: the largest that acts */
  double lightest;      /* min rho */
  double heaviest;      /* max rho */
  long bad;             /* particles with a rate that is not finite, */
  long first;           /* the first of them */
} extremes;

/* Magnitude of all rates but the acceleration. */
static double others(const sph_sim *sim, const sph_view *view, long i)
{
  double sum = view->drho ? fabs(view->drho[i]) : 0;
  if (view->du) sum += fabs(view->du[i]);
  for (int q = 0; q < sim->terms.scalars; q++) sum += fabs(view->ds[q][i]);
  return sum;
}

/* alpha of the artificial viscosities among these terms. */
static double damping(const sph_sim *sim, unsigned terms)
{
  return fmax(terms & SPH_ARTIFICIAL ? sim->terms.alpha : 0,
              terms & SPH_SIGNAL ? sim->terms.signal_alpha : 0);
}

/* The alpha of each particle, where a switch varies it; else NULL. */
static const double *varied(const sph_evaluation *e, const sph_view *view)
{
  const int q = sph_term_set_alpha(&e->sim->terms);
  return q >= 0 && (e->part->limit_terms & (SPH_ARTIFICIAL | SPH_SIGNAL)) ? view->s[q] : NULL;
}

/* Speed of what goes with that of sound, over it.  Density diffuses with delta h c, at rates of up
 * to 6.9 delta c/h (lattices): within 0.8 S h/c tables damp S or more. */
static double signal_of(const sph_sim *sim, const sph_part *part, double alpha)
{
  const double waves = part->acoustic + 0.6 * alpha;
  return fmax(waves, part->limit_terms & SPH_DIFFUSION ? 5.5 * sim->terms.delta : 0);
}

/* What shifts particles parts neighbours at rates of up to 8 U/h (12 U/h at h = 1.2 dx). */
static double shifting(const sph_sim *sim, const sph_group *group)
{
  return 8 * sph_sim_shift_speed(sim, group);
}

static extremes look(const sph_evaluation *e, const sph_group *group, const sph_view *view)
{
  const sph_sim *sim = e->sim;
  const int motion = e->part->motion;
  const double *alpha = varied(e, view), all = damping(sim, e->part->limit_terms);
  double v2_max = 0, a2_max = 0, speed_max = 0, heaviest = 0, lightest = INFINITY,
         alpha_max = alpha ? 0 : all;
  const double sound_all = signal_of(sim, e->part, all);
  double least = e->part->limit_terms & SPH_SHIFTS ? shifting(sim, group) : 0;
  long bad = 0, first = LONG_MAX, n = view->n;
#pragma omp parallel for num_threads(sim->threads) schedule(static)                                \
    reduction(max : v2_max, a2_max, speed_max, alpha_max, heaviest) \
    reduction(min : lightest, first) reduction(+ : bad) if (n > PARALLEL_MIN)
  for (long i = 0; i < n; i++) {
    double v2 = 0, a2 = 0;
    for (int d = 0; d < sim->dim; d++) {
      v2 += view->v[d][i] * view->v[d][i];
      a2 += view->dv[d][i] * view->dv[d][i];
    }
    const double sound = alpha ? signal_of(sim, e->part, alpha[i]) : sound_all;
    double speed = (sound > 0 ? view->c[i] * sound : 0) + motion * sqrt(v2);
    speed = speed > least ? speed : least;
    if (alpha && alpha[i] > alpha_max) alpha_max = alpha[i];
    v2_max = v2 > v2_max ? v2 : v2_max;
    a2_max = a2 > a2_max ? a2 : a2_max;
    speed_max = speed > speed_max ? speed : speed_max;
    lightest = view->rho[i] < lightest ? view->rho[i] : lightest;
    heaviest = view->rho[i] > heaviest ? view->rho[i] : heaviest;
    const int is_bad = !(a2 + v2 + others(sim, view, i) < INFINITY);
    bad += is_bad;
    if (is_bad && i < first) first = i;
  }
  return (extremes){v2_max, a2_max, speed_max, alpha_max, lightest, heaviest, bad, first};
}

/* A gas may meet itself head on: its approach speed is up to 2 max |v|. */
static double slowest(const sph_evaluation *e, const sph_group *group, const extremes *x)
{
  const sph_sim *sim = e->sim;
  const unsigned terms = e->part->limit_terms;
  double beta = fmax(terms & SPH_ARTIFICIAL ? sim->terms.beta : 0,
                     terms & SPH_SIGNAL ? sim->terms.signal_beta / 2 : 0);
  double speed = x->speed;
  if (sph_term_set_alpha(&sim->terms) >= 0) beta *= x->alpha / sph_term_set_alpha_max(&sim->terms);
  if (group->eos.thermal) speed += (e->part->motion + 1.2 * beta) * sqrt(x->v2);
  return sim->h_sound / speed; /* no speed: no limit */
}

/* 0.125 h^2/nu (Morris, Fox & Zhu 1997); the central form is up to three times as stiff, for
 * compression.  At an interface the larger viscosity meets the smaller density. */
static double viscous(const sph_evaluation *e, const extremes *x)
{
  const sph_sim *sim = e->sim;
  const unsigned terms = e->part->limit_terms;
  double eta = 0, stiff = terms & SPH_MCG ? 3 : 1;
  if (!(terms & (SPH_MORRIS | SPH_MCG))) return INFINITY;
  for (int g = 0; g < sim->groups; g++)
    if (!sim->group[g]->wall) eta = fmax(eta, sim->group[g]->viscosity);
  return eta > 0 ? 0.125 * sim->h * sim->h * x->lightest / (eta * stiff) : INFINITY;
}

/* 0.125 h^2 rho c_v/kappa (Cleary & Monaghan 1999). */
static double conduction(const sph_evaluation *e, const sph_group *group, const extremes *x)
{
  const sph_sim *sim = e->sim;
  if (!(e->part->limit_terms & SPH_CONDUCTION) || group->conductivity == 0) return INFINITY;
  return 0.125 * sim->h * sim->h * x->lightest * group->eos.c_v / group->conductivity;
}

/* 0.125 h^2/D of scalars. */
static double diffusion(const sph_evaluation *e, const sph_group *group)
{
  const sph_term_set *set = &e->sim->terms;
  double D = 0;
  for (int k = 0; k < set->called; k++) {
    const sph_term *term = &set->call[k].term;
    if (e->part->limit_called >> k & 1)
      D = fmax(D, sph_term_scalar_diffusion_of(term, group->name, term->diffusivity));
  }
  return D > 0 ? 0.125 * e->sim->h * e->sim->h / D : INFINITY;
}

/* Half of the time in which a relative velocity decays, which leapfrog is just stable for. */
static double drag(const sph_evaluation *e)
{
  double rate = e->drag_rate[0] + e->drag_rate[1];
  return (e->part->limit_terms & SPH_DRAG) && rate > 0 ? 0.5 / rate : INFINITY;
}

static void lower(double *limit, double dt) { *limit = fmin(*limit, dt); }

int sph_sim_admit(sph_evaluation *e)
{
  sph_sim *sim = e->sim;
  const sph_part *part = e->part;
  double limit[SPH_BOUND_COUNT];
  for (int k = 0; k < SPH_BOUND_COUNT; k++) limit[k] = INFINITY;
  limit[SPH_BOUND_USER] = e->limit_user;
  if (sim->fresh) count(e);
  sim->extremes.mach_now = sim->extremes.density_now = 0;
  if (part->pairs && !part->only_walls) sim->pairs += sim->pairs_now;
  for (int g = 0; g < sim->groups; g++) {
    const sph_group *group = sim->group[g];
    if (group->wall) continue;
    const extremes x = look(e, group, &e->view[g]);
    if (x.bad) {
      sph_sim_failure_suspect(sim, g, x.first);
      return sph_sim_admit_retry(sim, "rates of %ld particles are not finite, %ld of %s first",
                                 x.bad, x.first, group->name);
    }
    sph_sim_extremes_see(sim, group, sqrt(x.v2), x.lightest, x.heaviest);
    lower(&limit[SPH_BOUND_CFL], slowest(e, group, &x));
    if (!group->eos.dust) lower(&limit[SPH_BOUND_VISCOUS], viscous(e, &x));
    lower(&limit[SPH_BOUND_CONDUCTION], conduction(e, group, &x));
    lower(&limit[SPH_BOUND_DIFFUSION], diffusion(e, group));
    if (x.a2 > 0) lower(&limit[SPH_BOUND_FORCE], 0.25 * sqrt(sim->h / sqrt(x.a2)));
  }
  limit[SPH_BOUND_DRAG] = drag(e);
  if (e->switch_rate > 0) limit[SPH_BOUND_SWITCH] = 1 / e->switch_rate;
  /* Else they stay those of the last good evaluation. */
  if (part == &sim->part[SPH_PIECE_FAST])
    memcpy(sim->limit_fast, limit, sizeof limit);
  else if (part == &sim->part[SPH_WHOLE] || part == &sim->part[SPH_PIECE_EXPLICIT] ||
           part == &sim->part[SPH_PIECE_KICK])
    memcpy(sim->limit, limit, sizeof limit);
  return SPH_OK;
}
