/* What output costs: a column of water that breaks, SPHERIC's test 2 without its obstacle, of SIZE
 * particles, walls besides; a snapshot in 1/20 s of simulated time.
 *
 *   output/3d/SIZE/KIND/frame   one snapshot: this thread's CPU, compression and all
 *   output/3d/SIZE/KIND/wall    the same, by the clock: with the disk
 *   output/3d/SIZE/KIND/bytes   a particle, walls among them
 *   output/3d/SIZE/KIND/share   frame over the steps of leapfrog, of this thread, in 1/20 s
 *
 * KIND: default (compression 1), single (precision), none (no compression). */
#define _POSIX_C_SOURCE 200809L
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "bench.h"

enum { REPEATS = 3, STEPS = 4 };
static const double interval = 1. / 20; /* [s] */

static double clock_seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* n spacings in the height of the column. */
static sph_sim *make(int n)
{
  const double H = 0.55, dx = H / n, g = 9.81, c0 = 44.29, rho = 1000;
  const double lo[3] = {0}, column[3] = {1.228, 1, H}, tank[3] = {3.22, 1, 1};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", lo, column, rho);
  sph_group *wall = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(wall, lo, tank, "z+", rho);
  sph_group_set_eos(water, sph_eos_tait(rho, c0, 7));
  sph_group_set_boundary(wall, sph_boundary_adami());
  sph_group_set_hydrostatic(water, 2, H, g);
  sph_group_jitter(water, 0.1, 1); /* digits as of a run that has gone on */
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.01, 0));
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, 0, -g}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "leapfrog"});
  return sim;
}

static double particles(const sph_sim *sim)
{
  const sph_group *group;
  double n = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) n += (double)sph_group_count(group);
  return n;
}

/* CPU of the steps in an interval [s]: that of some steps, as long as they are. */
static double steps(sph_sim *sim)
{
  sph_sim_step(sim); /* the first lists */
  double begin = bench_thread_seconds(), start = sph_sim_time(sim);
  for (int k = 0; k < STEPS; k++) sph_sim_step(sim);
  if (sph_sim_status(sim)) bench_complain("%s", sph_sim_error(sim));
  return (bench_thread_seconds() - begin) * interval / (sph_sim_time(sim) - start);
}

static void measure(sph_sim *sim, const char *size, const char *kind, const sph_hdf5_def *def,
                    double between)
{
  char name[100], path[4096];
  double frame[REPEATS], wall[REPEATS], share[REPEATS], bytes = 0;
  struct stat info;
  sph_error error = {0};
  sph_output output = sph_output_hdf5_def(def);
  int status = output.open(output.ctx, sim, &error);
  for (int k = 0; k < REPEATS && !status; k++) {
    double cpu = bench_thread_seconds(), clock = clock_seconds();
    status = output.frame(output.ctx, sim, &error);
    frame[k] = bench_thread_seconds() - cpu;
    wall[k] = clock_seconds() - clock;
    share[k] = 100 * frame[k] / between;
    snprintf(path, sizeof path, "%s/snapshot_%04d.hdf", def->directory, k);
    if (!status && stat(path, &info) == 0) bytes = (double)info.st_size / particles(sim);
    unlink(path);
    snprintf(path, sizeof path, "%s/walls_%04d.hdf", def->directory, k);
    unlink(path);
  }
  output.free(output.ctx);
  if (status) bench_complain("%s", error.text);
  if (status) return;
  snprintf(name, sizeof name, "output/3d/%s/%s/frame", size, kind);
  bench_report(name, "s", frame, REPEATS);
  snprintf(name, sizeof name, "output/3d/%s/%s/wall", size, kind);
  bench_report(name, "s", wall, REPEATS);
  snprintf(name, sizeof name, "output/3d/%s/%s/bytes", size, kind);
  bench_report(name, "B", &bytes, 1);
  snprintf(name, sizeof name, "output/3d/%s/%s/share", size, kind);
  bench_report(name, "%", share, REPEATS);
}

static void measure_size(const char *size, int n)
{
  static const struct {
    const char *name;
    int single, compression;
  } kinds[] = {{"default", 0, 0}, {"single", 1, 0}, {"none", 0, -1}};
  char directory[] = "/tmp/sphode-bench-XXXXXX", name[60], path[80];
  snprintf(name, sizeof name, "output/3d/%s", size);
  if (!bench_wanted(name) || !mkdtemp(directory)) return;
  sph_sim *sim = make(n);
  const double between = steps(sim);
  for (int k = 0; k < 3; k++)
    measure(sim, size, kinds[k].name,
            &(sph_hdf5_def){.directory = directory,
                            .single = kinds[k].single,
                            .compression = kinds[k].compression},
            between);
  for (int k = 0; k < 2; k++) {
    snprintf(path, sizeof path, "%s/%s.hdf.series", directory, k ? "walls" : "snapshot");
    unlink(path);
  }
  rmdir(directory);
  sph_sim_free(sim);
}

void bench_output(void)
{
  if (!bench_filtered()) return;
  measure_size("1e5", 29);
  if (!bench_quick()) measure_size("1e6", 63); /* a minute, 2 GB */
}
