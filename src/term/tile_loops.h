/* tile_loops.h -- the loops with tiles for registered pair terms, by instruction set. */
#ifndef SPH_TILE_LOOPS_H
#define SPH_TILE_LOOPS_H
#include "cpu.h"
#include "fluid_loops.h"
#include "matrix_loops.h"
#include "tile_pair.h"

/* Sets of built-in terms that have a loop with tiles of their own for Wendland C2, looked up by
 * exact mask, "any" last; inviscid: with a viscosity of the user's.  X(dim, name, fused) */
#define SPH_TILE_SETS(X, dim)                               \
  X(dim, none, 0)                                           \
  X(dim, inviscid, SPH_WATER | SPH_MOLTENI)                 \
  X(dim, molteni, SPH_WATER | SPH_ARTIFICIAL | SPH_MOLTENI) \
  X(dim, antuono, SPH_WATER | SPH_ARTIFICIAL | SPH_ANTUONO) \
  X(dim, any, k->fused & ~(unsigned)SPH_RARE)

enum {
#define SPH_TILE_SET_ENUM(dim, name, fused) SPH_TILE_SET_##name,
  SPH_TILE_SETS(SPH_TILE_SET_ENUM, )
#undef SPH_TILE_SET_ENUM
      SPH_TILE_SET_COUNT
};

typedef struct sph_tile_table {
  sph_pair_function *constant[3][SPH_TILE_SET_COUNT]; /* [dim - 1][set]; NULL: those below */
  sph_pair_function *none[3], *any[3];                /* of any kernel */
  sph_matrix_function *matrix[3];
} sph_tile_table;

/* The fastest loop for those built-in terms (tile_constants.fused, which must be the same). */
sph_pair_function *sph_tile_loop(int isa, int kernel, int dim, unsigned fused);
/* Adds what they give to a matrix (tile_matrix.h). */
sph_matrix_function *sph_tile_loop_matrix(int isa, int dim);

#endif
