#include "matrix_loops.h"

#define DECLARE(isa, loops) extern const sph_matrix_table sph_matrix_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_matrix_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_matrix_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

const sph_matrix_loops *sph_matrix_loop(int isa, int dim) { return &tables[isa]->loops[dim - 1]; }
