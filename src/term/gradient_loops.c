/* Instances of the gradient loop, once per instruction set. */
#include "gradient_loops.h"

#include "single_loop.h"

#define GRADIENT(kernel, dim)                                                                 \
  BODY void body_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, vec *sum) \
  {                                                                                           \
    gradient_pair(d, kernel, k, i, j, sum);                                                   \
  }                                                                                           \
  static void gradient_##kernel##_##dim(const sph_pair_task *t, long b, long e)               \
  {                                                                                           \
    fluid_task_single own;                                                                    \
    sph_pair_loop(body_##kernel##_##dim, fluid_task(t, &own), b, e, dim, 2 * dim + 4,         \
                  dim * (dim + 1) / 2 + dim);                                                 \
  }
#define KERNEL(kernel) GRADIENT(kernel, 1) GRADIENT(kernel, 2) GRADIENT(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) \
  [kernel] = {gradient_##kernel##_1, gradient_##kernel##_2, gradient_##kernel##_3},
const sph_gradient_table SPH_ISA_NAME(sph_gradient_loops) = {{SPH_KERNEL_LIST(ROW)}};
