/* instructions -- the work whose instructions build-aux/check-instructions counts (callgrind):
 * fused loops by their own names, steps by the names of the functions here.  One thread, the same
 * numbers every time. */
#include <sphode.h>
#include <stdio.h>

enum { STEPS = 3 };

static int failed;

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

/* A jittered periodic lattice with a smooth flow, unaligned with the cells of the search. */
static sph_sim *flow(int dim, const char *kernel, const char *delta)
{
  const long across = dim == 3 ? 12 : dim == 2 ? 40 : 400;
  const double dx = 1.0 / (double)across, corner[3] = {0}, far[3] = {1, 1, 1};
  sph_sim_def def = {.dim = dim, .dx = dx, .kernel = kernel};
  def.h_over_dx = 3 / sph_kernel_support(sph_kernel_find(kernel));
  for (int d = 0; d < dim; d++) {
    def.periodic[d] = 1;
    def.length[d] = 1;
    def.origin[d] = 0.37 * dx * (d + 1);
  }
  sph_sim *sim = sph_sim_create(&def);
  sph_group *fluid = sph_group_box(sim, "fluid", corner, far, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, 10, 7));
  unsigned state = 1;
  for (int d = 0; d < dim; d++) {
    double *x = sph_group_write(fluid, "position", d), *v = sph_group_write(fluid, "velocity", d);
    for (long i = 0; x && v && i < sph_group_count(fluid); i++) {
      v[i] = 0.5 * noise(&state);
      x[i] += 0.2 * dx * noise(&state);
    }
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  if (delta) sph_sim_add_term(sim, sph_term_delta(delta, 0.1));
  return sim;
}

/* A column of water in a tank: walls, the default terms. */
static sph_sim *column(void)
{
  const double H = 1, dx = H / 12, g = 9.81, corner[3] = {0};
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 3, .dx = dx});
  sph_group *water = sph_group_box(sim, "water", corner, (double[]){H, H, H}, 1000);
  sph_group *tank = sph_group_walls(sim, "tank", corner, (double[]){1.5 * H, H, 1.5 * H}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 20 * sqrt(g * H), 7));
  sph_group_set_boundary(tank, sph_boundary_adami());
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("antuono", 0.1));
  sph_sim_add_term(sim, sph_term_gravity((double[3]){0, 0, -g}));
  return sim;
}

static void settle(sph_sim *sim)
{
  if (sph_sim_status(sim)) {
    fprintf(stderr, "instructions: %s\n", sph_sim_error(sim));
    failed = 1;
  }
  sph_sim_free(sim);
}

/* Every fused loop once, with its kernel and dimension in its name. */
static void loops(void)
{
  const sph_kernel *kernel;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
      sph_sim *sim = flow(dim, sph_kernel_name(kernel), "molteni");
      sph_sim_evaluate(sim);
      settle(sim);
    }
}

static void any(void)
{
  sph_sim *sim = flow(3, "wendland-c2", NULL);
  sph_sim_evaluate(sim);
  settle(sim);
}

#define STEP __attribute__((noinline)) void

static void take_steps(sph_sim *sim)
{
  for (int k = 0; k < STEPS; k++) sph_sim_step(sim);
}

STEP steps_bogacki_shampine(sph_sim *sim);
STEP steps_leapfrog(sph_sim *sim);
STEP steps_dam_break(sph_sim *sim);

STEP steps_bogacki_shampine(sph_sim *sim) { take_steps(sim); }
STEP steps_leapfrog(sph_sim *sim) { take_steps(sim); }
STEP steps_dam_break(sph_sim *sim) { take_steps(sim); }

static void steps(sph_sim *sim, const char *method, void (*take)(sph_sim *sim))
{
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = method});
  sph_sim_step(sim); /* the first takes the memory */
  take(sim);
  settle(sim);
}

int main(void)
{
  const char *usual = "erk:bogacki-shampine-4-2-3";
  loops();
  any();
  steps(flow(3, "wendland-c2", "molteni"), usual, steps_bogacki_shampine);
  steps(flow(3, "wendland-c2", "molteni"), "leapfrog", steps_leapfrog);
  steps(column(), usual, steps_dam_break);
  return failed;
}
