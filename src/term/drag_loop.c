#include "drag_loops.h"

#define DECLARE(isa, loops) extern const sph_drag_table sph_drag_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_drag_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_drag_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_pair_function *sph_drag_loop(int isa, int kernel, int dim)
{
  return tables[isa]->loop[kernel][dim - 1];
}
