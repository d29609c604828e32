/* Instances of the fused loop, once per instruction set: the bodies of the active terms one after
 * another on the same pair, closed by one fluid_pair_forces. */
#include "fluid_loops.h"
#include "fluid_terms.h"

#define FLUID(kernel, dim, set, mask, slots, sums)                                    \
  BODY void body_##kernel##_##dim##_##set(int d, const void *constants, const vec *i, \
                                          const vec *j, vec *sum)                     \
  {                                                                                   \
    const fluid_constants *k = constants;                                             \
    fluid_pair(d, kernel, mask, k, i, j, sum);                                        \
  }                                                                                   \
  static void fluid_##kernel##_##dim##_##set(const sph_pair_task *t, long b, long e)  \
  {                                                                                   \
    sph_pair_loop(body_##kernel##_##dim##_##set, t, b, e, dim, slots, sums);          \
  }
#define KERNEL(kernel)             \
  SPH_FLUID_SETS(FLUID, kernel, 1) \
  SPH_FLUID_SETS(FLUID, kernel, 2) \
  SPH_FLUID_SETS(FLUID, kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define NAME(kernel, dim, set, mask, slots, sums) fluid_##kernel##_##dim##_##set,
#define ROW(kernel)                              \
  [kernel] = {{SPH_FLUID_SETS(NAME, kernel, 1)}, \
              {SPH_FLUID_SETS(NAME, kernel, 2)}, \
              {SPH_FLUID_SETS(NAME, kernel, 3)}},
const sph_fluid_table SPH_ISA_NAME(sph_fluid_loops) = {{SPH_KERNEL_LIST(ROW)}};
