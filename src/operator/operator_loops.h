/* operator_loops.h -- a row: the neighbours of one place, in the order of the list, and the kernel
 * there.  By instruction set. */
#ifndef SPH_OPERATOR_LOOPS_H
#define SPH_OPERATOR_LOOPS_H
#include "cpu.h"
#include "sphode/kernel_shape.h"
#include "sphode/neighbors.h"

typedef struct sph_row {
  long i;       /* the place: number of a point or of a probe */
  long n;       /* points closer than kappa h, itself (of a point) among them */
  int *j;       /* [n] their numbers */
  double *r[3]; /* [dim][n] r_ij = x_i - x_j [m] */
  double *r2;   /* [n] r^2 [m^2] */
  double *VW;   /* [n] V_j W_ij */
  double *VF;   /* [n] V_j F_ij [1/m^2] */
} sph_row;

/* Where rows come from. */
typedef struct sph_row_task {
  const double *x[3];       /* [n] sources in sorted order [m] */
  const double *V;          /* [n] theirs [m^dim] */
  const int *number;        /* [n] theirs */
  const long *first;        /* [blocks + 1] */
  const sph_run *runs;      /* [first[blocks]] */
  const double (*shift)[3]; /* of the images [m] */
  double H2, inverse_h;     /* (kappa h)^2 [m^2], [1/m] */
  double scale_w, scale_f;  /* sigma/h^d, sigma/h^(d+2) */
} sph_row_task;

/* Neighbours of the place at x in block b: all of the row but the kernel. */
typedef void sph_row_collect(const sph_row_task *task, long b, const double x[3], sph_row *row);
/* The kernel: VW and VF hold V before. */
typedef void sph_row_weigh(const sph_row_task *task, sph_row *row);

typedef struct sph_operator_table {
  sph_row_collect *collect[3]; /* [dim - 1] */
  sph_row_weigh *weigh[SPH_KERNELS][3];
} sph_operator_table;

const sph_operator_table *sph_operator_loop(int isa);

enum { SPH_ROW_PAD = 8 }; /* arrays of a row are longer by this */

#endif
