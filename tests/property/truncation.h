/* truncation.h -- how far operators are off for a smooth field on a periodic lattice, shaken or
 * not: what tests of orders and the table of docs/theory.md are made of. */
#ifndef TRUNCATION_H
#define TRUNCATION_H

enum { TRUNCATIONS = 24 };

/* Operator k = 0, 1, ..., "gradient corrected"; NULL behind the last. */
const char *truncation_name(int k);

/* error[k]: root mean square error of operator k over the root mean square of the exact result;
 * NaN where there is none in one dimension. */
void truncation_measure(int dim, int across, double h_over_dx, const char *kernel, double jitter,
                        double error[TRUNCATIONS]);

#endif
