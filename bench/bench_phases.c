/* The right-hand side by phases, and the operations of vectors around it.
 *
 *   phases/FLOW/PHASE   nanoseconds a particle (of all groups), over the whole right-hand side, by
 *                       turns; pack and rates are in walls and pairs, too
 *   vectors/OPERATION   nanoseconds an entry, over a plain loop that does the same */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "bench_flow.h"
#include "nvector.h"
#include "sim_rhs.h"

enum { REPEATS = 9, VECTORS = 4 };

/* ---- phases ---- */

static int pack(sph_evaluation *e)
{
  sph_sim_pairs_pack(e, 0);
  return SPH_OK;
}

static int rates(sph_evaluation *e)
{
  for (int g = 0; g < e->sim->groups; g++)
    if (!e->sim->group[g]->wall) sph_sim_pairs_rates(e, g);
  return SPH_OK;
}

typedef struct phase {
  const char *name;
  int (*run)(sph_evaluation *e);
} phase;

static const phase phases[] = {{"lists", sph_sim_lists_update},
                               {"eos", sph_sim_material_eos},
                               {"bodies", sph_sim_bodies_add},
                               {"walls", sph_sim_walls_fill},
                               {"gradients", sph_sim_gradients},
                               {"pairs", sph_sim_pairs_add},
                               {"admit", sph_sim_admit},
                               {"pack", pack},
                               {"rates", rates}};
enum { PHASES = sizeof phases / sizeof *phases };

static double seconds_of(const phase *p, sph_evaluation *e)
{
  const double begin = bench_thread_seconds();
  const int status = p->run(e);
  const double seconds = bench_thread_seconds() - begin;
  if (status) bench_complain("phase %s: status %d", p->name, status);
  return seconds;
}

static double whole(sph_sim *sim)
{
  const double begin = bench_thread_seconds();
  if (sph_sim_rhs(sim->time, sim->y, sim->ydot, sim)) bench_complain("rhs failed");
  return bench_thread_seconds() - begin;
}

static void report(const char *flow, const char *name, double *seconds, double *ratio, long n)
{
  char full[100];
  snprintf(full, sizeof full, "phases/%s/%s", flow, name);
  for (int k = 0; k < REPEATS; k++) seconds[k] *= 1e9 / (double)n;
  bench_report_over(full, "ns", seconds, REPEATS, "the right-hand side", ratio);
}

static void measure_phases(const char *flow, sph_sim *sim)
{
  double seconds[PHASES][REPEATS], ratio[PHASES][REPEATS], all[REPEATS], one[REPEATS];
  long n = 0;
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  for (int g = 0; g < sim->groups; g++) n += sim->group[g]->n;
  for (int k = -1; k < REPEATS; k++) {
    const int at = k < 0 ? 0 : k;
    sph_evaluation e = {.sim = sim, .t = sim->time, .part = &sim->part[SPH_WHOLE]};
    all[at] = whole(sim);
    one[at] = 1;
    sph_sim_rhs_views(&e, sim->y, sim->ydot);
    for (int p = 0; p < PHASES; p++) {
      seconds[p][at] = seconds_of(&phases[p], &e);
      ratio[p][at] = seconds[p][at] / all[at];
    }
  }
  for (int p = 0; p < PHASES; p++) report(flow, phases[p].name, seconds[p], ratio[p], n);
  report(flow, "all", all, one, n);
  sph_sim_free(sim);
}

/* ---- vectors ---- */

typedef struct operands {
  N_Vector v[VECTORS], out;
  long n;
  double c[VECTORS], sum;
} operands;

static double *of(N_Vector v) { return sph_nvector_data(v); }

static void copy(operands *o) { N_VScale(1, o->v[0], o->out); }
static void linear_sum(operands *o) { N_VLinearSum(2, o->v[0], 3, o->v[1], o->out); }
static void combination(operands *o) { N_VLinearCombination(VECTORS, o->c, o->v, o->out); }
static void norm(operands *o) { o->sum += N_VWrmsNorm(o->v[0], o->v[1]); }

static void plain_copy(operands *o)
{
  const double *x = of(o->v[0]);
  double *z = of(o->out);
#pragma omp simd
  for (long i = 0; i < o->n; i++) z[i] = x[i];
}

static void plain_sum(operands *o)
{
  const double *x = of(o->v[0]), *y = of(o->v[1]);
  double *z = of(o->out);
#pragma omp simd
  for (long i = 0; i < o->n; i++) z[i] = 2 * x[i] + 3 * y[i];
}

/* One vector after another, as without a fused operation. */
static void plain_combination(operands *o)
{
  double *z = of(o->out);
  for (int k = 0; k < VECTORS; k++) {
    const double *x = of(o->v[k]), c = o->c[k];
#pragma omp simd
    for (long i = 0; i < o->n; i++) z[i] = (k ? z[i] : 0) + c * x[i];
  }
}

static void plain_norm(operands *o)
{
  const double *x = of(o->v[0]), *w = of(o->v[1]);
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (long i = 0; i < o->n; i++) sum += x[i] * w[i] * (x[i] * w[i]);
  o->sum += sqrt(sum / (double)o->n);
}

static double nanoseconds(void (*run)(operands *o), operands *o)
{
  const double begin = bench_thread_seconds();
  for (int k = 0; k < 8; k++) run(o);
  return 1e9 * (bench_thread_seconds() - begin) / (8.0 * (double)o->n);
}

static void measure_vector(const char *name, operands *o, void (*own)(operands *o),
                           void (*plain)(operands *o))
{
  double value[REPEATS], ratio[REPEATS];
  for (int k = -1; k < REPEATS; k++) {
    const int at = k < 0 ? 0 : k;
    value[at] = nanoseconds(own, o);
    ratio[at] = value[at] / nanoseconds(plain, o);
  }
  bench_report_over(name, "ns", value, REPEATS, "a plain loop", ratio);
}

static void measure_vectors(sph_sim *sim)
{
  operands o = {.n = sim->layout.length, .c = {0.5, 0.25, 0.125, 0.1}};
  o.out = N_VClone(sim->y);
  for (int k = 0; k < VECTORS; k++) {
    o.v[k] = N_VClone(sim->y);
    N_VConst(1 + k, o.v[k]);
  }
  measure_vector("vectors/copy", &o, copy, plain_copy);
  measure_vector("vectors/linear-sum", &o, linear_sum, plain_sum);
  measure_vector("vectors/combination-of-4", &o, combination, plain_combination);
  measure_vector("vectors/wrms-norm", &o, norm, plain_norm);
  for (int k = 0; k < VECTORS; k++) N_VDestroy(o.v[k]);
  N_VDestroy(o.out);
  sph_sim_free(sim);
}

static sph_sim *flow(const char *delta, long across)
{
  const bench_flow f = {"", "wendland-c2", 3, across, 0, delta, 3, NULL};
  return bench_flow_make(&f, -1, 1);
}

void bench_phases(void)
{
  const long across = bench_quick() ? 20 : 46;
  if (bench_wanted("phases/3d/molteni")) measure_phases("3d/molteni", flow("molteni", across));
  if (bench_wanted("phases/3d/antuono")) measure_phases("3d/antuono", flow("antuono", across));
  if (bench_wanted("phases/dam/3d"))
    measure_phases("dam/3d", bench_flow_dam(&(bench_dam_def){bench_quick() ? 10 : 29, 2, "antuono",
                                                             "leapfrog", 0.1, 1}));
  if (!bench_wanted("vectors")) return;
  sph_sim *sim = flow("molteni", bench_quick() ? 20 : 100);
  if (!sph_sim_evaluate(sim)) measure_vectors(sim);
}
