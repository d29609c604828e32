/* Sorting by one coordinate, ties by index: a total order, so that the result does not depend on
 * how it was found. */
#include "searches.h"

enum { FEW = 16 };

static inline int before(const sph_item *a, const sph_item *b, int d)
{
  return a->x[d] < b->x[d] || (a->x[d] == b->x[d] && a->id < b->id);
}

static inline void swap(sph_item *a, sph_item *b)
{
  sph_item c = *a;
  *a = *b;
  *b = c;
}

static void insert(sph_item *item, long n, int d)
{
  for (long k = 1; k < n; k++) {
    sph_item here = item[k];
    long m = k;
    for (; m > 0 && before(&here, &item[m - 1], d); m--) item[m] = item[m - 1];
    item[m] = here;
  }
}

/* The middle one of three items at places as if by chance: no order of the points is a bad one. */
static sph_item pivot(const sph_item *item, long n, int d)
{
  uint64_t seed = (uint64_t)n * 0x9e3779b97f4a7c15u;
  const sph_item *a = &item[(seed >> 32) * (uint64_t)n >> 32], *b = &item[n / 2], *c;
  seed *= 0xd1342543de82ef95u;
  c = &item[(seed >> 32) * (uint64_t)n >> 32];
  if (before(b, a, d)) {
    const sph_item *t = a;
    a = b;
    b = t;
  }
  return before(c, a, d) ? *a : before(b, c, d) ? *b : *c;
}

/* Items before the returned place are not greater than those from there on; both parts have some.
 * n >= 2 (Hoare 1961). */
static long part(sph_item *item, long n, int d)
{
  const sph_item p = pivot(item, n, d);
  long i = -1, j = n;
  for (;;) {
    do i++;
    while (before(&item[i], &p, d));
    do j--;
    while (before(&p, &item[j], d));
    if (i >= j) break;
    swap(&item[i], &item[j]);
  }
  return j + 1 < n ? j + 1 : n - 1;
}

void sph_neighbors_rank_sort(sph_item *item, long n, int d)
{
  while (n > FEW) {
    long k = part(item, n, d);
    if (k <= n - k) { /* the shorter part first: not deeper than log n */
      sph_neighbors_rank_sort(item, k, d);
      item += k;
      n -= k;
    } else {
      sph_neighbors_rank_sort(item + k, n - k, d);
      n = k;
    }
  }
  insert(item, n, d);
}

void sph_neighbors_rank_split(sph_item *item, long n, long middle, int d)
{
  while (n > FEW) {
    long k = part(item, n, d);
    if (middle < k)
      n = k;
    else {
      item += k;
      middle -= k;
      n -= k;
    }
  }
  insert(item, n, d);
}
