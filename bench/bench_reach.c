/* Physical time per right-hand side, in h/c0: how far an evaluation reaches at the default settings
 * of every explicit integrator.  A column 2H x H of water, H = 20 dx, in a tank of 5.366 H (and in
 * 3D one of H x H x H, H = 12 dx, in a tank of 3H x H); c0 = 20 sqrt(g H), Antuono's diffusion,
 * alpha = 0.02, Adami's walls; to t sqrt(g/H) = 2, when the front is on its way.  Counts, no
 * clock: the same on every machine. */
#include <sphode.h>
#include <stdio.h>
#include <string.h>

#include "bench.h"

static sph_sim *make(int dim, const char *method)
{
  const double H = 1, g = 9.81, dx = H / (dim == 3 ? 12 : 20), c0 = 20 * sqrt(g * H);
  const double lo[3] = {0, 0, 0};
  const double flat[3] = {2 * H, H, 0}, deep[3] = {H, H, H};
  const double tank2[3] = {5.366 * H, 3 * H, 0}, tank3[3] = {3 * H, H, 2 * H};
  const double down[3] = {0, dim == 2 ? -g : 0, dim == 3 ? -g : 0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", lo, dim == 3 ? deep : flat, 1000);
  sph_group *tank = sph_group_walls(sim, "tank", lo, dim == 3 ? tank3 : tank2, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, c0, 7));
  sph_group_set_boundary(tank, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity(down));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
  return sim;
}

static void measure(int dim, const sph_integrator_info *info)
{
  char name[80];
  snprintf(name, sizeof name, "reach/%dd/%s", dim, info->name);
  if (!bench_wanted(name) || !strncmp(info->name, "sprk:", 5)) return; /* need summed density */
  const double H = 1, g = 9.81;
  sph_sim *sim = make(dim, info->name);
  sph_sim_stats stats = {0};
  if (sph_sim_run(sim, 2 * sqrt(H / g))) {
    bench_complain("%s: %s", name, sph_sim_error(sim));
  } else {
    sph_sim_get_stats(sim, &stats);
    double reach =
        sph_sim_time(sim) * 20 * sqrt(g * H) / sph_sim_h(sim) / (double)stats.step.rhs_evaluations;
    bench_report(name, "h/c0", &reach, 1);
  }
  sph_sim_free(sim);
}

void bench_reach(void)
{
  sph_integrator_info info;
  if (!bench_filtered()) return; /* minutes, and the same figures on every machine */
  for (int dim = 2; dim <= 3; dim++)
    for (int k = 0; sph_integrator_info_get(k, &info); k++)
      if (!info.wants) measure(dim, &info);
}
