/* Threads: wall time of right-hand sides and of whole steps over that with one, by turns, and
 * whether results are the same bits with 1, 2, 3 and 4 threads.
 *
 *   threads/FLOW/N        right-hand sides, lists as they are
 *   threads/dam/3d/N      whole steps of leapfrog: walls, lists, integrator, all
 *   threads/FLOW/cpu/N    CPU time of all threads over that of one: what is lost to waiting
 *
 * N: as many threads as processors, and what is between; more are only compared. */
#define _POSIX_C_SOURCE 200809L
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "bench.h"
#include "bench_flow.h"

enum { REPEATS = 9, MOST = 16, COMPARED = 4 };

static double seconds(clockid_t clock)
{
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct flow {
  const char *name;
  const bench_flow *rhs; /* NULL: the dam break, in whole steps */
} flow;

static sph_sim *make(const flow *f, int threads)
{
  const bench_dam_def dam = {bench_quick() ? 10 : 29, 2, "antuono", "leapfrog", 0.1, threads};
  if (!f->rhs) return bench_flow_dam(&dam);
  sph_sim *sim = bench_flow_make(f->rhs, -1, threads);
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  return sim;
}

static void go(const flow *f, sph_sim *sim)
{
  if (f->rhs ? sph_sim_evaluate(sim) : sph_sim_step(sim)) bench_complain("%s", sph_sim_error(sim));
}

/* Wall and CPU seconds of one. */
static void measure(const flow *f, sph_sim *sim, double *wall, double *cpu)
{
  const double begin = seconds(CLOCK_MONOTONIC), used = seconds(CLOCK_PROCESS_CPUTIME_ID);
  go(f, sim);
  *wall = seconds(CLOCK_MONOTONIC) - begin;
  *cpu = seconds(CLOCK_PROCESS_CPUTIME_ID) - used;
}

static void report(const flow *f, int threads, double wall[2][REPEATS], double cpu[2][REPEATS])
{
  char name[80], baseline[80];
  double ratio[REPEATS], own[REPEATS];
  snprintf(baseline, sizeof baseline, "one thread");
  snprintf(name, sizeof name, "threads/%s/%d", f->name, threads);
  for (int k = 0; k < REPEATS; k++) ratio[k] = wall[0][k] / wall[1][k], own[k] = 1e3 * wall[1][k];
  bench_report_over(name, "ms", own, REPEATS, baseline, ratio);
  snprintf(name, sizeof name, "threads/%s/cpu/%d", f->name, threads);
  for (int k = 0; k < REPEATS; k++) ratio[k] = cpu[1][k] / cpu[0][k], own[k] = 1e3 * cpu[1][k];
  bench_report_over(name, "ms", own, REPEATS, baseline, ratio);
}

static void measure_beside_one(const flow *f, int threads)
{
  double wall[2][REPEATS], cpu[2][REPEATS];
  sph_sim *one = make(f, 1), *all = make(f, threads);
  for (int k = -2; k < REPEATS; k++) {
    const int at = k < 0 ? 0 : k;
    measure(f, one, &wall[0][at], &cpu[0][at]);
    measure(f, all, &wall[1][at], &cpu[1][at]);
  }
  report(f, threads, wall, cpu);
  sph_sim_free(one);
  sph_sim_free(all);
}

/* Entries of the state whose bits differ after some steps. */
static long differing(const sph_sim *a, const sph_sim *b)
{
  static const char *const field[] = {"position", "velocity", "density"};
  long bits = 0;
  const sph_group *x = NULL;
  for (int g = 0; (x = sph_sim_group_get(a, g)); g++) {
    const sph_group *y = sph_sim_group_get(b, g);
    for (int q = 0; q < 9; q++) {
      const double *p = sph_group_read(x, field[q / 3], q % 3);
      const double *r = sph_group_read(y, field[q / 3], q % 3);
      for (long i = 0; p && r && i < sph_group_count(x); i++)
        bits += memcmp(&p[i], &r[i], sizeof *p) != 0;
    }
  }
  return bits;
}

static void compare(const flow *f)
{
  char name[80];
  sph_sim *one = make(f, 1);
  for (int k = 0; k < 3; k++) sph_sim_step(one);
  for (int threads = 2; threads <= COMPARED; threads++) {
    sph_sim *other = make(f, threads);
    for (int k = 0; k < 3; k++) sph_sim_step(other);
    double differ = (double)differing(one, other) + (sph_sim_status(other) != SPH_OK);
    snprintf(name, sizeof name, "threads/%s/other-bits/%d", f->name, threads);
    bench_report(name, "entries", &differ, 1);
    if (differ > 0) bench_complain("%s: results depend on the threads", f->name);
    sph_sim_free(other);
  }
  sph_sim_free(one);
}

void bench_threads(void)
{
  if (!bench_filtered()) return; /* it needs idle processors */
  const long a3 = bench_quick() ? 20 : 46, a2 = bench_quick() ? 100 : 316;
  const bench_flow rhs[] = {{"", "wendland-c2", 3, a3, 0, "molteni", 3, NULL},
                            {"", "wendland-c2", 3, a3, 0, "antuono", 3, NULL},
                            {"", "wendland-c2", 2, a2, 0, "antuono", 3, NULL}};
  const flow flows[] = {{"3d/molteni", &rhs[0]},
                        {"3d/antuono", &rhs[1]},
                        {"2d/antuono", &rhs[2]},
                        {"dam/3d", NULL}};
  long most = sysconf(_SC_NPROCESSORS_ONLN);
  if (most > MOST) most = MOST;
  for (unsigned k = 0; k < sizeof flows / sizeof *flows; k++) {
    char name[80];
    snprintf(name, sizeof name, "threads/%s", flows[k].name);
    if (!bench_wanted(name)) continue;
    for (int threads = 2; threads <= most; threads *= 2) measure_beside_one(&flows[k], threads);
    compare(&flows[k]);
  }
}
