/* Walls of particles hold: a block of water hits a floor, and a corner, in 2D and in 3D, at Mach
 * numbers from 0.03 to 0.3, is squeezed, breaks up and lies down.  No particle is deeper
 * behind the surface of the wall than 0.25 dx up to Mach 0.1 (0 in 2D), or than 0.5 dx, the first
 * layer of its particles, at 0.3, at any step.  It is the repulsion that does it; it takes no more
 * steps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>
#include <math.h>

#include "sphode.h"

static const double rho0 = 1000, c0 = 10;

typedef struct watch {
  int dim;
  double width, dx, least; /* of the box [m]; of any step, over dx */
} watch;

static int look(void *ctx, sph_sim *sim, sph_error *error)
{
  watch *w = ctx;
  const sph_group *water = sph_sim_group(sim, "water");
  (void)error;
  for (int d = 0; d < w->dim; d++) {
    const double *x = sph_group_read(water, "position", d);
    for (long i = 0; i < sph_group_count(water); i++)
      w->least = fmin(w->least, fmin(x[i], w->width - x[i]) / w->dx);
  }
  return SPH_OK;
}

/* A cube, `across` wide, in the corner of a closed box that is twice as wide, or above the middle
 * of its floor; it moves at c0 mach along the diagonal or down, and falls. */
static sph_sim *block(int dim, int across, double mach, int corner, int repulsion, watch *w)
{
  const double dx = 1.0 / across, at = corner ? dx : 0.5, U = mach * c0;
  double lo[3] = {0}, hi[3] = {2, 2, 2}, from[3], to[3], g[3] = {0};
  for (int d = 0; d < 3; d++) from[d] = d == dim - 1 ? dx : at, to[d] = from[d] + 1;
  g[dim - 1] = -U * U / 2;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = dim, .dx = dx, .h_over_dx = 1.5});
  sph_group *water = sph_group_box(sim, "water", from, to, rho0);
  sph_group *box = sph_group_create(sim, "box", "wall");
  sph_group_add_layers(box, lo, hi, NULL, rho0);
  sph_group_set_boundary(box, sph_boundary_adami());
  if (!repulsion) sph_group_set_repulsion(box, 0);
  sph_group_set_eos(water, sph_eos_tait(rho0, c0, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity(g));
  for (int d = 0; d < dim; d++) {
    double *v = sph_group_write(water, "velocity", d);
    for (long i = 0; v && i < sph_group_count(water); i++)
      v[i] = corner ? -U / sqrt(dim) : d == dim - 1 ? -U : 0;
  }
  *w = (watch){.dim = dim, .width = 2, .dx = dx, .least = INFINITY};
  sph_sim_add_output(sim, (sph_output){.name = "look", .frame = look, .ctx = w});
  return sim;
}

static double least(int dim, int across, double mach, int corner, int repulsion, long *steps)
{
  watch w;
  sph_sim_stats stats;
  sph_sim *sim = block(dim, across, mach, corner, repulsion, &w);
  if (sph_sim_run(sim, 8 / (mach * c0))) fail_msg("%s", sph_sim_error(sim));
  sph_sim_get_stats(sim, &stats);
  *steps = stats.step.steps;
  sph_sim_free(sim);
  return w.least;
}

static void hits(int dim, int across)
{
  static const double mach[] = {0.03, 0.1, 0.3};
  const double bar[] = {dim == 2 ? 0 : -0.25, dim == 2 ? 0 : -0.25, -0.5};
  for (int corner = 0; corner < 2; corner++)
    for (int k = 0; k < 3; k++) {
      long steps;
      const double near = least(dim, across, mach[k], corner, 1, &steps);
      print_message("# %dD, %s, Mach %.2f: least distance %.2f dx\n", dim,
                    corner ? "corner" : "floor", mach[k], near);
      assert_true(near >= bar[k]);
    }
}

/* Without it, the same water goes through the floor; steps are as long with it. */
static void what_holds(void **state)
{
  (void)state;
  long with, without;
  least(3, 5, 0.03, 0, 1, &with);
  const double near = least(3, 5, 0.03, 0, 0, &without);
  print_message("# without repulsion: %.2f dx; %ld steps, %ld with it\n", near, without, with);
  assert_true(near < -1);
  assert_true((double)with <= 1.25 * (double)without);
}

static void in_2d(void **state)
{
  (void)state;
  hits(2, 10);
}

static void in_3d(void **state)
{
  (void)state;
  hits(3, 5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(in_2d), cmocka_unit_test(in_3d),
                                     cmocka_unit_test(what_holds)};
  return cmocka_run_group_tests_name("walls that hold", tests, NULL, NULL);
}
