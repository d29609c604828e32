/* kernel_lanes.h -- the shapes of the kernels, evaluated by one instruction set. */
#ifndef KERNEL_LANES_H
#define KERNEL_LANES_H
#include "cpu.h"

enum { KERNEL_LANES = 8 }; /* a multiple of the lanes of each */

/* w, f, l at q[KERNEL_LANES], for each the instances of an instruction set: kernel_lanes_<isa>. */
typedef void kernel_lanes(int kernel, int dim, const double *q, double *w, double *f, double *l);
/* The roots of a[KERNEL_LANES], likewise. */
typedef void kernel_roots(const double *a, double *root);
#define KERNEL_LANES_DECLARE(isa, loops) \
  kernel_lanes kernel_lanes_##loops;     \
  kernel_roots kernel_roots_##loops;
SPH_ISA_BUILT_DOUBLE(KERNEL_LANES_DECLARE, x86_64_v4_newton)

#endif
