/* Instances of the loops with derivatives: compiled once, for complex numbers. */
#define SPH_VEC_TANGENT
#include <stddef.h>

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

/* derivative NULL: zeros. */
BODY constants constants_of(const sph_tangent_task *t, unsigned terms, const double *number,
                            const double *derivative)
{
  constants k = {.fluid.terms = terms | SPH_QUADRATIC, .kernel = t->kernel}; /* beta may vary */
  void *numbers = (char *)&k.fluid + offsetof(fluid_constants, inverse_h);
  vec_scalar *to = numbers;
  for (int n = 0; number && n < SPH_FLUID_NUMBERS; n++)
    to[n] = tangent_number(number[n], derivative ? derivative[n] : 0);
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
  wall_pair(dim, k->kernel, (k->fluid.terms & SPH_THERMAL) != 0, 1, &k->fluid, i, j, sum);
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

#define LOOP(pass, dim)                                                                   \
  static void pass##_##dim(const sph_tangent_task *t, long begin, long end)               \
  {                                                                                       \
    const constants k = constants_of(t, t->terms, t->numbers, t->numbers_d);              \
    tangent_loop(body_##pass, t, &k, begin, end, dim, slots_of(SPH_TANGENT_##pass, dim),  \
                 sums_of(SPH_TANGENT_##pass, dim));                                       \
  }                                                                                       \
  static void transposed_##pass##_##dim(const sph_tangent_task *t, long begin, long end)  \
  {                                                                                       \
    const constants k = constants_of(t, t->terms, t->numbers, NULL);                      \
    const constants k_source = constants_of(t, t->terms_source, t->numbers_source, NULL); \
    transposed_loop(body_##pass, t, &k, &k_source, begin, end, dim,                       \
                    slots_of(SPH_TANGENT_##pass, dim), sums_of(SPH_TANGENT_##pass, dim)); \
  }
#define LOOPS(pass) LOOP(pass, 1) LOOP(pass, 2) LOOP(pass, 3)
SPH_TANGENT_PASSES(LOOPS)

#define ROW(pass) [SPH_TANGENT_##pass] = {pass##_1, pass##_2, pass##_3},
sph_tangent_function *const sph_tangent_loops[SPH_TANGENT_PASS_COUNT][3] = {
    SPH_TANGENT_PASSES(ROW)};
#undef ROW
#define ROW(pass) \
  [SPH_TANGENT_##pass] = {transposed_##pass##_1, transposed_##pass##_2, transposed_##pass##_3},
sph_tangent_function *const sph_tangent_loops_transposed[SPH_TANGENT_PASS_COUNT][3] = {
    SPH_TANGENT_PASSES(ROW)};
