/* Every operation of our N_Vector against NVECTOR_SERIAL on the same random numbers; padding
 * that stays and does not count; the same bits for any number of threads. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <string.h>

#include "nvector.h"

enum { VECTORS = 6 };
static const double PADDING = 777;

/* Segments: short, empty, full to capacity, longer than a chunk, long enough for threads. */
static sph_segment segment[] = {{.offset = 0, .n = 13, .capacity = 24},
                                {.offset = 24, .n = 0, .capacity = 8},
                                {.offset = 32, .n = 8, .capacity = 8},
                                {.offset = 40, .n = 4097, .capacity = 4104},
                                {.offset = 4144, .n = 40001, .capacity = 40008}};
static const sph_layout layout = {.length = 44152,
                                  .entries = 44119,
                                  .segments = 5,
                                  .segment = segment};

typedef struct pair {
  SUNContext context;
  N_Vector ours[VECTORS], serial[VECTORS]; /* the same entries, without padding in serial */
} pair;

static double chance(uint64_t *state) /* (-1, 1), xorshift64 (Marsaglia 2003) */
{
  *state ^= *state << 13;
  *state ^= *state >> 7;
  *state ^= *state << 17;
  return (double)(*state >> 11) * 0x1p-52 - 1;
}

static void fill(N_Vector ours, N_Vector serial, uint64_t seed)
{
  double *a = sph_nvector_data(ours), *b = N_VGetArrayPointer(serial);
  for (long i = 0; i < layout.length; i++) a[i] = PADDING;
  for (int k = 0; k < layout.segments; k++)
    for (long i = 0; i < segment[k].n; i++) a[segment[k].offset + i] = *b++ = 3 * chance(&seed);
}

static pair make(int threads)
{
  pair p;
  sph_error error = {0};
  p.context = sph_sundials_context(&error);
  assert_non_null(p.context);
  for (int k = 0; k < VECTORS; k++) {
    p.ours[k] = k ? N_VClone(p.ours[0]) : sph_nvector_create(&layout, threads, p.context, &error);
    p.serial[k] = N_VNew_Serial((sunindextype)layout.entries, p.context);
    assert_non_null(p.ours[k]);
    fill(p.ours[k], p.serial[k], 88172645463325252u + (uint64_t)k);
  }
  return p;
}

static void drop(pair *p)
{
  for (int k = 0; k < VECTORS; k++) {
    N_VDestroy(p->ours[k]);
    N_VDestroy(p->serial[k]);
  }
  sph_sundials_context_free(p->context);
}

/* The entries are those of the serial vector to two roundings (contraction to FMA), the padding
 * is there. */
static void assert_same(const pair *p, int k, const char *operation)
{
  const double *a = sph_nvector_data(p->ours[k]), *b = N_VGetArrayPointer(p->serial[k]);
  for (int s = 0; s < layout.segments; s++) {
    for (long i = 0; i < segment[s].n; i++, b++)
      if (!(fabs(a[segment[s].offset + i] - *b) <= 1e-15 * (1 + fabs(*b))))
        fail_msg("%s: segment %d entry %ld: %.17g, serial %.17g", operation, s, i,
                 a[segment[s].offset + i], *b);
    for (long i = segment[s].n; i < segment[s].capacity; i++)
      if (a[segment[s].offset + i] != PADDING)
        fail_msg("%s: segment %d: padding is %g", operation, s, a[segment[s].offset + i]);
  }
}

static void assert_close(double ours, double serial, const char *operation)
{
  if (!(fabs(ours - serial) <= 1e-12 * (1 + fabs(serial))))
    fail_msg("%s: %.17g, serial %.17g", operation, ours, serial);
}

#define BOTH(operation, ...)        \
  do {                              \
    N_Vector *v = p.ours;           \
    operation(__VA_ARGS__);         \
    v = p.serial;                   \
    operation(__VA_ARGS__);         \
    assert_same(&p, 0, #operation); \
  } while (0)

static void entrywise(void **state)
{
  (void)state;
  for (int threads = 1; threads <= 3; threads++) {
    pair p = make(threads);
    BOTH(N_VLinearSum, 0.7, v[1], -1.3, v[2], v[0]);
    BOTH(N_VLinearSum, 1, v[1], 1, v[0], v[0]);
    BOTH(N_VProd, v[1], v[2], v[0]);
    BOTH(N_VDiv, v[1], v[2], v[0]);
    BOTH(N_VScale, -2.5, v[1], v[0]);
    BOTH(N_VScale, 1, v[1], v[0]);
    BOTH(N_VScale, 3, v[0], v[0]);
    BOTH(N_VAbs, v[2], v[0]);
    BOTH(N_VInv, v[2], v[0]);
    BOTH(N_VAddConst, v[1], 0.25, v[0]);
    BOTH(N_VCompare, 1.5, v[1], v[0]);
    BOTH(N_VConst, 4.5, v[0]);
    drop(&p);
  }
}

static void combinations(void **state)
{
  (void)state;
  double c[] = {0.3, -1.7, 2.2, 0.9, -0.4};
  pair p = make(2);
  for (int count = 1; count <= 5; count++) {
    BOTH(N_VLinearCombination, count, c, v + 1, v[0]);
    fill(p.ours[0], p.serial[0], 12345);
    BOTH(N_VLinearCombination, count, c, v, v[0]); /* the first is also the result */
    fill(p.ours[0], p.serial[0], 54321);
  }
  for (int zeros = 0; zeros < 32; zeros++) { /* what is multiplied by zero is left out */
    double some[5];
    for (int k = 0; k < 5; k++) some[k] = zeros >> k & 1 ? 0 : c[k];
    BOTH(N_VLinearCombination, 5, some, v + 1, v[0]);
  }
  BOTH(N_VScaleAddMulti, 1, c, v[1], v + 2, v);
  for (N_Vector *v = p.ours; v; v = v == p.ours ? p.serial : NULL)
    N_VScaleAddMulti(3, c, v[5], v + 1, v + 2);
  for (int k = 2; k < 5; k++) assert_same(&p, k, "N_VScaleAddMulti");
  drop(&p);
}

/* More vectors than are looked at for zeros: the same ones again and again. */
static void long_combinations(void **state)
{
  (void)state;
  enum { LONG = 40 };
  double c[LONG];
  uint64_t seed = 4711;
  pair p = make(2);
  for (int count = 6; count <= LONG; count += 17) {
    N_Vector ours[LONG], serial[LONG];
    for (int k = 0; k < count; k++) {
      c[k] = k % 3 ? 0.1 * chance(&seed) : 0;
      ours[k] = p.ours[1 + k % (VECTORS - 1)];
      serial[k] = p.serial[1 + k % (VECTORS - 1)];
    }
    N_VLinearCombination(count, c, ours, p.ours[0]);
    N_VLinearCombination(count, c, serial, p.serial[0]);
    assert_same(&p, 0, "N_VLinearCombination");
  }
  drop(&p);
}

static void reductions(void **state)
{
  (void)state;
  pair p = make(1);
  N_Vector *a = p.ours, *b = p.serial;
  double ours[2], serial[2];
  assert_close(N_VDotProd(a[0], a[1]), N_VDotProd(b[0], b[1]), "N_VDotProd");
  assert_close(N_VMaxNorm(a[0]), N_VMaxNorm(b[0]), "N_VMaxNorm");
  assert_close(N_VWrmsNorm(a[0], a[1]), N_VWrmsNorm(b[0], b[1]), "N_VWrmsNorm");
  assert_close(N_VWrmsNormMask(a[0], a[1], a[2]), N_VWrmsNormMask(b[0], b[1], b[2]), "mask");
  assert_close(N_VMin(a[0]), N_VMin(b[0]), "N_VMin");
  assert_close(N_VWL2Norm(a[0], a[1]), N_VWL2Norm(b[0], b[1]), "N_VWL2Norm");
  assert_close(N_VL1Norm(a[0]), N_VL1Norm(b[0]), "N_VL1Norm");
  assert_close(N_VMinQuotient(a[0], a[1]), N_VMinQuotient(b[0], b[1]), "N_VMinQuotient");
  N_VDotProdMulti(2, a[0], a + 1, ours);
  N_VDotProdMulti(2, b[0], b + 1, serial);
  for (int k = 0; k < 2; k++) assert_close(ours[k], serial[k], "N_VDotProdMulti");
  N_VConst(0, a[1]);
  N_VConst(0, b[1]);
  assert_close(N_VMinQuotient(a[0], a[1]), N_VMinQuotient(b[0], b[1]), "no quotient");
  assert_int_equal(N_VGetLength(a[0]), layout.entries);
  drop(&p);
}

static void tests_of_entries(void **state)
{
  (void)state;
  pair p = make(2);
  assert_true(N_VInvTest(p.ours[1], p.ours[0]) && N_VInvTest(p.serial[1], p.serial[0]));
  assert_same(&p, 0, "N_VInvTest");
  sph_nvector_data(p.ours[1])[segment[4].offset] = 0;
  N_VGetArrayPointer(p.serial[1])[13 + 8 + 4097] = 0;
  assert_false(N_VInvTest(p.ours[1], p.ours[0]) || N_VInvTest(p.serial[1], p.serial[0]));
  assert_same(&p, 0, "N_VInvTest with a zero");
  for (int kind = -2; kind <= 2; kind++) {
    N_VConst(kind, p.ours[2]);
    N_VConst(kind, p.serial[2]);
    assert_int_equal(N_VConstrMask(p.ours[2], p.ours[1], p.ours[0]),
                     N_VConstrMask(p.serial[2], p.serial[1], p.serial[0]));
    assert_same(&p, 0, "N_VConstrMask");
    assert_int_equal(N_VConstrMask(p.ours[2], p.ours[1], p.ours[0]), kind == 0);
  }
  drop(&p);
}

/* All reductions of one vector set, to compare their bits. */
static void reduce(int threads, double result[7])
{
  pair p = make(threads);
  N_Vector *v = p.ours;
  result[0] = N_VDotProd(v[0], v[1]);
  result[1] = N_VMaxNorm(v[0]);
  result[2] = N_VWrmsNorm(v[0], v[1]);
  result[3] = N_VWrmsNormMask(v[0], v[1], v[2]);
  result[4] = N_VMin(v[0]);
  result[5] = N_VL1Norm(v[0]);
  result[6] = N_VMinQuotient(v[0], v[1]);
  drop(&p);
}

static void bits_do_not_depend_on_threads(void **state)
{
  (void)state;
  double one[7], more[7];
  reduce(1, one);
  for (int threads = 2; threads <= 5; threads++) {
    reduce(threads, more);
    assert_memory_equal(one, more, sizeof one);
  }
}

static void clones(void **state)
{
  (void)state;
  pair p = make(1);
  N_Vector v = N_VClone(p.ours[1]), empty = N_VCloneEmpty(p.ours[1]);
  assert_ptr_equal(sph_nvector_layout(v), &layout);
  assert_int_equal(N_VGetVectorID(v), SUNDIALS_NVEC_CUSTOM);
  assert_true((uintptr_t)sph_nvector_data(v) % 64 == 0);
  assert_null(sph_nvector_data(empty));
  for (long i = 0; i < layout.length; i++) assert_true(sph_nvector_data(v)[i] == 0);
  N_VDestroy(empty);
  drop(&p);
  N_VConst(2, v); /* outlives its root */
  assert_true(N_VL1Norm(v) == 2.0 * (double)layout.entries);
  N_VDestroy(v);
}

/* A plain array of the entries, without padding, and back. */
static void plain_arrays(void **state)
{
  (void)state;
  pair p = make(2);
  sunindextype bytes = 0;
  static double array[44119 + 1], back[44119];
  array[layout.entries] = PADDING;
  assert_int_equal(N_VBufSize(p.ours[0], &bytes), 0);
  assert_int_equal(bytes, layout.entries * (long)sizeof(double));
  assert_int_equal(N_VBufPack(p.ours[0], array), 0);
  assert_memory_equal(array, N_VGetArrayPointer(p.serial[0]), (size_t)bytes);
  assert_true(array[layout.entries] == PADDING);
  assert_int_equal(N_VBufUnpack(p.ours[1], array), 0);
  N_VScale(1, p.serial[0], p.serial[1]);
  assert_same(&p, 1, "N_VBufUnpack");
  assert_int_equal(N_VBufPack(p.ours[1], back), 0);
  assert_memory_equal(array, back, (size_t)bytes);
  assert_true(N_VBufPack(p.ours[0], NULL) != 0);
  drop(&p);
}

/* A segment's n may change: the norm then counts what it holds. */
static void entries_may_come_and_go(void **state)
{
  (void)state;
  sph_segment one = {.offset = 0, .n = 5000, .capacity = 8192};
  sph_layout changing = {.length = 8192, .entries = 5000, .segments = 1, .segment = &one};
  sph_error error = {0};
  SUNContext context = sph_sundials_context(&error);
  N_Vector v = sph_nvector_create(&changing, 2, context, &error);
  N_VConst(1, v);
  assert_true(N_VL1Norm(v) == 5000);
  one.n = changing.entries = 100;
  assert_true(N_VL1Norm(v) == 100);
  one.n = changing.entries = 8192;
  assert_true(N_VL1Norm(v) == 5000);
  N_VDestroy(v);
  sph_sundials_context_free(context);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(entrywise),
      cmocka_unit_test(combinations),
      cmocka_unit_test(long_combinations),
      cmocka_unit_test(reductions),
      cmocka_unit_test(tests_of_entries),
      cmocka_unit_test(bits_do_not_depend_on_threads),
      cmocka_unit_test(clones),
      cmocka_unit_test(plain_arrays),
      cmocka_unit_test(entries_may_come_and_go),
  };
  return cmocka_run_group_tests_name("nvector", tests, NULL, NULL);
}
