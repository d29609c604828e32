/* Memory of a simulation after some steps, by parts, in bytes a particle: a block of liquid in open
 * space.  The whole is what the system counts as this program's own pages: memory that was taken
 * and never touched costs none.  Room for growth that was used once may stay. */
#include <sphode.h>
#include <stdio.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "bench.h"
#include "resident.h"
#include "sim_data.h"

enum { STEPS = 3 };

static sph_sim *make(long across, const char *method)
{
  const double dx = 1.0 / (double)across, lo[3] = {0}, hi[3] = {1, 1, 1};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = dx, .speed = 1});
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

static void report(const char *what, const char *part, double bytes)
{
  char name[100];
  snprintf(name, sizeof name, "%s/%s", what, part);
  bench_report(name, "B", &bytes, 1);
}

/* What the loops read; where particles were at the last list build.  Sums are of the moment. */
static double sorted_copy(const sph_sim *sim)
{
  const sph_sorted *sorted = &sim->sorted[0];
  return 8 * (double)(sorted->stride + sim->dim) * (double)sorted->room;
}

/* Fields that are not integrated, but u, which nobody writes. */
static double fields(const sph_sim *sim)
{
  const sph_group *group = sim->group[0];
  double arrays = group->id != NULL;
  for (int f = 0; f < SPH_FIELDS; f++)
    for (int c = 0; f != SPH_ENERGY && c < 3; c++) arrays += group->own[f][c] != NULL;
  return 8 * arrays * (double)group->n;
}

/* Runs, blocks; the search's order and cells. */
static double lists(const sph_sim *sim)
{
  const sph_list list = sph_neighbors_list(sim->neighbors, 0, 0);
  return (double)list.first[list.blocks] * sizeof *list.runs +
         (double)list.blocks * sizeof *list.first + (double)sim->group[0]->n * 2 * sizeof(int);
}

static void measure(const char *what, const char *method, long across)
{
  char name[60];
  snprintf(name, sizeof name, "%s/3d/%s", what, method);
  if (!bench_wanted(name)) return;
#ifdef __GLIBC__
  malloc_trim(0); /* what earlier ones left */
#endif
  double before = resident();
  sph_sim *sim = make(across, method);
  for (int k = 0; k < STEPS; k++) sph_sim_step(sim);
  double all = resident() - before, n = (double)across * (double)across * (double)across;
  if (sph_sim_status(sim)) bench_complain("%s", sph_sim_error(sim));
  double copy = sorted_copy(sim), own = fields(sim), near = lists(sim);
  report(name, "all", all / n);
  report(name, "sorted copy", copy / n);
  report(name, "lists", near / n);
  report(name, "fields", own / n);
  report(name, "state and integrator", (all - copy - near - own) / n);
  sph_sim_free(sim);
}

void bench_memory(void)
{
  long across = bench_quick() ? 46 : 100;
  measure("memory", "leapfrog", across);
  measure("memory", "erk:bogacki-shampine-4-2-3", across);
  if (bench_filtered()) measure("bytes-1e7", "leapfrog", 216); /* 1e7 particles, minutes */
}
