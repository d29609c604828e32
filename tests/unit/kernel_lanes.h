/* kernel_lanes.h -- the shapes of the kernels, evaluated by one instruction set. */
#ifndef KERNEL_LANES_H
#define KERNEL_LANES_H
#include "cpu.h"

enum { KERNEL_LANES = 8 }; /* a multiple of the lanes of each */

/* w, f, l at q[KERNEL_LANES], for each the instances of an instruction set: kernel_lanes_<isa>. */
typedef void kernel_lanes(int kernel, int dim, const double *q, double *w, double *f, double *l);
#define KERNEL_LANES_DECLARE(isa) kernel_lanes kernel_lanes_##isa;
SPH_ISA_BUILT(KERNEL_LANES_DECLARE)

#endif
