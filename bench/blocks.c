/* A block of targets and the runs of its sources, as data for docs/performance/blocks.png
 * (bench/blocks.sh): a jittered 2D lattice, reach 3 dx, eight lanes.
 *
 * Index 0: all particles, x y in sorted order; index 1: the block's; then one index a run. */
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

enum { ACROSS = 26, N = ACROSS * ACROSS, LANES = 8 };

static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 24) - 0.5;
}

static void points(const double *const x[], const int *order, long begin, long count)
{
  for (long s = begin; s < begin + count && s < N; s++)
    printf("%.6f %.6f\n", x[0][order[s]], x[1][order[s]]);
  printf("\n\n");
}

/* The block whose first target is nearest to the middle. */
static long middle(const double *const x[], const int *order)
{
  long best = 0;
  double least = INFINITY;
  for (long b = 0; b < N / LANES; b++) {
    double dx = x[0][order[b * LANES]] - ACROSS / 2, dy = x[1][order[b * LANES]] - ACROSS / 2;
    double far = dx * dx + dy * dy;
    if (far < least) least = far, best = b;
  }
  return best;
}

int main(void)
{
  static double coordinate[2][N];
  const double *const x[] = {coordinate[0], coordinate[1]};
  unsigned state = 1;
  for (long i = 0; i < N; i++) {
    coordinate[0][i] = (double)(i % ACROSS) + 0.4 * noise(&state);
    coordinate[1][i] = (double)(i / ACROSS) + 0.4 * noise(&state);
  }
  sph_error error = {0};
  sph_neighbors *nb =
      sph_neighbors_create(&(sph_neighbors_def){.dim = 2, .reach = 3, .dx = 1, .lanes = LANES},
                           &error);
  sph_neighbors_sort(nb, 0, N, x, &error);
  sph_neighbors_build(nb, 0, 0, &error);
  if (error.status) {
    fprintf(stderr, "blocks: %s\n", error.text);
    sph_neighbors_free(nb);
    return 1;
  }
  const int *order = sph_neighbors_order(nb, 0);
  const sph_list list = sph_neighbors_list(nb, 0, 0);
  const long block = middle(x, order);
  points(x, order, 0, N);
  points(x, order, block * LANES, LANES);
  for (long r = list.first[block]; r < list.first[block + 1]; r++)
    points(x, order, sph_run_start(list.runs[r]), sph_run_count(list.runs[r]));
  sph_neighbors_free(nb);
  return 0;
}
