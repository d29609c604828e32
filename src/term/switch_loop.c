#include "switch_loops.h"

#define DECLARE(isa, loops) extern const sph_switch_table sph_switch_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_switch_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_switch_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_pair_function *sph_switch_loop(int isa, int kernel, int dim, int pass)
{
  return tables[isa]->loop[pass][kernel][dim - 1];
}
