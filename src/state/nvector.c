/* Every operation runs over chunks: at most CHUNK entries of one segment, never its padding.  The
 * chunks are the same for any number of threads, and so are the sums: one partial sum a chunk,
 * added in order. */
#include "nvector.h"

#include <math.h>
#include <string.h>

#include "memory.h"

enum {
  CHUNK = 4096,         /* entries: 32 KiB */
  PARALLEL_MIN = 32768, /* entries from which on threads pay */
  BLOCK = 512,          /* entries of a linear combination that stay in the first cache */
  MOST = 24             /* vectors of one whose zeros are left out */
};

typedef struct content {
  struct shared *shared;
  double *data; /* [layout->length], owned; NULL in an empty clone */
  int lost;     /* no memory: see shared */
} content;

/* What a vector shares with all its clones.
 *
 * SUNDIALS 6 writes to what a clone returns without looking at it.  A clone without memory is
 * therefore a vector without entries, and while there is one no operation does anything: whoever
 * cloned asks sph_nvector_lost. */
typedef struct shared {
  const sph_layout *layout; /* borrowed */
  int threads, chunks;
  long vectors;  /* that use it; the last one frees it */
  long *start;   /* [chunks] first entry */
  int *segment;  /* [chunks] */
  double *part;  /* [chunks] partial results of the reduction at work */
  long lost;     /* clones alive without memory */
  content spare; /* of those that did not even get their content */
} shared;

/* What a kernel gets; members that an operation does not need are zero. */
typedef struct operands {
  double a, b;
  const double *x, *y, *w;
  double *z;
  int count;         /* of the vectors in X */
  const double *c;   /* [count] */
  const N_Vector *X; /* [count] */
} operands;

static content *of(N_Vector v) { return v->content; }
static double *data(N_Vector v) { return of(v)->data; }

double *sph_nvector_data(N_Vector v) { return data(v); }
const sph_layout *sph_nvector_layout(N_Vector v) { return of(v)->shared->layout; }

int sph_nvector_holds(N_Vector v, long length)
{
  return v && v->ops->nvgetarraypointer == sph_nvector_data && data(v) &&
         sph_nvector_layout(v)->length >= length;
}

/* Entries of chunk k: they follow the segment's n, which may change between steps. */
static long chunk_end(const shared *s, int k)
{
  const sph_segment *segment = &s->layout->segment[s->segment[k]];
  long end = segment->offset + segment->n;
  return end < s->start[k] + CHUNK ? end : s->start[k] + CHUNK;
}

/* One thread: without OpenMP, whose teams of one are a call of the system, too, in libgomp. */
static int alone(const shared *s) { return s->threads == 1 || s->layout->entries < PARALLEL_MIN; }

static void each(N_Vector v, void (*kernel)(const operands *o, long from, long to), operands o)
{
  const shared *s = of(v)->shared;
  if (s->lost) return;
  if (alone(s)) {
    for (int k = 0; k < s->chunks; k++) kernel(&o, s->start[k], chunk_end(s, k));
    return;
  }
#pragma omp parallel for num_threads(s->threads) schedule(static)
  for (int k = 0; k < s->chunks; k++) kernel(&o, s->start[k], chunk_end(s, k));
}

/* The kernel's result of each chunk, in shared->part. */
static const shared *parts(N_Vector v, double (*kernel)(const operands *o, long from, long to),
                           operands o)
{
  const shared *s = of(v)->shared;
  if (s->lost) return s;
  if (alone(s)) {
    for (int k = 0; k < s->chunks; k++) s->part[k] = kernel(&o, s->start[k], chunk_end(s, k));
    return s;
  }
#pragma omp parallel for num_threads(s->threads) schedule(static)
  for (int k = 0; k < s->chunks; k++) s->part[k] = kernel(&o, s->start[k], chunk_end(s, k));
  return s;
}

static double sum(N_Vector v, double (*kernel)(const operands *o, long from, long to), operands o)
{
  const shared *s = parts(v, kernel, o);
  double total = 0;
  for (int k = 0; k < s->chunks; k++) total += s->part[k];
  return total;
}

static double largest(N_Vector v, double (*kernel)(const operands *o, long from, long to),
                      operands o, double start)
{
  const shared *s = parts(v, kernel, o);
  double most = start;
  for (int k = 0; k < s->chunks; k++) most = s->part[k] > most ? s->part[k] : most;
  return most;
}

/* Entrywise kernels.  The result may be an operand: the same entry is read, then written. */
#define ENTRYWISE(name, expression)                                         \
  static void name(const operands *o, long from, long to)                   \
  {                                                                         \
    const double a = o->a, b = o->b, *x = o->x, *y = o->y;                  \
    double *z = o->z;                                                       \
    (void)a, (void)b, (void)x, (void)y;                                     \
    _Pragma("omp simd") for (long i = from; i < to; i++) z[i] = expression; \
  }
ENTRYWISE(entry_constant, a)
ENTRYWISE(entry_copy, x[i])
ENTRYWISE(entry_scale, a *x[i])
ENTRYWISE(entry_sum, a *x[i] + b * y[i])
ENTRYWISE(entry_product, x[i] * y[i])
ENTRYWISE(entry_quotient, x[i] / y[i])
ENTRYWISE(entry_absolute, fabs(x[i]))
ENTRYWISE(entry_inverse, 1 / x[i])
ENTRYWISE(entry_shift, x[i] + b)
ENTRYWISE(entry_compare, fabs(x[i]) >= a)
#undef ENTRYWISE

/* Sums with eight partial sums: fixed order, and vectors of the processor can hold them. */
#define SUMMED(name, expression)                                              \
  static double name(const operands *o, long from, long to)                   \
  {                                                                           \
    const double *x = o->x, *y = o->y, *w = o->w;                             \
    double s[8] = {0};                                                        \
    long i = from;                                                            \
    (void)y, (void)w;                                                         \
    for (; i + 8 <= to; i += 8)                                               \
      for (int k = 0; k < 8; k++) s[k] += expression(i + k);                  \
    for (int k = 0; i + k < to; k++) s[k] += expression(i + k);               \
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7])); \
  }
#define PRODUCT(i) (x[i] * y[i])
#define MAGNITUDE(i) fabs(x[i])
#define SQUARE(i) ((x[i] * y[i]) * (x[i] * y[i]))
#define MASKED(i) (w[i] > 0 ? SQUARE(i) : 0)
SUMMED(part_product, PRODUCT)
SUMMED(part_magnitude, MAGNITUDE)
SUMMED(part_square, SQUARE)
SUMMED(part_masked, MASKED)
#undef SUMMED

static double part_largest(const operands *o, long from, long to)
{
  double most = 0;
  for (long i = from; i < to; i++) most = fabs(o->x[i]) > most ? fabs(o->x[i]) : most;
  return most;
}

static double part_minus_least(const operands *o, long from, long to)
{
  double least = INFINITY;
  for (long i = from; i < to; i++) least = o->x[i] < least ? o->x[i] : least;
  return -least;
}

static double part_minus_quotient(const operands *o, long from, long to)
{
  double least = SUN_BIG_REAL;
  for (long i = from; i < to; i++)
    if (o->y[i] != 0 && o->x[i] / o->y[i] < least) least = o->x[i] / o->y[i];
  return -least;
}

/* 1 if an entry was zero */
static double part_inverse(const operands *o, long from, long to)
{
  double zero = 0;
  for (long i = from; i < to; i++)
    if (o->x[i] == 0)
      zero = 1;
    else
      o->z[i] = 1 / o->x[i];
  return zero;
}

/* Constraints y: +-2 strictly, +-1 weakly of that sign, 0 none; z marks the x that break theirs.
 * */
static double part_constraint(const operands *o, long from, long to)
{
  double broken = 0;
  for (long i = from; i < to; i++) {
    double kind = o->y[i], side = o->x[i] * kind;
    o->z[i] = (fabs(kind) > 1.5 && side <= 0) || (fabs(kind) > 0.5 && side < 0);
    if (o->z[i] > 0) broken = 1;
  }
  return broken;
}

/* z = sum of c[k] X[k] in one pass: each input is read once, the result written once. */
#define COMBINATION(name, expression)                                          \
  static void name(const operands *o, long from, long to)                      \
  {                                                                            \
    const double *c = o->c, *x0 = data(o->X[0]), *x1 = data(o->X[1]);          \
    const double *x2 = data(o->X[2]), *x3 = o->count > 3 ? data(o->X[3]) : x2; \
    const double *x4 = o->count > 4 ? data(o->X[4]) : x3;                      \
    double *z = o->z;                                                          \
    (void)x3, (void)x4;                                                        \
    _Pragma("omp simd") for (long i = from; i < to; i++) z[i] = expression;    \
  }
COMBINATION(entry_three, (c[0] * x0[i] + c[1] * x1[i]) + c[2] * x2[i])
COMBINATION(entry_four, (c[0] * x0[i] + c[1] * x1[i]) + (c[2] * x2[i] + c[3] * x3[i]))
COMBINATION(entry_five,
            ((c[0] * x0[i] + c[1] * x1[i]) + (c[2] * x2[i] + c[3] * x3[i])) + c[4] * x4[i])
#undef COMBINATION

/* The same of any number of vectors, block by block. */
static void entry_combination(const operands *o, long from, long to)
{
  for (long block = from; block < to; block += BLOCK) {
    long n = to - block < BLOCK ? to - block : BLOCK;
    double total[BLOCK] = {0};
    int k = 0;
    for (; k + 2 <= o->count; k += 2) {
      const double *x0 = data(o->X[k]) + block, *x1 = data(o->X[k + 1]) + block;
      const double c0 = o->c[k], c1 = o->c[k + 1];
      for (long i = 0; i < n; i++) total[i] += c0 * x0[i] + c1 * x1[i];
    }
    if (k < o->count) {
      const double *x = data(o->X[k]) + block, c = o->c[k];
      for (long i = 0; i < n; i++) total[i] += c * x[i];
    }
    memcpy(o->z + block, total, (size_t)n * sizeof *total);
  }
}

/* The operations as SUNDIALS names them. */
static void linear_sum(sunrealtype a, N_Vector x, sunrealtype b, N_Vector y, N_Vector z)
{
  each(z, entry_sum, (operands){.a = a, .b = b, .x = data(x), .y = data(y), .z = data(z)});
}

static void constant(sunrealtype a, N_Vector z)
{
  each(z, entry_constant, (operands){.a = a, .z = data(z)});
}

static void product(N_Vector x, N_Vector y, N_Vector z)
{
  each(z, entry_product, (operands){.x = data(x), .y = data(y), .z = data(z)});
}

static void quotient(N_Vector x, N_Vector y, N_Vector z)
{
  each(z, entry_quotient, (operands){.x = data(x), .y = data(y), .z = data(z)});
}

static void scale(sunrealtype a, N_Vector x, N_Vector z)
{
  if (a == 1 && x == z) return;
  each(z, a == 1 ? entry_copy : entry_scale, (operands){.a = a, .x = data(x), .z = data(z)});
}

static void absolute(N_Vector x, N_Vector z)
{
  each(z, entry_absolute, (operands){.x = data(x), .z = data(z)});
}

static void inverse(N_Vector x, N_Vector z)
{
  each(z, entry_inverse, (operands){.x = data(x), .z = data(z)});
}

static void add_constant(N_Vector x, sunrealtype b, N_Vector z)
{
  each(z, entry_shift, (operands){.b = b, .x = data(x), .z = data(z)});
}

static void compare(sunrealtype a, N_Vector x, N_Vector z)
{
  each(z, entry_compare, (operands){.a = a, .x = data(x), .z = data(z)});
}

static sunrealtype dot(N_Vector x, N_Vector y)
{
  return sum(x, part_product, (operands){.x = data(x), .y = data(y)});
}

static sunrealtype largest_magnitude(N_Vector x)
{
  return largest(x, part_largest, (operands){.x = data(x)}, 0);
}

static sunrealtype weighted_squares(N_Vector x, N_Vector w)
{
  return sum(x, part_square, (operands){.x = data(x), .y = data(w)});
}

static sunrealtype masked_squares(N_Vector x, N_Vector w, N_Vector mask)
{
  return sum(x, part_masked, (operands){.x = data(x), .y = data(w), .w = data(mask)});
}

static sunindextype length(N_Vector v) { return (sunindextype)of(v)->shared->layout->entries; }

static sunrealtype wrms(N_Vector x, N_Vector w)
{
  return sqrt(weighted_squares(x, w) / (double)length(x));
}

static sunrealtype wrms_mask(N_Vector x, N_Vector w, N_Vector mask)
{
  return sqrt(masked_squares(x, w, mask) / (double)length(x));
}

static sunrealtype weighted_l2(N_Vector x, N_Vector w) { return sqrt(weighted_squares(x, w)); }

static sunrealtype l1(N_Vector x) { return sum(x, part_magnitude, (operands){.x = data(x)}); }

static sunrealtype least(N_Vector x)
{
  return -largest(x, part_minus_least, (operands){.x = data(x)}, -INFINITY);
}

static sunrealtype least_quotient(N_Vector x, N_Vector y)
{
  operands o = {.x = data(x), .y = data(y)};
  return -largest(x, part_minus_quotient, o, -SUN_BIG_REAL);
}

static sunbooleantype inverse_test(N_Vector x, N_Vector z)
{
  return largest(x, part_inverse, (operands){.x = data(x), .z = data(z)}, 0) == 0;
}

static sunbooleantype constraint_mask(N_Vector c, N_Vector x, N_Vector mask)
{
  operands o = {.x = data(x), .y = data(c), .z = data(mask)};
  return largest(x, part_constraint, o, 0) == 0;
}

/* Tables have many zeros: what is multiplied by one is not read.  Vectors beyond MOST are. */
static int linear_combination(int count, sunrealtype *c, N_Vector *X, N_Vector z)
{
  double factor[MOST];
  N_Vector of_factor[MOST];
  operands o = {.c = factor, .X = of_factor, .z = data(z)};
  if (count < 1) return -1;
  for (int k = 0; k < count && count <= MOST; k++)
    if (c[k] != 0) {
      factor[o.count] = c[k];
      of_factor[o.count++] = X[k];
    }
  if (count > MOST) o.count = count, o.c = c, o.X = X;
  switch (o.count) {
  case 0: constant(0, z); break;
  case 1: scale(o.c[0], o.X[0], z); break;
  case 2: linear_sum(o.c[0], o.X[0], o.c[1], o.X[1], z); break;
  case 3: each(z, entry_three, o); break;
  case 4: each(z, entry_four, o); break;
  case 5: each(z, entry_five, o); break;
  default: each(z, entry_combination, o);
  }
  return 0;
}

static int scale_add_multi(int count, sunrealtype *a, N_Vector x, N_Vector *Y, N_Vector *Z)
{
  for (int k = 0; k < count; k++) linear_sum(a[k], x, 1, Y[k], Z[k]);
  return count < 1 ? -1 : 0;
}

static int dot_multi(int count, N_Vector x, N_Vector *Y, sunrealtype *products)
{
  for (int k = 0; k < count; k++) products[k] = dot(x, Y[k]);
  return count < 1 ? -1 : 0;
}

/* Making and freeing. */
static void shared_release(shared *s)
{
  if (!s || --s->vectors > 0) return;
  sph_memory_free(s->start);
  sph_memory_free(s->segment);
  sph_memory_free(s->part);
  sph_memory_free(s);
}

static shared *shared_create(const sph_layout *layout, int threads, sph_error *error)
{
  shared *s = SPH_NEW(shared, 1, "a vector", error);
  if (!s) return NULL;
  *s = (shared){.layout = layout, .threads = threads > 1 ? threads : 1, .vectors = 1};
  for (int k = 0; k < layout->segments; k++)
    s->chunks += (int)((layout->segment[k].capacity + CHUNK - 1) / CHUNK);
  s->start = SPH_NEW(long, s->chunks, "a vector's chunks", error);
  s->segment = SPH_NEW(int, s->chunks, "a vector's chunks", error);
  s->part = SPH_NEW(double, s->chunks, "a vector's partial sums", error);
  if (!s->start || !s->segment || !s->part) {
    shared_release(s);
    return NULL;
  }
  for (int k = 0, chunk = 0; k < layout->segments; k++)
    for (long i = 0; i < layout->segment[k].capacity; i += CHUNK, chunk++) {
      s->start[chunk] = layout->segment[k].offset + i;
      s->segment[chunk] = k;
    }
  return s;
}

static void destroy(N_Vector v)
{
  if (!v) return;
  content *c = of(v);
  if (c) {
    shared *s = c->shared;
    int owned = !s || c != &s->spare;
    if (s && c->lost) s->lost--;
    sph_memory_free(c->data);
    if (owned) sph_memory_free(c);
    shared_release(s);
  }
  v->content = NULL;
  N_VFreeEmpty(v);
}

static N_Vector clone_empty(N_Vector w)
{
  shared *s = of(w)->shared;
  N_Vector v = N_VNewEmpty(w->sunctx);
  if (!v || N_VCopyOps(w, v)) {
    if (v) N_VFreeEmpty(v);
    return NULL;
  }
  content *c = sph_memory_take(1, sizeof *c);
  if (!c) {
    s->lost++;
    c = &s->spare;
    *c = (content){.lost = 1};
  }
  c->shared = s;
  s->vectors++;
  v->content = c;
  return v;
}

static N_Vector clone(N_Vector w)
{
  N_Vector v = clone_empty(w);
  if (!v || of(v)->lost) return v;
  shared *s = of(v)->shared;
  of(v)->data = sph_memory_take((size_t)s->layout->length, sizeof(double));
  of(v)->lost = !of(v)->data;
  s->lost += of(v)->lost;
  return v;
}

long sph_nvector_lost(N_Vector v) { return of(v)->shared->lost; }

N_Vector sph_nvector_clone(N_Vector w, const char *what, sph_error *error)
{
  N_Vector v = clone(w);
  if (v && !of(v)->lost) return v;
  destroy(v);
  sph_error_set(error, SPH_ERR_MEMORY, "out of memory: %s, %.0f bytes", what,
                8.0 * (double)of(w)->shared->layout->length);
  return NULL;
}

static N_Vector_ID identity(N_Vector v)
{
  (void)v;
  return SUNDIALS_NVEC_CUSTOM;
}

static void space(N_Vector v, sunindextype *reals, sunindextype *integers)
{
  *reals = (sunindextype)of(v)->shared->layout->length;
  *integers = 2;
}

/* Entries without padding, to or from a plain array. */
static int buffer_size(N_Vector v, sunindextype *bytes)
{
  *bytes = length(v) * (sunindextype)sizeof(double);
  return 0;
}

static int buffer_copy(N_Vector v, double *buffer, int out)
{
  const sph_layout *layout = of(v)->shared->layout;
  if (of(v)->shared->lost || !buffer) return -1;
  for (int k = 0; k < layout->segments; k++) {
    const sph_segment *segment = &layout->segment[k];
    double *entries = data(v) + segment->offset;
    memcpy(out ? buffer : entries, out ? entries : buffer, (size_t)segment->n * sizeof *buffer);
    buffer += segment->n;
  }
  return 0;
}

static int buffer_pack(N_Vector v, void *buffer) { return buffer_copy(v, buffer, 1); }
static int buffer_unpack(N_Vector v, void *buffer) { return buffer_copy(v, buffer, 0); }

static void set_operations(N_Vector_Ops ops)
{
  ops->nvgetvectorid = identity;
  ops->nvclone = clone;
  ops->nvcloneempty = clone_empty;
  ops->nvdestroy = destroy;
  ops->nvspace = space;
  ops->nvgetarraypointer = sph_nvector_data;
  ops->nvgetlength = length;
  ops->nvlinearsum = linear_sum;
  ops->nvconst = constant;
  ops->nvprod = product;
  ops->nvdiv = quotient;
  ops->nvscale = scale;
  ops->nvabs = absolute;
  ops->nvinv = inverse;
  ops->nvaddconst = add_constant;
  ops->nvdotprod = ops->nvdotprodlocal = dot;
  ops->nvmaxnorm = ops->nvmaxnormlocal = largest_magnitude;
  ops->nvwrmsnorm = wrms;
  ops->nvwrmsnormmask = wrms_mask;
  ops->nvmin = ops->nvminlocal = least;
  ops->nvwl2norm = weighted_l2;
  ops->nvl1norm = ops->nvl1normlocal = l1;
  ops->nvcompare = compare;
  ops->nvinvtest = ops->nvinvtestlocal = inverse_test;
  ops->nvconstrmask = ops->nvconstrmasklocal = constraint_mask;
  ops->nvminquotient = ops->nvminquotientlocal = least_quotient;
  ops->nvwsqrsumlocal = weighted_squares;
  ops->nvwsqrsummasklocal = masked_squares;
  ops->nvlinearcombination = linear_combination;
  ops->nvscaleaddmulti = scale_add_multi;
  ops->nvdotprodmulti = dot_multi;
  ops->nvbufsize = buffer_size;
  ops->nvbufpack = buffer_pack;
  ops->nvbufunpack = buffer_unpack;
}

N_Vector sph_nvector_create(const sph_layout *layout, int threads, SUNContext context,
                            sph_error *error)
{
  N_Vector v = N_VNewEmpty(context);
  content *c = SPH_NEW(content, 1, "a vector", error);
  if (!v || !c) {
    sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a vector's header");
    if (v) N_VFreeEmpty(v);
    sph_memory_free(c);
    return NULL;
  }
  v->content = c;
  set_operations(v->ops);
  c->shared = shared_create(layout, threads, error);
  c->data = SPH_NEW(double, layout->length, "a vector", error);
  if (c->shared && c->data) return v;
  destroy(v);
  return NULL;
}
