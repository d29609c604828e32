/* Consistency of operators, as tables in Markdown, or the data of one picture:
 *
 *   bench/consistency             the tables of docs/consistency.md
 *   bench/consistency KIND        columns for gnuplot: spacing, then the error of each operator;
 *                                 KIND: lattice, jitter, lattice-wide, jitter-wide
 *
 * All in 2D.  Moments: inside a box with ends, at the kernel's recommended h/dx.  Orders: the waves
 * of truncation.c in a periodic box, Wendland C2. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "property/cloud.h"
#include "property/truncation.h"

/* ---- moments: what operators make of 1, x, x^2/2 */

enum { COLUMNS = 8, ACROSS = 60 };

typedef struct moments {
  double sum[COLUMNS]; /* of squares */
  long count;
} moments;

/* At inner points i; all without a dimension. */
static void add(moments *m, const double value[COLUMNS])
{
  for (int c = 0; c < COLUMNS; c++) m->sum[c] += value[c] * value[c];
  m->count++;
}

static moments measure(const sph_kernel *kernel, double h_over_dx, double jitter)
{
  enum { FIELDS = 3, RESULTS = 10 };
  cloud c = cloud_make(2, ACROSS, jitter, 0, 0);
  const double h = h_over_dx * c.dx, reach = sph_kernel_support(kernel) * h;
  const double variance = pow(sph_kernel_deviation(kernel, 2) * h, 2);
  sph_operator *op =
      cloud_operator(&c, (sph_operator_def){.h = h, .kernel = sph_kernel_name(kernel)});
  double *f[FIELDS], *o[RESULTS];
  for (int k = 0; k < FIELDS; k++) f[k] = cloud_array(c.n);
  for (int k = 0; k < RESULTS; k++) o[k] = cloud_array(c.n);
  for (long i = 0; i < c.n; i++) f[0][i] = 1, f[1][i] = c.x[0][i], f[2][i] = pow(f[1][i], 2) / 2;
  for (int k = 0; k < FIELDS; k++) sph_operator_interpolate(op, f[k], o[k], NULL);
  sph_operator_gradient(op, "plain", f[0], o + 3, NULL);
  sph_operator_gradient(op, "difference", f[1], o + 5, NULL);
  sph_operator_laplacian(op, "arithmetic", NULL, f[2], o[7], NULL);
  sph_operator_laplacian(op, "corrected", NULL, f[2], o[8], NULL);
  sph_operator_laplacian(op, "fatehi-manzari", NULL, f[2], o[9], NULL);
  moments m = {0};
  for (long i = 0; i < c.n; i++) {
    const double x = c.x[0][i], y = c.x[1][i];
    if (fmax(fabs(x - 0.5), fabs(y - 0.5)) > 0.5 - reach - c.dx) continue;
    const double first = o[1][i] - x * o[0][i];
    const double second = 2 * o[2][i] - 2 * x * o[1][i] + x * x * o[0][i];
    add(&m, (const double[]){o[0][i] - 1, first / h, second / variance - 1, o[3][i] * h,
                             o[5][i] - 1, o[7][i] - 1, o[8][i] - 1, o[9][i] - 1});
  }
  sph_operator_free(op);
  for (int k = 0; k < FIELDS; k++) free(f[k]);
  for (int k = 0; k < RESULTS; k++) free(o[k]);
  cloud_free(&c);
  return m;
}

static void print_moments(double jitter)
{
  printf("\n| kernel | h/Δx | ΣVW − 1 | ΣV(x_j − x_i)W/h ");
  printf("| ΣV(x_j − x_i)²W/(σ_k²h²) − 1 | hΣV∂_xW ");
  printf("| ΣV(x_j − x_i)∂_xW − 1 | L1 | L2 | L3 |\n");
  printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (int k = 0; sph_kernel_get(k); k++) {
    const sph_kernel *kernel = sph_kernel_get(k);
    const moments m = measure(kernel, sph_kernel_h_over_dx(kernel), jitter);
    printf("| `%s` | %g", sph_kernel_name(kernel), sph_kernel_h_over_dx(kernel));
    for (int c = 0; c < COLUMNS; c++) {
      const double rms = sqrt(m.sum[c] / (double)m.count);
      if (rms < 1e-10)
        printf(" | < 1e-10");
      else
        printf(" | %.1e", rms);
    }
    printf(" |\n");
  }
}

/* ---- truncation: <f> - f = c h^2 lap f where sums are as good as integrals */

static double amplitude(const sph_kernel *kernel, int across, double h_over_dx)
{
  cloud c = cloud_make(2, across, 0, 1, 0);
  sph_operator *op = cloud_operator(&c, (sph_operator_def){.h = h_over_dx * c.dx,
                                                           .kernel = sph_kernel_name(kernel)});
  double *f = cloud_array(c.n), *o = cloud_array(c.n), sum = 0, size = 0;
  for (long i = 0; i < c.n; i++) f[i] = sin(2 * acos(-1) * c.x[0][i]);
  sph_operator_shepard(op, f, o, NULL);
  for (long i = 0; i < c.n; i++) sum += f[i] * o[i], size += f[i] * f[i];
  sph_operator_free(op);
  cloud_free(&c);
  free(f), free(o);
  return sum / size;
}

static void print_truncation(void)
{
  enum { N = 120, WIDE = 5 };
  printf("\n| kernel | c | σ_k²/2 | order in h |\n|---|---|---|---|\n");
  for (int k = 0; sph_kernel_get(k); k++) {
    const sph_kernel *kernel = sph_kernel_get(k);
    const double wave = 2 * acos(-1), h = (double)WIDE / N;
    const double e1 = 1 - amplitude(kernel, N, WIDE), e2 = 1 - amplitude(kernel, 2 * N, WIDE);
    printf("| `%s` | %.4f | %.4f | %.2f |\n", sph_kernel_name(kernel), e2 / pow(wave * h / 2, 2),
           pow(sph_kernel_deviation(kernel, 2), 2) / 2, log2(e1 / e2));
  }
}

/* ---- orders */

enum { LEVELS = 4, FIRST = 16 };

static const struct {
  const char *name;
  double jitter, h_over_dx;
  int wide; /* h/dx grows as 1/sqrt(dx) */
} kinds[] = {{"lattice", 0, 1.6, 0},
             {"lattice-wide", 0, 1.2, 1},
             {"jitter", 0.2, 1.6, 0},
             {"jitter-wide", 0.2, 1.2, 1}};
enum { KINDS = sizeof kinds / sizeof *kinds };

static int across_of(int level) { return FIRST << level; }

static void errors_of(int kind, int level, double error[TRUNCATIONS])
{
  const double growth = kinds[kind].wide ? pow(2, 0.5 * level) : 1;
  truncation_measure(2, across_of(level), kinds[kind].h_over_dx * growth, NULL, kinds[kind].jitter,
                     error);
}

static void print_data(int kind)
{
  printf("dx");
  for (int k = 0; truncation_name(k); k++) printf(" \"%s\"", truncation_name(k));
  for (int level = 0; level < LEVELS; level++) {
    double e[TRUNCATIONS];
    errors_of(kind, level, e);
    printf("\n%.6g", 1.0 / across_of(level));
    for (int k = 0; truncation_name(k); k++) printf(" %.4e", e[k]);
  }
  printf("\n");
}

static void print_orders(void)
{
  double e[KINDS][2][TRUNCATIONS];
  for (int kind = 0; kind < KINDS; kind++)
    for (int last = 0; last < 2; last++) errors_of(kind, LEVELS - 2 + last, e[kind][last]);
  printf("\n| operator");
  for (int kind = 0; kind < KINDS; kind++) printf(" | %s | order", kinds[kind].name);
  printf(" |\n|---|---|---|---|---|---|---|---|---|\n");
  for (int k = 0; truncation_name(k); k++) {
    printf("| %s", truncation_name(k));
    for (int kind = 0; kind < KINDS; kind++)
      printf(" | %.1e | %.2f", e[kind][1][k], log2(e[kind][0][k] / e[kind][1][k]));
    printf(" |\n");
  }
}

int main(int argc, char **argv)
{
  for (int kind = 0; argc > 1 && kind < KINDS; kind++)
    if (!strcmp(argv[1], kinds[kind].name)) return print_data(kind), 0;
  if (argc > 1) return fprintf(stderr, "consistency: what is %s?\n", argv[1]), 2;
  print_moments(0);
  print_moments(0.2);
  print_truncation();
  print_orders();
  return 0;
}
