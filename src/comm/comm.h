/* comm.h -- exchange points between ranks.  One process: nothing to do.  Several: halo updates of
 * these fields. */
#ifndef SPH_COMM_H
#define SPH_COMM_H

enum { SPH_COMM_STATE = 1, SPH_COMM_WALLS = 2, SPH_COMM_GRADIENTS = 4, SPH_COMM_DENSITY = 8 };

int sph_comm_exchange(unsigned fields);

#endif
