/* balance.h -- sums over particles that must vanish, and the scenes that they are taken over. */
#ifndef BALANCE_H
#define BALANCE_H
#include "scene.h"

/* A sum that must vanish, and what it is small against. */
typedef struct balance {
  real sum, size;
} balance;

static inline void add(balance *b, real x) { b->sum += x, b->size += fabsl(x); }

static double balance_largest; /* sum of its size that assert_zero was given with 1e-14 */

static inline void assert_zero(const balance *b, double tolerance, const char *what)
{
  assert_true(b->size > 0); /* something was there to cancel */
  if (tolerance <= 1e-14)
    balance_largest = fmax(balance_largest, (double)(fabsl(b->sum) / b->size));
  if (fabsl(b->sum) <= tolerance * b->size) return;
  fail_msg("%s: %Lg of %Lg", what, b->sum, b->size);
}

/* At the end of a program. */
static inline int balance_tell(void **state)
{
  (void)state;
  print_message("# sums that must vanish: %.2g of their size\n", balance_largest);
  return 0;
}

static inline real power_of(const scene *s, const scene_rates *r, long i)
{
  real sum = 0;
  for (int k = 0; k < s->o.dim; k++) sum += s->o.particle[i].v[k] * r->a[k][i];
  return s->o.particle[i].m * sum;
}

static inline void assert_momentum(const scene *s, const scene_rates *r)
{
  for (int k = 0; k < s->o.dim; k++) {
    balance force = {0, 0};
    for (long i = 0; i < r->n; i++) add(&force, s->o.particle[i].m * r->a[k][i]);
    assert_zero(&force, 1e-14, "sum m a");
  }
}

/* sum m x cross a, component d. */
static inline balance torque_of(const scene *s, const scene_rates *r, int d)
{
  int p = (d + 1) % 3, q = (d + 2) % 3;
  balance torque = {0, 0};
  for (long i = 0; i < r->n; i++) {
    const oracle_particle *it = &s->o.particle[i];
    add(&torque, it->m * it->x[p] * r->a[q][i]);
    add(&torque, -it->m * it->x[q] * r->a[p][i]);
  }
  return torque;
}

/* Periodic boxes and free clouds of liquid and of gas: every kernel in every dimension. */
enum { SCENES = 3 * ORACLE_KERNELS };
static inline scene_def scene_number(int k, int thermal, int periodic)
{
  scene_def def = {.dim = 1 + k % 3,
                   .kernel = k % ORACLE_KERNELS,
                   .random = k / 6 % 2,
                   .fluids = 1};
  def.n = def.dim == 1 ? 60 : def.dim == 2 ? 16 : 8;
  def.thermal = thermal;
  def.seed = (unsigned long)(700 + k);
  for (int d = 0; d < def.dim; d++) def.periodic[d] = periodic;
  return def;
}

#endif
