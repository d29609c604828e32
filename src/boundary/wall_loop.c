#include "wall_loops.h"

#define DECLARE(isa, loops) extern const sph_wall_table sph_wall_loops_##loops;
SPH_ISA_BUILT_WALLS(DECLARE)

static const sph_wall_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_wall_loops_##loops,
    SPH_ISA_BUILT_WALLS(ROW)
#undef ROW
};

sph_pair_function *sph_wall_loop(int isa, int kernel, int dim, int turns, int thermal)
{
  return tables[isa]->loop[kernel][dim - 1][turns][thermal];
}
