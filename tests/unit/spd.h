/* spd.h -- matrices as smoothed particles give them, for tests. */
#ifndef SPD_H
#define SPD_H
#include <stdint.h>

#include "csr.h"

double spd_chance(uint64_t *state); /* (-1, 1) */

/* M + gamma L: `across` points a side, off their lattice by chance, which exchange with weights
 * that fall from 1 to 0 within three spacings; masses by chance from 1/2 to 3/2; gamma such that
 * the largest eigenvalue is about `condition` times the smallest.  Columns in a random order.
 * Fails the test that has no memory. */
void spd_make(sph_csr *A, int dim, int across, double condition, uint64_t seed);

/* Two of them that do not know of each other. */
void spd_make_two(sph_csr *A, int dim, int across, double condition, uint64_t seed);

#endif
