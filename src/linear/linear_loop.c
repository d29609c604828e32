#include "linear_loops.h"

#define DECLARE(isa, loops) extern const sph_linear_table sph_linear_loops_##loops;
SPH_ISA_BUILT(DECLARE)

static const sph_linear_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_linear_loops_##loops,
    SPH_ISA_BUILT(ROW)
#undef ROW
};

int sph_linear_loop_width(int d) { return d == 3 ? 4 : d; }

const sph_linear_loops *sph_linear_loop_get(int isa, int width)
{
  return &tables[isa]->width[width];
}

int sph_linear_loop_copy(int isa, const sph_linear_copy *copy, const sph_csr *A, long from, long to)
{
  return tables[isa]->copy(copy, A, from, to);
}
