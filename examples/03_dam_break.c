/* 03_dam_break -- a column of water falls: the first whole simulation.
 *
 * Equations  d rho/dt = -rho div v + delta diffusion,
 *            p = p(rho) (Tait, c0 ten times the water's speed),
 *            dv/dt = -grad p/rho + artificial viscosity + g
 * Reference  B. Buchner (2002), Green water on ship-type offshore structures: column 2H x H, tank
 *            5.366 H long; A. Ritter (1892): a front on a dry bed is slower than 2 sqrt(g H)
 * Run        ./03_dam_break [H/dx, default 40]     writes ./dam_break/
 * See        paraview dam_break/snapshot.hdf.series, or: sphode plot dam_break
 * Check      at t = 1.2 sqrt(H/g) the front has run between 0.4 and 1 times 2 sqrt(g H) t */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

static double front(const sph_group *water)
{
  const double *x = sph_group_read(water, "position", 0);
  double most = 0;
  for (long i = 0; i < sph_group_count(water); i++) most = fmax(most, x[i]);
  return most;
}

int main(int argc, char **argv)
{
  const double H = 0.6, dx = H / (argc > 1 ? atof(argv[1]) : 40), g = 9.81; /* [m], [m], [m/s^2] */
  const double rho0 = 1000, c0 = 20 * sqrt(g * H);                          /* [kg/m^3], [m/s] */

  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .kernel = "wendland-c2"});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){2 * H, H}, rho0);
  sph_group *tank =
      sph_group_walls(sim, "tank", (double[]){0, 0}, (double[]){5.366 * H, 3 * H}, rho0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_group_set_boundary(tank, sph_boundary_adami());

  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, -g}));

  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "erk:bogacki-shampine-4-2-3"});
  sph_sim_add_output(sim, sph_output_hdf5("dam_break", 0.05));

  double t = 1.2 * sqrt(H / g), run = 0;
  int status = sph_sim_run(sim, t);
  if (status == SPH_OK) {
    run = (front(water) - 2 * H) / (2 * sqrt(g * H) * t);
    printf("t = %.4f s: the front has run %.3f of 2 sqrt(g H) t\n", t, run);
  } else
    fprintf(stderr, "dam_break: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return status != SPH_OK || run < 0.4 || run > 1;
}
