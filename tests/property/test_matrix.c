/* Matrices of implicit stages: symmetric, and M - gamma M df/dx of the f that explicit schemes
 * evaluate, by central differences.  Stages alone would not tell: what is iterated finds its way
 * with a wrong matrix, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "sim_data.h"
#include "sim_matrix.h"
#include "sim_parts.h"
#include "sphode/sundials.h"

static const double pi = 3.14159265358979323846;

typedef struct variant {
  const char *name;
  unsigned bits;
  int coupling, vector;
  const char *kernel;
  int walls; /* no-slip, isothermal: then all particles change alike, which leaves walls alone, and
                what these see of the fluid is what matrices take it for */
} variant;

static const variant variants[] = {
    {"morris", SPH_MORRIS, SPH_COUPLING_VISCOSITY, 0, NULL, 0},
    {"mcg", SPH_MCG, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"artificial", SPH_ARTIFICIAL, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"morris and artificial", SPH_MORRIS | SPH_ARTIFICIAL, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"mcg and artificial", SPH_MCG | SPH_ARTIFICIAL, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"drag", SPH_DRAG, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"drag and mcg", SPH_DRAG | SPH_MCG, SPH_COUPLING_VISCOSITY, 1, NULL, 0},
    {"conduction", SPH_CONDUCTION, SPH_COUPLING_CONDUCTION, 0, NULL, 0},
    {"diffusion", SPH_MOLTENI, SPH_COUPLING_DIFFUSION, 0, NULL, 0},
    {"morris at walls", SPH_MORRIS, SPH_COUPLING_VISCOSITY, 0, NULL, 1},
    {"mcg at walls", SPH_MCG, SPH_COUPLING_VISCOSITY, 1, NULL, 1},
    {"conduction at walls", SPH_CONDUCTION, SPH_COUPLING_CONDUCTION, 0, NULL, 1},
    {"singular morris", SPH_MORRIS, SPH_COUPLING_VISCOSITY, 0, "spiky", 0},
    {"singular mcg", SPH_MCG, SPH_COUPLING_VISCOSITY, 1, "spiky", 0},
    {"singular conduction", SPH_CONDUCTION, SPH_COUPLING_CONDUCTION, 0, "spiky", 0},
    {"singular diffusion", SPH_MOLTENI, SPH_COUPLING_DIFFUSION, 0, "spiky", 0},
};
enum { VARIANTS = sizeof variants / sizeof *variants };

/* Between the particles of both fluids. */
static void add_dust(sph_sim *sim, int dim)
{
  sph_group *dust = sph_group_box(sim, "dust", (double[]){0, 0, 0}, (double[]){1, 1, 1}, 300);
  sph_group_jitter(dust, 0.4, 5);
  sph_group_set_eos(dust, sph_eos_dust());
  for (long i = 0; i < sph_group_count(dust); i++)
    for (int d = 0; d < dim; d++)
      sph_group_write(dust, "velocity", d)[i] = cos(2.0 + (double)(i * (d + 3)));
  sph_sim_add_term(sim, sph_term_drag_time(0.1));
}

/* Behind the ends of the last direction. */
static void add_walls(sph_sim *sim, int dim)
{
  static const char *const open[] = {"", "x- x+", "x- x+ y- y+"};
  sph_group *wall = sph_group_create(sim, "wall", "wall");
  sph_group_add_layers(wall, (double[]){0, 0, 0}, (double[]){1, 1, 1}, open[dim - 1], 1000);
  sph_boundary boundary = sph_boundary_adami_no_slip();
  boundary.temperature = 650;
  sph_group_set_boundary(wall, boundary);
}

/* Two fluids of other density and viscosity side by side, periodic. */
static sph_sim *make(int dim, const variant *v)
{
  sph_sim_def def = {.dim = dim, .dx = 0.1, .kernel = v->kernel};
  for (int d = 0; d < dim; d++) def.periodic[d] = !v->walls || d < dim - 1, def.length[d] = 1;
  sph_sim *sim = sph_sim_create(&def);
  for (int g = 0; g < 2; g++) {
    const double low[] = {0.5 * g, 0, 0}, high[] = {0.5 + 0.5 * g, 1, 1};
    sph_group *group = sph_group_box(sim, g ? "oil" : "water", low, high, g ? 700 : 1000);
    sph_group_jitter(group, 0.2, 1 + (unsigned long)g);
    sph_eos eos = sph_eos_tait(g ? 700 : 1000, 10, 7);
    eos.c_v = 2 + g;
    sph_group_set_eos(group, eos);
    sph_group_set_viscosity(group, 1 + 2 * g);
    sph_group_set_conductivity(group, 3 - g);
    if (v->bits & SPH_CONDUCTION) sph_group_set_energy(group, "temperature");
    for (long i = 0; i < sph_group_count(group); i++) {
      if (v->bits & SPH_CONDUCTION) sph_group_write(group, "energy", 0)[i] = 600 + (double)(i % 5);
      for (int d = 0; d < dim; d++)
        sph_group_write(group, "velocity", d)[i] = sin(1.0 + (double)(i * (d + 2) + g));
    }
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  if (v->bits & (SPH_MORRIS | SPH_MCG))
    sph_sim_add_term(sim, sph_term_viscosity_laminar(v->bits & SPH_MCG ? "mcg" : "morris"));
  if (v->bits & SPH_ARTIFICIAL) sph_sim_add_term(sim, sph_term_viscosity_artificial(0.5, 2));
  if (v->bits & SPH_CONDUCTION) sph_sim_add_term(sim, sph_term_conduction());
  if (v->bits & SPH_MOLTENI) sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  if (v->bits & SPH_DRAG) add_dust(sim, dim);
  if (v->walls) add_walls(sim, dim);
  return sim;
}

static sph_evaluation evaluation_of(sph_sim *sim, const sph_part *part, N_Vector y)
{
  sph_evaluation e = {.sim = sim, .part = part};
  for (int g = 0; g < sim->groups; g++)
    e.view[g] = sph_group_data_view(sim->group[g], sph_nvector_data(y), NULL);
  return e;
}

static double mass_of(const sph_sim *sim, const variant *v, const sph_view *view, int g, long i)
{
  if (v->coupling == SPH_COUPLING_DIFFUSION) return view->m[i] / view->rho[i];
  return view->m[i] * (v->coupling == SPH_COUPLING_CONDUCTION ? sim->group[g]->eos.c_v : 1);
}

/* The matrix at the state y, as stages make it. */
static void fill(sph_sim *sim, const variant *v, const sph_part *part, sph_pattern *pattern,
                 sph_matrix *matrix, double gamma)
{
  sph_evaluation e = evaluation_of(sim, part, sim->y);
  assert_int_equal(sph_sim_lists_update(&e), 0);
  for (int g = 0; g < sim->groups; g++) sph_sim_pairs_pack_positions(&e, g);
  assert_int_equal(sph_sim_matrix_pattern(&e, pattern), 0);
  assert_int_equal(sph_sim_material_eos(&e) || sph_sim_walls_fill(&e), 0);
  assert_int_equal(sph_sim_matrix_shape(sim, pattern, matrix), 0);
  for (int g = 0; g < sim->groups; g++)
    for (long k = 0; k < e.view[g].n && !sim->group[g]->wall; k++)
      for (int c = 0; c < matrix->components; c++)
        matrix->A.floor[(pattern->base[g] + k) * matrix->components + c] =
            mass_of(sim, v, &e.view[g], g, sph_neighbors_order(sim->neighbors, g)[k]);
  sph_sim_matrix_fill(&e, pattern, matrix, gamma, v->coupling);
}

/* Component c of what is solved for, from a state or its rates, into the order of the rows. */
static void take(const sph_sim *sim, const variant *v, const sph_pattern *pattern,
                 const sph_matrix *matrix, N_Vector from, int c, double *to)
{
  for (int g = 0; g < sim->groups; g++) {
    const sph_view view = sph_group_data_view(sim->group[g], sph_nvector_data(from), NULL);
    const double *field = v->coupling == SPH_COUPLING_CONDUCTION  ? view.energy
                          : v->coupling == SPH_COUPLING_DIFFUSION ? view.rho
                                                                  : view.v[c];
    const int *order = sph_neighbors_order(sim->neighbors, g);
    for (long k = 0; k < view.n && !sim->group[g]->wall; k++)
      to[(pattern->base[g] + k) * matrix->components + (matrix->vector ? c : 0)] = field[order[k]];
  }
}

static void check(sph_sim *sim, const variant *v, int dim)
{
  static const int role_of[] = {[SPH_COUPLING_VISCOSITY] = SPH_ROLE_VELOCITY,
                                [SPH_COUPLING_CONDUCTION] = SPH_ROLE_OTHER,
                                [SPH_COUPLING_DIFFUSION] = SPH_ROLE_DENSITY};
  const int role = role_of[v->coupling];
  const double gamma = 0.3, step = role == SPH_ROLE_VELOCITY ? 1e-7 : 1e-3;
  sph_part part;
  sph_pattern pattern = {0};
  sph_matrix matrix = {.vector = v->vector, .components = v->vector ? dim : 1};
  N_Vector y = sph_sim_vector(sim);
  if (!y) fail_msg("%s: %s", v->name, sph_sim_error(sim));
  N_Vector way = N_VClone(y), at = N_VClone(y), f[] = {N_VClone(y), N_VClone(y)};
  assert_int_equal(sph_sim_parts_of(sim, &part, v->bits, 0), 0);
  fill(sim, v, &part, &pattern, &matrix, gamma);
  /* Of the velocities, the temperatures or the densities, another way for each. */
  N_VConst(0, way);
  for (int q = 0; q < sim->layout.segments; q++) {
    const sph_segment *s = &sim->layout.segment[q];
    for (long i = s->offset; s->role == role && i < s->offset + s->n; i++)
      sph_nvector_data(way)[i] = v->walls ? 1 : cos(2 * pi * 0.618 * (double)i);
  }
  for (int k = 0; k < 2; k++) {
    N_VLinearSum(1, y, k ? -step : step, way, at);
    assert_int_equal(sph_sim_rhs_part(sim, &part, 0, at, f[k]), 0);
  }
  N_VLinearSum(0.5 / step, f[0], -0.5 / step, f[1], at); /* df/dx along the way */
  const long n = matrix.A.n;
  double *x = calloc((size_t)n, sizeof *x), *rate = calloc((size_t)n, sizeof *rate);
  double *b = calloc((size_t)n, sizeof *b), *z = calloc((size_t)n, sizeof *z);
  double error = 0, size = 0;
  const int turns = v->vector || role != SPH_ROLE_VELOCITY ? 1 : dim;
  for (int turn = 0; turn < turns; turn++) {
    for (int c = v->vector ? 0 : turn; c < (v->vector ? dim : turn + 1); c++) {
      take(sim, v, &pattern, &matrix, way, c, x);
      take(sim, v, &pattern, &matrix, at, c, rate);
    }
    sph_csr_multiply(&matrix.A, 1, (const double *const[]){x}, (double *const[]){b});
    for (long i = 0; i < n; i++) {
      double right = matrix.A.floor[i] * (x[i] - gamma * rate[i]);
      error = fmax(error, fabs(b[i] - right));
      size = fmax(size, fabs(gamma * matrix.A.floor[i] * rate[i]));
    }
  }
  if (!(error <= 1e-6 * size)) fail_msg("%s, dim %d: %g of %g", v->name, dim, error, size);
  /* x.Az = z.Ax */
  double left = 0, right = 0, most = 0;
  for (long i = 0; i < n; i++) z[i] = sin(0.7 * (double)i);
  for (long i = 0; i < n; i++) left += z[i] * b[i];
  sph_csr_multiply(&matrix.A, 1, (const double *const[]){z}, (double *const[]){b});
  for (long i = 0; i < n; i++) right += x[i] * b[i], most += fabs(x[i] * b[i]);
  if (!(fabs(left - right) <= 1e-13 * most)) fail_msg("%s: %g of %g", v->name, left - right, most);
  free(x), free(rate), free(b), free(z);
  N_VDestroy(way), N_VDestroy(at), N_VDestroy(f[0]), N_VDestroy(f[1]);
  sph_sim_matrix_pattern_free(&pattern);
  sph_sim_matrix_free(&matrix);
}

static void matrices_are_derivatives(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; k < VARIANTS; k++) {
      sph_sim *sim = make(dim, &variants[k]);
      check(sim, &variants[k], dim);
      sph_sim_free(sim);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(matrices_are_derivatives)};
  return cmocka_run_group_tests_name("matrix", tests, NULL, NULL);
}
