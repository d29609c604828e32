#include "gradient_loops.h"

#define DECLARE(isa, loops) extern const sph_gradient_table sph_gradient_loops_##loops;
SPH_ISA_BUILT_FUSED(DECLARE)

static const sph_gradient_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_gradient_loops_##loops,
    SPH_ISA_BUILT_FUSED(ROW)
#undef ROW
};

sph_pair_function *sph_gradient_loop(int isa, int kernel, int dim)
{
  return tables[isa]->loop[kernel][dim - 1];
}
