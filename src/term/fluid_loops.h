/* fluid_loops.h -- the fused loops over fluid <- fluid and fluid <- wall pairs, by instruction
 * set. */
#ifndef SPH_FLUID_LOOPS_H
#define SPH_FLUID_LOOPS_H
#include "cpu.h"
#include "fluid_pair.h"

#define SPH_WATER (SPH_CONTINUITY | SPH_PRESSURE_FORCE | SPH_FORM_C2)

/* Constant sets of terms with a loop of their own, looked up by exact mask; "any" and "all" read it
 * at run time, "any" all but the rare terms, which would cost the others a sixth of their rate.
 * X(kernel, dim, name, mask, slots, sums) */
#define SPH_FLUID_SETS(X, kernel, dim)                                                    \
  X(kernel, dim, molteni_thermal, SPH_WATER | SPH_ARTIFICIAL | SPH_MOLTENI | SPH_THERMAL, \
    3 * dim + 6, SPH_FLUID_SUMS)                                                          \
  SPH_FLUID_SETS_COMMON(X, kernel, dim)                                                   \
  X(kernel, dim, all, k->terms, 3 * dim + 9 + dim * (dim + 1) / 2, SPH_FLUID_SUMS_ALL)
#define SPH_FLUID_SETS_COMMON(X, kernel, dim)                                                    \
  X(kernel, dim, molteni, SPH_WATER | SPH_ARTIFICIAL | SPH_MOLTENI, 2 * dim + 4, SPH_FLUID_SUMS) \
  X(kernel, dim, antuono, SPH_WATER | SPH_ARTIFICIAL | SPH_ANTUONO, 3 * dim + 4, SPH_FLUID_SUMS) \
  X(kernel, dim, antuono_wall, SPH_WATER | SPH_ANTUONO | SPH_WALL, 3 * dim + 4, SPH_FLUID_SUMS)  \
  X(kernel, dim, any, k->terms & ~(unsigned)SPH_RARE, 3 * dim + 5, SPH_FLUID_SUMS)

enum {
#define SPH_FLUID_SET_ENUM(kernel, dim, name, mask, slots, sums) SPH_FLUID_SET_##name,
  SPH_FLUID_SETS(SPH_FLUID_SET_ENUM, , )
#undef SPH_FLUID_SET_ENUM
      SPH_FLUID_SET_COUNT
};

typedef struct sph_fluid_table {
  sph_pair_function *loop[SPH_KERNELS][3][SPH_FLUID_SET_COUNT]; /* [kernel][dim - 1][set] */
} sph_fluid_table;

/* The fastest loop for that set of terms (constants->terms must be the same). */
sph_pair_function *sph_fluid_loop(int isa, int kernel, int dim, unsigned terms);

#endif
