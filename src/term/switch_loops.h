/* switch_loops.h -- the loops of the switches of artificial viscosity, by instruction set. */
#ifndef SPH_SWITCH_LOOPS_H
#define SPH_SWITCH_LOOPS_H
#include "cpu.h"
#include "switch_pair.h"

enum { SPH_SWITCH_VELOCITY, SPH_SWITCH_ACCELERATION, SPH_SWITCH_PASSES };

typedef struct sph_switch_table {
  sph_pair_function *loop[SPH_SWITCH_PASSES][SPH_KERNELS][3]; /* [pass][kernel][dim - 1] */
} sph_switch_table;

sph_pair_function *sph_switch_loop(int isa, int kernel, int dim, int pass);

#endif
