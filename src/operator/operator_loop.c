#include "operator_loops.h"

#define DECLARE(isa, loops) extern const sph_operator_table sph_operator_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_operator_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_operator_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

const sph_operator_table *sph_operator_loop(int isa) { return tables[isa]; }
