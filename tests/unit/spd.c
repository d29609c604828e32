#include "spd.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <math.h>

enum { MOST = 512 };

double spd_chance(uint64_t *state) /* xorshift64 (Marsaglia 2003) */
{
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-52 - 1;
}

static double x[MOST][3];
static int part[MOST];

static double weight(int i, int j)
{
  double r2 = 0;
  if (part[i] != part[j]) return 0;
  for (int d = 0; d < 3; d++) r2 += (x[i][d] - x[j][d]) * (x[i][d] - x[j][d]);
  return r2 < 9 ? pow(1 - sqrt(r2) / 3, 3) : 0;
}

static void place(int dim, int across, int n, uint64_t *state)
{
  for (int i = 0; i < n; i++)
    for (int d = 0, rest = i; d < 3; d++, rest /= across)
      x[i][d] = d < dim ? rest % across + 0.2 * spd_chance(state) : 0;
}

static void add_row(sph_csr *A, long i, uint64_t *state)
{
  long begin = A->start[i], k = begin;
  for (long j = 0; j < A->n; j++)
    if (j != i && weight((int)i, (int)j) > 0) {
      long at = begin + (long)((0.5 + 0.5 * spd_chance(state)) * (double)(k - begin + 1));
      if (at > k) at = k;
      A->column[k] = A->column[at]; /* a random place among those that are there */
      A->column[at] = (int)j;
      k++;
    }
  A->start[i + 1] = k;
  for (long l = begin; l < k; l++) A->value[l] = -weight((int)i, A->column[l]);
}

static void assemble(sph_csr *A, long n, double condition, uint64_t *state)
{
  sph_error error = {0};
  double most = 0, gamma;
  if (sph_csr_reserve(A, n, n * (n - 1), &error)) fail_msg("%s", error.text);
  A->n = n;
  A->start[0] = 0;
  for (long i = 0; i < n; i++) {
    add_row(A, i, state);
    A->floor[i] = 1 + 0.5 * spd_chance(state);
    A->diagonal[i] = 0;
    for (long k = A->start[i]; k < A->start[i + 1]; k++) A->diagonal[i] -= A->value[k];
    most = fmax(most, A->diagonal[i]);
  }
  gamma = most > 0 ? condition / (2 * most) : 1;
  for (long i = 0; i < n; i++) {
    A->diagonal[i] = A->floor[i] + gamma * A->diagonal[i];
    for (long k = A->start[i]; k < A->start[i + 1]; k++) A->value[k] *= gamma;
  }
}

void spd_make(sph_csr *A, int dim, int across, double condition, uint64_t seed)
{
  int n = 1;
  for (int d = 0; d < dim; d++) n *= across;
  assert_true(n <= MOST);
  place(dim, across, n, &seed);
  for (int i = 0; i < n; i++) part[i] = 0;
  assemble(A, n, condition, &seed);
}

void spd_make_two(sph_csr *A, int dim, int across, double condition, uint64_t seed)
{
  int n = 1;
  for (int d = 0; d < dim; d++) n *= across;
  assert_true(n <= MOST);
  place(dim, across, n, &seed);
  for (int i = 0; i < n; i++) part[i] = spd_chance(&seed) > 0;
  assemble(A, n, condition, &seed);
}
