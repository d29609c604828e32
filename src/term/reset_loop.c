#include "reset_loops.h"

#define DECLARE(isa, loops) extern const sph_reset_table sph_reset_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_reset_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_reset_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_pair_function *sph_reset_loop(int isa, int kernel, int dim)
{
  return tables[isa]->loop[kernel][dim - 1];
}
