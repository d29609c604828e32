#include "fluid_loops.h"

#define DECLARE(isa, loops) extern const sph_fluid_table sph_fluid_loops_##loops;
SPH_ISA_BUILT_FUSED(DECLARE)

static const sph_fluid_table *const tables[SPH_ISA_COUNT] = {
#define ROW(isa, loops) [SPH_ISA_##isa] = &sph_fluid_loops_##loops,
    SPH_ISA_BUILT_FUSED(ROW)
#undef ROW
};

static int set_of(unsigned terms)
{
  const fluid_constants constants = {.terms = terms},
                        *k = &constants; /* "all" matches itself, last */
#define MATCH(kernel, dim, name, mask, slots, sums) \
  if (terms == (mask)) return SPH_FLUID_SET_##name;
  SPH_FLUID_SETS(MATCH, , )
#undef MATCH
  return SPH_FLUID_SET_all;
}

sph_pair_function *sph_fluid_loop(int isa, int kernel, int dim, unsigned terms)
{
  return tables[isa]->loop[kernel][dim - 1][set_of(terms)];
}
