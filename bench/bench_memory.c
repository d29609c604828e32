/* Memory of a simulation after some steps, by parts, in bytes a particle.  The whole is what the
 * system counts as this program's own pages: memory that was taken and never touched costs none. */
#include <sphode.h>
#include <stdio.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bench.h"
#include "sim_data.h"

enum { STEPS = 3 };

/* Own pages [B]; 0 where the system does not tell. */
static double resident(void)
{
  char line[200];
  double kilobytes = 0;
  FILE *file = fopen("/proc/self/status", "r");
  while (file && fgets(line, sizeof line, file)) sscanf(line, "RssAnon: %lf", &kilobytes);
  if (file) fclose(file);
  return 1024 * kilobytes;
}

static sph_sim *make(long across, const char *method)
{
  const double dx = 1.0 / (double)across, lo[3] = {0}, hi[3] = {1, 1, 1};
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 3, .dx = dx, .speed = 1, .periodic = {1, 1, 1}, .length = {1, 1, 1}});
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, 10, 7));
  sph_group_jitter(fluid, 0.1, 1);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
  return sim;
}

static void report(const char *method, const char *part, double bytes)
{
  char name[80];
  snprintf(name, sizeof name, "memory/3d/%s/%s", method, part);
  bench_report(name, "B", &bytes, 1);
}

/* What the loops read and write: records, sums; where particles were at the last list build. */
static double sorted_copy(const sph_sim *sim)
{
  const sph_sorted *sorted = &sim->sorted[0];
  double arrays = (double)sorted->stride + sim->dim;
  for (int s = 0; s < SPH_PAIR_SUMS; s++) arrays += sorted->sum[s] != NULL;
  return 8 * arrays * (double)sorted->room;
}

/* Fields that are not integrated, and the numbers of the particles. */
static double fields(const sph_sim *sim)
{
  const sph_group *group = sim->group[0];
  double arrays = 1;
  for (int f = 0; f < SPH_FIELDS; f++)
    for (int c = 0; c < 3; c++) arrays += group->own[f][c] != NULL;
  return 8 * arrays * (double)group->capacity;
}

static void measure(const char *method, long across)
{
  char name[80];
  snprintf(name, sizeof name, "memory/3d/%s", method);
  if (!bench_wanted(name)) return;
#ifdef __GLIBC__
  malloc_trim(0); /* what earlier ones left */
#endif
  double before = resident();
  sph_sim *sim = make(across, method);
  for (int k = 0; k < STEPS; k++) sph_sim_step(sim);
  double all = resident() - before, n = (double)across * (double)across * (double)across;
  if (sph_sim_status(sim)) fprintf(stderr, "bench: %s\n", sph_sim_error(sim));
  double copy = sorted_copy(sim), own = fields(sim), lists = sph_neighbors_bytes(sim->neighbors);
  report(method, "all", all / n);
  report(method, "sorted copy and sums", copy / n);
  report(method, "lists", lists / n);
  report(method, "fields", own / n);
  report(method, "state and integrator", (all - copy - lists - own) / n);
  sph_sim_free(sim);
}

void bench_memory(void)
{
  long across = bench_quick() ? 46 : 100;
  measure("leapfrog", across);
  measure("erk:bogacki-shampine-4-2-3", across);
}
