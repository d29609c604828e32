#include "tile_loops.h"

#define DECLARE(isa, loops) extern const sph_tile_table sph_tile_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_tile_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_tile_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_pair_function *sph_tile_loop(int isa, int kernel, int dim)
{
  return tables[isa]->loop[kernel][dim - 1];
}

sph_matrix_function *sph_tile_loop_matrix(int isa, int dim) { return tables[isa]->matrix[dim - 1]; }
