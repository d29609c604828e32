/* Compiled once per instruction set, like the pair loops. */
#include "kernel_lanes.h"

#include "sphode/kernel_shape.h"

void SPH_ISA_NAME(kernel_lanes)(int kernel, int dim, const double *q, double *w, double *f,
                                double *l)
{
  for (int n = 0; n < KERNEL_LANES; n += SPH_LANES) {
    vec at = v_load(q + n);
    v_store(w + n, kernel_shape_w(kernel, dim, at));
    v_store(f + n, kernel_shape_f(kernel, dim, at));
    v_store(l + n, kernel_shape_laplacian(kernel, dim, at));
  }
}

void SPH_ISA_NAME(kernel_roots)(const double *a, double *root)
{
  for (int n = 0; n < KERNEL_LANES; n += SPH_LANES) v_store(root + n, v_sqrt(v_load(a + n)));
}
