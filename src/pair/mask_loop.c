#include "mask_loops.h"

#define DECLARE(isa, loops) extern const sph_mask_table sph_mask_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_mask_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_mask_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

sph_mask_function *sph_mask_loop(int isa, int dim) { return tables[isa]->loop[dim - 1]; }
