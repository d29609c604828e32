/* Instances of the loops of the switches, once per instruction set. */
#include "switch_loops.h"

/* The reference reads the kernel at run time: its instances are one to a compiler. */
#if SPH_LANES == 1
#define KERNEL_OF(unused, k) ((const fluid_constants *)k)->kernel
#else
#define KERNEL_OF(kernel, k) kernel
#endif

#define PASS(pass, slots, sums, kernel, dim)                                                 \
  BODY void body_##pass##_##kernel##_##dim(int d, const void *k, const vec *i, const vec *j, \
                                           vec *sum)                                         \
  {                                                                                          \
    switch_##pass(d, KERNEL_OF(kernel, k), k, i, j, sum);                                    \
  }                                                                                          \
  static void pass##_##kernel##_##dim(const sph_pair_task *t, long b, long e)                \
  {                                                                                          \
    sph_pair_loop(body_##pass##_##kernel##_##dim, t, b, e, dim, slots, sums);                \
  }
#define SUMS(dim) (dim * (dim + 1) / 2 + dim * dim)
#define DIM(kernel, dim)                                  \
  PASS(velocity, 2 * dim + 4, SUMS(dim) + 1, kernel, dim) \
  PASS(acceleration, 2 * dim + 3, SUMS(dim) + 2, kernel, dim)
#define KERNEL(kernel) DIM(kernel, 1) DIM(kernel, 2) DIM(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define VELOCITY(kernel) \
  [kernel] = {velocity_##kernel##_1, velocity_##kernel##_2, velocity_##kernel##_3},
#define ACCELERATION(kernel) \
  [kernel] = {acceleration_##kernel##_1, acceleration_##kernel##_2, acceleration_##kernel##_3},
const sph_switch_table SPH_ISA_NAME(sph_switch_loops) = {
    {[SPH_SWITCH_VELOCITY] = {SPH_KERNEL_LIST(VELOCITY)},
     [SPH_SWITCH_ACCELERATION] = {SPH_KERNEL_LIST(ACCELERATION)}}};
