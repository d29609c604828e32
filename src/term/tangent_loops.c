/* Instances of the loops with derivatives: compiled once, for complex numbers. */
#define SPH_VEC_TANGENT
#include "tangent_loops.h"

#include "density_pair.h"
#include "drag_pair.h"
#include "fluid_terms.h"
#include "gradient_pair.h"
#include "wall_pair.h"

typedef struct constants {
  fluid_constants fluid;
  int kernel;
} constants;

BODY constants constants_of(const sph_tangent_task *t)
{
  constants k = {.fluid.terms = t->terms, .kernel = t->kernel};
  void *numbers = (char *)&k.fluid + offsetof(fluid_constants, inverse_h);
  vec_scalar *number = numbers;
  for (int n = 0; n < SPH_FLUID_NUMBERS; n++)
    number[n] = tangent_number(t->numbers[n], t->numbers_d[n]);
  return k;
}

BODY void body_fluid(int dim, const void *c, const vec *i, const vec *j, vec *sum)
{
  const constants *k = c;
  fluid_pair(dim, k->kernel, k->fluid.terms, &k->fluid, i, j, sum);
}

BODY void body_wall(int dim, const void *c, const vec *i, const vec *j, vec *sum)
{
  const constants *k = c;
  wall_pair(dim, k->kernel, (k->fluid.terms & SPH_THERMAL) != 0, &k->fluid, i, j, sum);
}

BODY void body_gradient(int dim, const void *c, const vec *i, const vec *j, vec *sum)
{
  const constants *k = c;
  gradient_pair(dim, k->kernel, &k->fluid, i, j, sum);
}

BODY void body_density(int dim, const void *c, const vec *i, const vec *j, vec *sum)
{
  const constants *k = c;
  density_pair(dim, k->kernel, &k->fluid, i, j, sum);
}

BODY void body_drag(int dim, const void *c, const vec *i, const vec *j, vec *sum)
{
  const constants *k = c;
  drag_pair(dim, k->kernel, &k->fluid, i, j, sum);
}

BODY int slots_of(int pass, int dim)
{
  return pass == SPH_TANGENT_fluid || pass == SPH_TANGENT_wall ? slot_scalar(dim) : slot_extra(dim);
}

BODY int sums_of(int pass, int dim)
{
  const int sums[] = {[SPH_TANGENT_fluid] = SPH_FLUID_SUMS_ALL,
                      [SPH_TANGENT_wall] = SPH_WALL_SUMS,
                      [SPH_TANGENT_gradient] = gradient_sums(dim),
                      [SPH_TANGENT_density] = SPH_DENSITY_SUMS,
                      [SPH_TANGENT_drag] = SPH_DRAG_SUMS};
  return sums[pass];
}

#define LOOP(pass, dim)                                                                  \
  static void pass##_##dim(const sph_tangent_task *t, long begin, long end)              \
  {                                                                                      \
    const constants k = constants_of(t);                                                 \
    tangent_loop(body_##pass, t, &k, begin, end, dim, slots_of(SPH_TANGENT_##pass, dim), \
                 sums_of(SPH_TANGENT_##pass, dim));                                      \
  }
#define LOOPS(pass) LOOP(pass, 1) LOOP(pass, 2) LOOP(pass, 3)
SPH_TANGENT_PASSES(LOOPS)

#define ROW(pass) [SPH_TANGENT_##pass] = {pass##_1, pass##_2, pass##_3},
sph_tangent_function *const sph_tangent_loops[SPH_TANGENT_PASS_COUNT][3] = {
    SPH_TANGENT_PASSES(ROW)};
