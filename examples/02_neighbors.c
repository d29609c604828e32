/* 02_neighbors -- who is near whom: the neighbours of points that are nearly a square lattice.
 *
 * Equations  j is a neighbour of i if |x_i - x_j| < kappa h, the edge of the kernel's support;
 *            of points of spacing dx, N = pi (kappa h/dx)^2 lie in that circle on average, the
 *            point itself among them: N - 1 neighbours
 * Reference  R. W. Hockney & J. W. Eastwood (1981), Computer Simulation Using Particles, ch. 8
 * Run        ./02_neighbors
 * See        the mean number of neighbours for several h, and how far it is from N - 1; the
 *            neighbours of one point
 * Check      each mean is N - 1 within 2 %; j is a neighbour of i just when i is one of j */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

enum { ACROSS = 40, POINTS = ACROSS * ACROSS, MOST = 200 };

static const double dx = 0.025;     /* spacing [m]: the box is 1 m x 1 m */
static double x[POINTS], y[POINTS]; /* [m] */

/* Between -1/2 and 1/2; the same everywhere. */
static double noise(void)
{
  static unsigned state = 1;
  state = state * 1664525u + 1013904223u;
  return (state >> 8) / 16777216.0 - 0.5;
}

static void place(void)
{
  for (int i = 0; i < POINTS; i++) {
    x[i] = dx * (i % ACROSS + 0.5 + 0.8 * noise());
    y[i] = dx * (i / ACROSS + 0.5 + 0.8 * noise());
  }
}

/* A search in the periodic box, its points sorted and its list built; NULL: error says why. */
static sph_neighbors *search(double reach, sph_error *error)
{
  const sph_neighbors_def def = {
      .dim = 2, .reach = reach, .dx = dx, .periodic = {1, 1}, .length = {1, 1}};
  sph_neighbors *neighbors = sph_neighbors_create(&def, error);
  const double *const points[] = {x, y};
  if (neighbors && !sph_neighbors_sort(neighbors, 0, POINTS, points, error) &&
      !sph_neighbors_build(neighbors, 0, 0, error))
    return neighbors;
  sph_neighbors_free(neighbors);
  return NULL;
}

static int is_neighbor(const sph_neighbors *neighbors, long i, long j)
{
  long found[MOST], n = sph_neighbors_find(neighbors, 0, 0, i, MOST, found, NULL);
  for (long k = 0; k < n && k < MOST; k++)
    if (found[k] == j) return 1;
  return 0;
}

static int measure(double h_over_dx, const sph_kernel *kernel)
{
  const double pi = acos(-1), reach = sph_kernel_support(kernel) * h_over_dx * dx;
  const double expected = pi * pow(reach / dx, 2) - 1;
  sph_error error = {0};
  sph_neighbors *neighbors = search(reach, &error);
  if (!neighbors) {
    fprintf(stderr, "02_neighbors: %s\n", error.text);
    return 0;
  }
  double sum = 0;
  int mutual = 1;
  for (long i = 0; i < POINTS; i++) {
    long found[MOST], n = sph_neighbors_find(neighbors, 0, 0, i, MOST, found, NULL);
    sum += (double)n;
    for (long k = 0; k < n && k < MOST; k += 7) mutual &= is_neighbor(neighbors, found[k], i);
  }
  sph_neighbors_free(neighbors);
  double mean = sum / POINTS, off = mean / expected - 1;
  printf("  %4.2f %14.3f %14.3f %+9.2f %%\n", h_over_dx, mean, expected, 100 * off);
  return mutual && fabs(off) < 0.02;
}

static void show(long i, double reach)
{
  sph_error error = {0};
  sph_neighbors *neighbors = search(reach, &error);
  long found[MOST];
  double distance[MOST];
  long n = neighbors ? sph_neighbors_find(neighbors, 0, 0, i, MOST, found, distance) : 0;
  printf("\nCloser than %g m to point %ld (through the faces of the box, too):\n", reach, i);
  for (long k = 0; k < n; k++) printf("  point %4ld at %.4f m\n", found[k], distance[k]);
  sph_neighbors_free(neighbors);
}

int main(void)
{
  const sph_kernel *kernel = sph_kernel_find("wendland-c2");
  int good = 1;
  place();
  printf("  h/dx  mean neighbours  pi (kappa h/dx)^2 - 1\n");
  for (double h = 1.2; h < 2.6; h += 0.3) good &= measure(h, kernel);
  show(0, 1.6 * dx);
  printf("\n%s\n", good ? "As many as there should be." : "Neighbours are wrong.");
  return !good;
}
