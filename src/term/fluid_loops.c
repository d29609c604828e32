/* Instances of the fused loop, once per instruction set: the bodies of the active terms one after
 * another on the same pair, closed by one fluid_pair_forces. */
#include "fluid_loops.h"
#include "fluid_terms.h"
#include "single_loop.h"

#define FLUID(name, kernel, dim, terms, slots, sums)                                        \
  BODY void name##_body(int d, const void *constants, const vec *i, const vec *j, vec *sum) \
  {                                                                                         \
    const fluid_constants *k = constants;                                                   \
    fluid_pair(d, kernel, terms, k, i, j, sum);                                             \
  }                                                                                         \
  static void name(const sph_pair_task *t, long b, long e)                                  \
  {                                                                                         \
    fluid_task_single own;                                                                  \
    sph_pair_loop(name##_body, fluid_task(t, &own), b, e, dim, slots, sums);                \
  }

#if SPH_LANES == 1 /* the reference reads the kernel at run time: an eighth of the code */
#define NAMED(none, dim, set, mask, slots, sums) \
  FLUID(fluid_##dim##_##set, k->kernel, dim, mask, slots, sums)
SPH_FLUID_SETS(NAMED, , 1)
SPH_FLUID_SETS(NAMED, , 2)
SPH_FLUID_SETS(NAMED, , 3)
#define NAME(kernel, dim, set, mask, slots, sums) fluid_##dim##_##set,
#else
#define NAMED(kernel, dim, set, mask, slots, sums) \
  FLUID(fluid_##kernel##_##dim##_##set, kernel, dim, mask, slots, sums)
#ifdef SPH_VEC_FLOAT /* gases take "any", rare terms are refused (sim_single.c) */
#undef SPH_FLUID_SETS
#define SPH_FLUID_SETS SPH_FLUID_SETS_COMMON
#endif
#define KERNEL(kernel)             \
  SPH_FLUID_SETS(NAMED, kernel, 1) \
  SPH_FLUID_SETS(NAMED, kernel, 2) \
  SPH_FLUID_SETS(NAMED, kernel, 3)
SPH_KERNEL_LIST(KERNEL)
#define NAME(kernel, dim, set, mask, slots, sums) fluid_##kernel##_##dim##_##set,
#endif

#ifdef SPH_VEC_FLOAT
#define NAMES(kernel, dim)                                               \
  {                                                                      \
    fluid_##kernel##_##dim##_any, SPH_FLUID_SETS(NAME, kernel, dim) NULL \
  }
#else
#define NAMES(kernel, dim)            \
  {                                   \
    SPH_FLUID_SETS(NAME, kernel, dim) \
  }
#endif
#define ROW(kernel) [kernel] = {NAMES(kernel, 1), NAMES(kernel, 2), NAMES(kernel, 3)},
const sph_fluid_table SPH_ISA_NAME(sph_fluid_loops) = {{SPH_KERNEL_LIST(ROW)}};
