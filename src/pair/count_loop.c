#include "count_pair.h"

#define DECLARE(isa, loops) extern const sph_count_table sph_count_loops_##loops;
SPH_ISA_BUILT_LISTS(DECLARE)

static const sph_count_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_count_loops_##loops,
    SPH_ISA_BUILT_LISTS(ROW)
#undef ROW
};

sph_pair_function *sph_count_loop(int isa, int dim) { return tables[isa]->loop[dim - 1]; }
