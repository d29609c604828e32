#include "bench_flow.h"

#include <math.h>
#include <stdlib.h>

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

sph_sim *bench_flow_make(const bench_flow *s, double skin, int threads)
{
  const sph_kernel *kernel = sph_kernel_find(s->kernel);
  double dx = 1.0 / (double)s->across, c0 = 10;
  sph_sim_def def = {.dim = s->dim,
                     .dx = dx,
                     .kernel = s->kernel,
                     .h_over_dx = s->support / sph_kernel_support(kernel),
                     .skin = skin,
                     .threads = threads,
                     .precision = s->precision};
  double lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
  for (int d = 0; d < s->dim; d++) {
    def.periodic[d] = 1;
    def.length[d] = 1;
    def.origin[d] = 0.37 * dx * (d + 1);
  }
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", lo, hi, 1000);
  sph_eos eos = s->thermal ? sph_eos_ideal_gas(1.4) : sph_eos_tait(1000, c0, 7);
  eos.c0 = c0; /* the density diffusion of the thermal one needs it, too */
  sph_group_set_eos(fluid, eos);
  unsigned state = 1;
  for (int d = 0; d < s->dim; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && i < sph_group_count(fluid); i++) {
      v[i] = sin(6.28 * x[i]) + 0.05 * noise(&state);
      x[i] += 0.2 * dx * noise(&state);
    }
  }
  double *u = sph_group_write(fluid, "energy", 0);
  for (long i = 0; u && i < sph_group_count(fluid); i++) u[i] = 100;
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  if (s->delta) sph_sim_add_term(sim, sph_term_delta(s->delta, 0.1));
  return sim;
}

sph_sim *bench_flow_dam(const bench_dam_def *def)
{
  const double H = 0.55, dx = H / def->n, g = 9.81, c0 = 44.29, rho = 1000;
  const double length = dx * rint(3.22 / dx), width = dx * rint(1 / dx);
  const double front = dx * rint(2.3955 / dx), side = dx * rint(0.161 / dx);
  const double near = dx * rint((width - 0.403) / (2 * dx));
  const double lo[3] = {0}, column[3] = {1.228, width, H}, tank[3] = {length, width, 1};
  const double box[3] = {front, near, 0}, top[3] = {front + side, width - near, side};
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = 3, .dx = dx, .h_over_dx = def->h_over_dx, .threads = def->threads});
  sph_group *water = sph_group_box(sim, "water", lo, column, rho);
  sph_group *wall = sph_group_create(sim, "tank", "wall");
  sph_group_add_layers(wall, lo, tank, "z+", rho);
  sph_group_add_box(wall, box, top, rho);
  sph_group_set_eos(water, sph_eos_tait(rho, c0, 7));
  sph_group_set_boundary(wall, sph_boundary_adami());
  sph_group_set_hydrostatic(water, 2, H, g);
  if (def->jitter > 0) sph_group_jitter(water, def->jitter, 1);
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.001, 0));
  sph_sim_add_term(sim, sph_term_delta(def->delta, 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, 0, -g}));
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = def->method});
  return sim;
}
