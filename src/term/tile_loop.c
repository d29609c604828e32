#include "tile_loops.h"

#define DECLARE(isa, loops) extern const sph_tile_table sph_tile_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_tile_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_tile_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

static int set_of(unsigned fused)
{
  const tile_constants constants = {.fused = fused}, *k = &constants; /* "any" matches, last */
#define MATCH(dim, name, mask) \
  if (fused == (mask)) return SPH_TILE_SET_##name;
  SPH_TILE_SETS(MATCH, )
#undef MATCH
  return SPH_TILE_SET_any;
}

sph_pair_function *sph_tile_loop(int isa, int kernel, int dim, unsigned fused)
{
  const sph_tile_table *table = tables[isa];
  const int set = set_of(fused);
  if (kernel == SPH_KERNEL_WENDLAND_C2 && table->constant[dim - 1][set])
    return table->constant[dim - 1][set];
  return fused ? table->any[dim - 1] : table->none[dim - 1];
}

sph_matrix_function *sph_tile_loop_matrix(int isa, int dim) { return tables[isa]->matrix[dim - 1]; }
