/* Derivatives of the right-hand side: times of products with the Jacobian and its transpose over
 * that of the right-hand side itself, and of a sparse Jacobian over that of one product. */
#include <sphode.h>
#include <sphode/sundials.h>
#include <stdio.h>

#include "bench.h"

enum { REPEATS = 3 };

static sph_sim *water(int dim, long across, int walls)
{
  const double side[3] = {1, 1, 1}, zero[3] = {0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = 1.0 / (double)across});
  sph_group *water = sph_group_box(sim, "water", zero, side, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10, 7));
  sph_group_jitter(water, 0.2, 1);
  if (walls) {
    sph_group *tank = sph_group_walls(sim, "tank", zero, side, 1000);
    sph_group_set_boundary(tank, sph_boundary_adami());
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  return sim;
}

/* Seconds of one call, of which: 0: f, 1: J s, 2: J^T w. */
static double seconds(sph_sim *sim, int which, N_Vector s, N_Vector z)
{
  N_Vector y = sph_sim_vector(sim);
  double begin = bench_thread_seconds();
  int calls = which == 0 ? 20 : 1;
  for (int k = 0; k < calls; k++) {
    if (which == 0) sph_sim_rhs(0, y, z, sim);
    if (which == 1) sph_sim_jacobian_times(s, z, 0, y, NULL, sim, NULL);
    if (which == 2) sph_sim_jacobian_transposed_times(s, z, 0, y, NULL, sim, NULL);
  }
  return (bench_thread_seconds() - begin) / calls;
}

static void products(int dim, long across, int walls)
{
  static const char *const what[] = {NULL, "product", "transposed"};
  char name[3][80];
  for (int k = 1; k < 3; k++)
    snprintf(name[k], sizeof name[k], "derivatives/%dd/%s%s/over-rhs", dim, what[k],
             walls ? "-walls" : "");
  if (!bench_wanted(name[1]) && !bench_wanted(name[2])) return;
  sph_sim *sim = water(dim, across, walls);
  N_Vector y = sph_sim_vector(sim), s = N_VClone(y), z = N_VClone(y);
  double ratio[3][REPEATS];
  N_VConst(1, s);
  for (int k = -1; k < REPEATS; k++) {
    double f = seconds(sim, 0, s, z);
    for (int which = 1; which < 3; which++) {
      double share = seconds(sim, which, s, z) / f;
      if (k >= 0) ratio[which][k] = share;
    }
  }
  if (sph_sim_status(sim)) bench_complain("%s", sph_sim_error(sim));
  for (int which = 1; which < 3; which++) bench_report(name[which], "1", ratio[which], REPEATS);
  N_VDestroy(s);
  N_VDestroy(z);
  sph_sim_free(sim);
}

/* Products that a sparse Jacobian takes: colours times fields. */
static void matrix(int dim, long across, int walls)
{
  char name[80];
  double value;
  snprintf(name, sizeof name, "derivatives/%dd/jacobian%s/products", dim, walls ? "-walls" : "");
  if (!bench_wanted(name) || (dim == 3 && !bench_filtered())) return;
  sph_sim *sim = water(dim, across, walls);
  sph_jacobian *J = sph_jacobian_create(sim, NULL);
  if (sph_jacobian_evaluate(J)) bench_complain("%s", sph_sim_error(sim));
  value = J ? (double)J->products : 0;
  bench_report(name, "1", &value, 1);
  sph_jacobian_free(J);
  sph_sim_free(sim);
}

void bench_derivatives(void)
{
  const int quick = bench_quick();
  products(2, quick ? 20 : 60, 0);
  products(2, quick ? 20 : 60, 1);
  products(3, quick ? 8 : 16, 0);
  matrix(2, quick ? 8 : 16, 0);
  matrix(2, quick ? 8 : 16, 1);
  matrix(3, 6, 0);
}
