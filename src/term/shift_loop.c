#include "shift_loops.h"

#define DECLARE(isa, loops) extern const sph_shift_table sph_shift_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_shift_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_shift_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_pair_function *sph_shift_loop(int isa, int kernel, int dim, int pass)
{
  return tables[isa]->loop[kernel][dim - 1][pass];
}
