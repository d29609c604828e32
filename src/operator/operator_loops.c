/* Rows, once per instruction set. */
#include "operator_loops.h"

/* Every source is written down, and kept if it is near: no branch to guess. */
BODY void collect(int dim, const sph_row_task *t, long b, const double x[3], sph_row *row)
{
  long n = 0;
  for (long k = t->first[b]; k < t->first[b + 1]; k++) {
    const sph_run run = t->runs[k];
    const long end = sph_run_start(run) + sph_run_count(run);
    for (long s = sph_run_start(run); s < end; s++) {
      double r2 = 0;
      for (int d = 0; d < dim; d++) {
        double r = x[d] - t->shift[sph_run_image(run)][d] - t->x[d][s];
        row->r[d][n] = r;
        r2 += r * r;
      }
      row->r2[n] = r2;
      row->VW[n] = row->VF[n] = t->V[s];
      row->j[n] = t->number[s];
      n += r2 < t->H2;
    }
  }
  row->n = n;
}

BODY void weigh(int kernel, int dim, const sph_row_task *t, sph_row *row)
{
  for (long k = row->n; k < row->n + SPH_LANES; k++) row->r2[k] = row->VW[k] = row->VF[k] = 0;
  for (long k = 0; k < row->n; k += SPH_LANES) {
    vec q = v_sqrt(v_load(row->r2 + k)) * t->inverse_h;
    vec VW = v_load(row->VW + k) * (t->scale_w * kernel_shape_w(kernel, dim, q));
    vec VF = v_load(row->VF + k) * (t->scale_f * kernel_shape_f(kernel, dim, q));
    v_store(row->VW + k, VW);
    v_store(row->VF + k, VF);
  }
}

#define COLLECT(dim)                                                                        \
  static void collect_##dim(const sph_row_task *t, long b, const double x[3], sph_row *row) \
  {                                                                                         \
    collect(dim, t, b, x, row);                                                             \
  }
COLLECT(1)
COLLECT(2)
COLLECT(3)

#define WEIGH(kernel, dim)                                                \
  static void weigh_##kernel##_##dim(const sph_row_task *t, sph_row *row) \
  {                                                                       \
    weigh(kernel, dim, t, row);                                           \
  }
#define KERNEL(kernel) WEIGH(kernel, 1) WEIGH(kernel, 2) WEIGH(kernel, 3)
SPH_KERNEL_LIST(KERNEL)

#define ROW(kernel) [kernel] = {weigh_##kernel##_1, weigh_##kernel##_2, weigh_##kernel##_3},
const sph_operator_table SPH_ISA_NAME(sph_operator_loops) = {{collect_1, collect_2, collect_3},
                                                             {SPH_KERNEL_LIST(ROW)}};
