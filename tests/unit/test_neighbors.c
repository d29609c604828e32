/* Neighbour lists against all pairs, counted here from the definition: |x_i - x_j - k L| < reach
 * for whole numbers k. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "clock.h"
#include "memory.h"
#include "neighbors_data.h"
#include "searches.h"

enum { MOST = 20200, SMALL = 343 };

typedef struct points {
  long n;
  double x[3][MOST];
} points;

typedef struct scene {
  const char *name;
  void (*place)(points *p, int dim);
  int exact; /* every source of a list is within reach of a target of its block */
} scene;

static points first_set, second_set;
static const double box = 7, reach = 2.2; /* dx = 1; points start in [0, box) */

static double uniform(void)
{
  static uint64_t state = 1;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11) / 9007199254740992.0;
}

static void place_uniform(points *p, int dim)
{
  p->n = SMALL - 3;
  for (int d = 0; d < dim; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] = box * uniform();
}

/* Points on the faces x = 0 and, in two directions, on edges and corners; distances of exactly 1,
 * 2, ... */
static void place_lattice(points *p, int dim)
{
  p->n = SMALL;
  for (long i = 0; i < p->n; i++) {
    p->x[0][i] = (double)(i % 7);
    p->x[1][i] = (double)(i / 7 % 7);
    p->x[2][i] = (double)(i / 49);
  }
  if (dim < 3) p->n = dim == 1 ? 7 : 49;
}

static void place_faces(points *p, int dim)
{
  place_uniform(p, dim);
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < dim; d++)
      if (uniform() < 0.5) p->x[d][i] = (uniform() < 0.5 ? 0 : box) + (i % 3 == 2 ? -1e-16 : 0);
}

static void place_one_cell(points *p, int dim)
{
  place_uniform(p, dim);
  for (int d = 0; d < dim; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] = 3 + 1e-3 * p->x[d][i];
}

static void place_coincident(points *p, int dim)
{
  p->n = SMALL;
  for (int d = 0; d < dim; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] = 1.1;
}

static void place_line(points *p, int dim)
{
  p->n = SMALL;
  for (int d = 0; d < dim; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] = d == 0 ? 0.3 * (double)i : 2;
}

static void place_flyers(points *p, int dim)
{
  place_uniform(p, dim);
  for (long i = 0; i < p->n; i += 4)
    for (int d = 0; d < dim; d++) p->x[d][i] += 1e6 * box * floor(3 * uniform() - 1);
}

static void place_far_box(points *p, int dim) /* two heaps far from each other and from zero */
{
  place_uniform(p, dim);
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < dim; d++) p->x[d][i] += 1e4 * box * (double)(1 + i % 2);
}

static void place_wrapped(points *p, int dim) /* many boxes away, in every direction */
{
  place_uniform(p, dim);
  for (long i = 0; i < p->n; i++)
    for (int d = 0; d < dim; d++) p->x[d][i] -= box * floor(15 * uniform() - 7.3);
}

static void place_none(points *p, int dim) { (void)dim, p->n = 0; }

static void place_single(points *p, int dim)
{
  p->n = 1;
  for (int d = 0; d < dim; d++) p->x[d][0] = 0;
}

static const scene scenes[] = {{"uniform", place_uniform, 1},       {"lattice", place_lattice, 1},
                               {"faces", place_faces, 1},           {"one cell", place_one_cell, 1},
                               {"coincident", place_coincident, 1}, {"line", place_line, 1},
                               {"flyers", place_flyers, 0},         {"far box", place_far_box, 0},
                               {"wrapped", place_wrapped, 1},       {"none", place_none, 1},
                               {"single", place_single, 1}};
enum { SCENES = sizeof scenes / sizeof *scenes };

static const double *const *columns_of(const points *p)
{
  static const double *x[2][3];
  int k = p == &second_set;
  for (int d = 0; d < 3; d++) x[k][d] = p->x[d];
  return x[k];
}

static sph_neighbors *create(sph_neighbors_def def)
{
  sph_error error = {0};
  sph_neighbors *nb = sph_neighbors_create(&def, &error);
  if (!nb) fail_msg("%s", error.text);
  return nb;
}

static void sort_and_build(sph_neighbors *nb)
{
  sph_error error = {0};
  sph_neighbors_sort(nb, 0, first_set.n, columns_of(&first_set), &error);
  sph_neighbors_sort(nb, 5, second_set.n, columns_of(&second_set), &error);
  sph_neighbors_build(nb, 0, 5, &error);
  sph_neighbors_build(nb, 0, 0, &error);
  if (error.status) fail_msg("%s", error.text);
}

/* How many images k of the pair are closer than r. */
static int true_images(const sph_neighbors_def *def, const points *t, long i, const points *s,
                       long j, double r)
{
  int n = 0, span[3];
  double apart[3] = {0};
  for (int d = 0; d < 3; d++) {
    span[d] = d < def->dim && def->periodic[d];
    if (d >= def->dim) continue;
    apart[d] = t->x[d][i] - s->x[d][j];
    if (span[d]) apart[d] -= def->length[d] * round(apart[d] / def->length[d]);
  }
  for (int a = -span[0]; a <= span[0]; a++)
    for (int b = -span[1]; b <= span[1]; b++)
      for (int c = -span[2]; c <= span[2]; c++) {
        double x = apart[0] + a * def->length[0], y = apart[1] + b * def->length[1],
               z = apart[2] + c * def->length[2];
        n += sqrt(x * x + y * y + z * z) < r;
      }
  return n;
}

/* Distance as a pair loop finds it: from wrapped positions and the shift of the image. */
static double listed_distance(const sph_neighbors *nb, const sph_neighbors_def *def, int source,
                              const points *s, long i, long j, int image)
{
  double r2 = 0;
  for (int d = 0; d < def->dim; d++) {
    double xi = first_set.x[d][i], xj = s->x[d][j];
    if (def->periodic[d]) {
      xi -= sph_neighbors_wrap(nb, 0, d)[i] * def->length[d];
      xj -= sph_neighbors_wrap(nb, source, d)[j] * def->length[d];
    }
    double step = xi - sph_neighbors_shifts(nb, NULL)[image][d] - xj;
    r2 += step * step;
  }
  return sqrt(r2);
}

/* Marks what block b lists: listed[image][source]; fails where something stands there twice. */
static void mark(const sph_neighbors *nb, int source, long sources, long b, char *listed)
{
  const sph_list list = sph_neighbors_list(nb, 0, source);
  int images;
  sph_neighbors_shifts(nb, &images);
  memset(listed, 0, (size_t)(images * sources));
  for (long r = list.first[b]; r < list.first[b + 1]; r++) {
    const sph_run run = list.runs[r];
    assert_true(sph_run_start(run) + sph_run_count(run) <= sources && sph_run_count(run) > 0);
    assert_true(sph_run_image(run) < images);
    for (long s = sph_run_start(run); s < sph_run_start(run) + sph_run_count(run); s++)
      if (listed[sph_run_image(run) * sources + s]++)
        fail_msg("block %ld lists place %ld twice", b, s);
  }
}

static void check_block(const sph_neighbors *nb, const sph_neighbors_def *def, int source,
                        const points *s, long b, int exact, const char *listed)
{
  const int *order = sph_neighbors_order(nb, 0), *sources = sph_neighbors_order(nb, source);
  int images;
  sph_neighbors_shifts(nb, &images);
  for (long k = 0; k < s->n; k++) {
    double nearest = INFINITY;
    for (long t = b * def->lanes; t < (b + 1) * def->lanes && t < first_set.n; t++) {
      int found = 0;
      for (int m = 0; m < images; m++) {
        if (!listed[m * s->n + k]) continue;
        double r = listed_distance(nb, def, source, s, order[t], sources[k], m);
        nearest = r < nearest ? r : nearest;
        found += r < def->reach * (1 + 1e-9);
      }
      int least = true_images(def, &first_set, order[t], s, sources[k], def->reach * (1 - 1e-9));
      int most = true_images(def, &first_set, order[t], s, sources[k], def->reach * (1 + 2e-9));
      if (found < least || found > most)
        fail_msg("%d images of pair %d, %d are listed; right is %d .. %d", found, order[t],
                 sources[k], least, most);
    }
    if (exact && nearest < INFINITY) assert_true(nearest < def->reach * (1 + 1e-9));
  }
}

static void check_list(const sph_neighbors *nb, const sph_neighbors_def *def, int source,
                       const points *s, int exact)
{
  static char listed[SPH_IMAGES_MAX * SMALL];
  const sph_list list = sph_neighbors_list(nb, 0, source);
  assert_int_equal(list.blocks, (first_set.n + def->lanes - 1) / def->lanes);
  for (long b = 0; b < list.blocks; b++) {
    mark(nb, source, s->n, b, listed);
    check_block(nb, def, source, s, b, exact, listed);
  }
}

static void check_scene(const scene *a, const scene *b, sph_neighbors_def def)
{
  a->place(&first_set, def.dim);
  b->place(&second_set, def.dim);
  sph_neighbors *nb = create(def);
  sort_and_build(nb);
  int exact = a->exact && b->exact && !def.search;
  check_list(nb, &def, 0, &first_set, exact);
  check_list(nb, &def, 5, &second_set, exact);
  sph_neighbors_free(nb);
}

static sph_neighbors_def define(int dim, int lanes)
{
  return (sph_neighbors_def){.dim = dim, .reach = reach, .dx = 1, .lanes = lanes};
}

static void open_space(void **state)
{
  (void)state;
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; k < SCENES; k++)
      for (int lanes = 1; lanes <= 8; lanes *= 2)
        check_scene(&scenes[k], &scenes[(k + 1 + lanes) % SCENES], define(dim, lanes));
}

/* Every combination of periodic directions, with points on faces, edges and corners and many
 * boxes away. */
static void periodic(void **state)
{
  (void)state;
  const int kinds[] = {0, 1, 2, 8, 4};
  for (int dim = 1; dim <= 3; dim++)
    for (int directions = 1; directions < 1 << dim; directions++)
      for (int k = 0; k < 5; k++) {
        sph_neighbors_def def = define(dim, 8 >> (k + directions) % 4);
        for (int d = 0; d < dim; d++) {
          def.periodic[d] = directions >> d & 1;
          def.length[d] = box;
          def.origin[d] = k == 0 ? -0.3 * d : 0;
        }
        check_scene(&scenes[kinds[k]], &scenes[0], def);
        if (k == 3) def.reach = box / 2; /* the box is exactly 2 reach */
        if (k == 3) check_scene(&scenes[8], &scenes[1], def);
      }
}

static void brute_force(void **state)
{
  (void)state;
  sph_neighbors_def def = define(2, 4);
  def.search = "brute-force";
  def.periodic[1] = 1;
  def.length[1] = box;
  check_scene(&scenes[0], &scenes[8], def);
}

static void cells_of_any_size(void **state)
{
  (void)state;
  const double sizes[] = {1e-4, 0.05, 2.2, 100, 0};
  for (int dim = 1; dim <= 3; dim++)
    for (int k = 0; k < 5; k++) {
      sph_neighbors_def def = define(dim, 8);
      def.dx = sizes[k];
      check_scene(&scenes[0], &scenes[1], def);
    }
}

static void place_many(points *p, long flyers)
{
  p->n = 20000;
  for (int d = 0; d < 3; d++) {
    for (long i = 0; i < p->n; i++) p->x[d][i] = 27 * uniform();
    for (long i = 0; i < flyers; i++) p->x[d][p->n + i] = 27e6 * (uniform() - 0.5);
  }
  p->n += flyers;
}

/* The same bytes from any number of threads. */
static void threads(void **state)
{
  (void)state;
  place_many(&first_set, 10);
  place_uniform(&second_set, 3);
  sph_neighbors *one = NULL;
  for (int n = 1; n <= 17; n += n < 5 ? 1 : 6) {
    sph_neighbors_def def = define(3, 4);
    def.threads = n;
    def.periodic[0] = 1;
    def.length[0] = 27;
    sph_neighbors *nb = create(def);
    sort_and_build(nb);
    if (!one) one = nb;
    const sph_list a = sph_neighbors_list(one, 0, 0), b = sph_neighbors_list(nb, 0, 0);
    assert_int_equal(a.blocks, b.blocks);
    assert_memory_equal(a.first, b.first, (size_t)(a.blocks + 1) * sizeof *a.first);
    assert_memory_equal(a.runs, b.runs, (size_t)a.first[a.blocks] * sizeof *a.runs);
    assert_memory_equal(sph_neighbors_order(one, 0), sph_neighbors_order(nb, 0),
                        (size_t)first_set.n * sizeof(int));
    if (nb != one) sph_neighbors_free(nb);
  }
  sph_neighbors_free(one);
}

static void flyers_cost_nothing(void **state)
{
  (void)state;
  const long flyers[] = {0, 1, 100};
  double bytes[3], size[3][3];
  for (int k = 0; k < 3; k++) {
    place_many(&first_set, flyers[k]);
    place_none(&second_set, 3);
    sph_neighbors *nb = create(define(3, 8));
    sort_and_build(nb);
    double begin = sph_clock();
    sort_and_build(nb);
    print_message("# %ld flyers of %ld points: %.2f ms, %.3g bytes\n", flyers[k], first_set.n,
                  1e3 * (sph_clock() - begin), bytes[k] = sph_neighbors_bytes(nb));
    memcpy(size[k], sph_neighbors_grid_of(&nb->search, 0)->size, sizeof size[k]);
    assert_memory_equal(size[k], size[0], sizeof size[0]); /* the cells are as fine as without */
    assert_true(bytes[k] < 1.02 * bytes[0]);
    sph_neighbors_free(nb);
  }
}

/* Two heaps of points far apart: the columns are as narrow as for one, and stand only there. */
static void space_between_costs_nothing(void **state)
{
  (void)state;
  for (double apart = 1e2; apart < 1e7; apart *= 1e2) {
    place_many(&first_set, 0);
    place_none(&second_set, 3);
    for (int d = 0; d < 3; d++)
      for (long i = 0; i < first_set.n; i += 2) first_set.x[d][i] += 27 * apart;
    sph_neighbors *nb = create(define(3, 8));
    sort_and_build(nb);
    const sph_grid *grid = sph_neighbors_grid_of(&nb->search, 0);
    assert_true(grid->size[0] == 2 && grid->size[2] <= 0.5);
    assert_true((double)grid->cells[0] * grid->size[0] < 2 * 27 + 2 * reach + 4);
    sph_neighbors_free(nb);
  }
}

/* Rebuilding takes no memory. */
static void steady_state(void **state)
{
  (void)state;
  place_many(&first_set, 0);
  place_uniform(&second_set, 3);
  sph_neighbors_def def = define(3, 8);
  def.threads = 2;
  sph_neighbors *nb = create(def);
  sort_and_build(nb);
  double bytes = sph_neighbors_bytes(nb);
  const sph_run *runs = sph_neighbors_list(nb, 0, 0).runs;
  sort_and_build(nb);
  assert_true(sph_neighbors_bytes(nb) == bytes);
  assert_ptr_equal(sph_neighbors_list(nb, 0, 0).runs, runs);
  sph_neighbors_free(nb);
}

/* Sorting is stable, a permutation, and ends the lists of the set. */
static void order(void **state)
{
  (void)state;
  place_coincident(&first_set, 2);
  place_uniform(&second_set, 2);
  sph_neighbors *nb = create(define(2, 2));
  sort_and_build(nb);
  for (int s = 0; s < SMALL; s++) assert_int_equal(sph_neighbors_order(nb, 0)[s], s);
  char seen[SMALL] = {0};
  for (long s = 0; s < second_set.n; s++) assert_false(seen[sph_neighbors_order(nb, 5)[s]]++);
  sph_error error = {0};
  sph_neighbors_sort(nb, 5, second_set.n, columns_of(&second_set), &error);
  assert_int_equal(sph_neighbors_list(nb, 0, 5).blocks, 0);
  assert_int_not_equal(sph_neighbors_list(nb, 0, 0).blocks, 0);
  assert_null(sph_neighbors_order(nb, 1));
  assert_int_equal(sph_neighbors_build(nb, 0, 1, &error), SPH_ERR_STATE);
  sph_neighbors_free(nb);
}

/* Runs longer than their count can hold are split. */
static void long_runs(void **state)
{
  (void)state;
  sph_runs runs = {0};
  const long begin = 5L << 16 | 3, count = 4L * SPH_RUN_LONGEST + 7; /* both halves of a start */
  sph_neighbors_runs_add(&runs, begin, count, SPH_IMAGES_MAX - 1);
  long next = begin;
  for (long r = 0; r < runs.n; r++) {
    assert_int_equal(sph_run_start(runs.run[r]), next);
    assert_int_equal(sph_run_image(runs.run[r]), SPH_IMAGES_MAX - 1);
    next += sph_run_count(runs.run[r]);
  }
  assert_int_equal(next, begin + count);
  assert_int_equal(runs.n, 5);
  sph_memory_free(runs.run);
}

/* Each block reaches all points, which stand next to each other: as few runs as there can be. */
static void runs_that_go_on(void **state)
{
  (void)state;
  static double x[10000];
  enum { N = sizeof x / sizeof *x };
  for (long i = 0; i < N; i++) x[i] = (double)i / N;
  for (int lanes = 1; lanes <= 8; lanes *= 2) {
    sph_error error = {0};
    const sph_neighbors_def def = {.dim = 1, .reach = 2, .dx = 1.0 / N, .lanes = lanes};
    sph_neighbors *nb = sph_neighbors_create(&def, &error);
    assert_int_equal(sph_neighbors_sort(nb, 0, N, (const double *const[]){x}, &error), SPH_OK);
    assert_int_equal(sph_neighbors_build(nb, 0, 0, &error), SPH_OK);
    const sph_list list = sph_neighbors_list(nb, 0, 0);
    for (long b = 0; b < list.blocks; b++) {
      long next = 0;
      for (long r = list.first[b]; r < list.first[b + 1]; r++) {
        assert_int_equal(sph_run_start(list.runs[r]), next);
        next += sph_run_count(list.runs[r]);
      }
      assert_int_equal(next, N);
      assert_true(list.first[b + 1] - list.first[b] <= N / (SPH_RUN_LONGEST - 256) + 1);
    }
    sph_neighbors_free(nb);
  }
}

static void find(void **state)
{
  (void)state;
  place_lattice(&first_set, 2);
  place_none(&second_set, 2);
  sph_neighbors_def def = define(2, 4);
  def.reach = 1.2;
  for (int d = 0; d < 2; d++) def.periodic[d] = 1, def.length[d] = box;
  sph_neighbors *nb = create(def);
  long index[8] = {0};
  double distance[8] = {0};
  assert_int_equal(sph_neighbors_find(nb, 0, 0, 0, 8, index, distance), SPH_ERR_STATE);
  sort_and_build(nb);
  const long right[] = {1, 6, 7, 42}; /* of the corner: beside, above, and through both faces */
  for (int built = 1; built >= 0; built--) {
    assert_int_equal(sph_neighbors_find(nb, 0, 0, 0, 8, index, distance), 4);
    for (int k = 0; k < 4; k++) assert_int_equal(index[k], right[k]);
    for (int k = 0; k < 4; k++) assert_true(distance[k] == 1);
    assert_int_equal(sph_neighbors_find(nb, 0, 5, 0, 8, index, distance), 0);
    assert_int_equal(sph_neighbors_find(nb, 0, 0, 48, 1, index, NULL), 4);
    assert_int_equal(index[0], 6);
    assert_int_equal(sph_neighbors_find(nb, 0, 0, 49, 1, index, NULL), SPH_ERR_ARGUMENT);
    sph_neighbors_sort(nb, 0, first_set.n, columns_of(&first_set), NULL); /* no list now */
  }
  sph_neighbors_free(nb);
}

/* Sorted positions in arrays of the caller's: the same lists, whatever the arrays hold before and
 * after. */
static void lent(void **state)
{
  (void)state;
  static double memory[3][MOST];
  double *const x[] = {memory[0], memory[1], memory[2]};
  place_uniform(&first_set, 3);
  place_uniform(&second_set, 3);
  sph_neighbors_def def = define(3, 4);
  for (int d = 0; d < 3; d++) def.periodic[d] = d != 1, def.length[d] = box;
  sph_neighbors *own = create(def), *borrows = create(def);
  sort_and_build(own);
  sort_and_build(borrows);
  const double own_bytes = sph_neighbors_bytes(borrows);
  for (int again = 0; again < 2; again++) {
    for (long i = 0; i < MOST; i++) memory[0][i] = memory[1][i] = memory[2][i] = NAN;
    sph_neighbors_sort_lend(borrows, 0, x);
    sort_and_build(borrows);
    for (long i = 0; i < MOST; i++) memory[0][i] = memory[1][i] = memory[2][i] = NAN;
    const sph_list a = sph_neighbors_list(own, 0, 0), b = sph_neighbors_list(borrows, 0, 0);
    assert_int_equal(a.first[a.blocks], b.first[b.blocks]);
    assert_memory_equal(a.runs, b.runs, (size_t)a.first[a.blocks] * sizeof *a.runs);
  }
  assert_true(sph_neighbors_bytes(borrows) < own_bytes - 24.0 * (double)first_set.n);
  assert_int_equal(sph_neighbors_find(borrows, 0, 5, 0, 0, NULL, NULL), SPH_ERR_STATE);
  assert_int_equal(sph_neighbors_find(borrows, 5, 0, 0, 0, NULL, NULL), SPH_ERR_STATE);
  assert_true(sph_neighbors_find(borrows, 5, 5, 0, 0, NULL, NULL) > 0);
  sph_neighbors_free(own);
  sph_neighbors_free(borrows);
}

static void rejected(sph_neighbors_def def, const char *text)
{
  sph_error error = {0};
  assert_null(sph_neighbors_create(&def, &error));
  assert_int_equal(error.status, SPH_ERR_ARGUMENT);
  if (!strstr(error.text, text)) fail_msg("\"%s\" lacks \"%s\"", error.text, text);
}

static void bad_arguments(void **state)
{
  (void)state;
  sph_neighbors_def def = define(3, 8);
  def.periodic[1] = 1;
  def.length[1] = 4.3;
  rejected(def, "4.3");
  rejected(def, "4.4");
  rejected((sph_neighbors_def){.dim = 4, .reach = 1}, "dim = 4");
  rejected((sph_neighbors_def){.dim = 2}, "reach = 0");
  rejected((sph_neighbors_def){.dim = 2, .reach = NAN}, "nan");
  rejected((sph_neighbors_def){.dim = 2, .reach = 1, .dx = -1}, "dx = -1");
  rejected((sph_neighbors_def){.dim = 2, .reach = 1, .lanes = 3}, "lanes = 3");
  rejected((sph_neighbors_def){.dim = 2, .reach = 1, .threads = -1}, "threads = -1");
  rejected((sph_neighbors_def){.dim = 2, .reach = 1, .search = "oak"}, "brute-force");
}

static void not_finite(void **state)
{
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY, 1e300};
  for (int periodic_too = 0; periodic_too < 2; periodic_too++)
    for (int k = 0; k < 4; k++) {
      sph_neighbors_def def = define(2, 8);
      def.periodic[1] = periodic_too;
      def.length[1] = box;
      place_uniform(&first_set, 2);
      first_set.x[1][123] = bad[k];
      sph_neighbors *nb = create(def);
      sph_error error = {0};
      assert_int_equal(sph_neighbors_sort(nb, 0, first_set.n, columns_of(&first_set), &error),
                       SPH_RETRY);
      assert_non_null(strstr(error.text, "coordinate 1 of point 123"));
      assert_int_equal(sph_neighbors_list(nb, 0, 0).blocks, 0);
      sph_neighbors_free(nb);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(open_space),
      cmocka_unit_test(periodic),
      cmocka_unit_test(brute_force),
      cmocka_unit_test(cells_of_any_size),
      cmocka_unit_test(threads),
      cmocka_unit_test(flyers_cost_nothing),
      cmocka_unit_test(space_between_costs_nothing),
      cmocka_unit_test(steady_state),
      cmocka_unit_test(order),
      cmocka_unit_test(long_runs),
      cmocka_unit_test(runs_that_go_on),
      cmocka_unit_test(find),
      cmocka_unit_test(lent),
      cmocka_unit_test(bad_arguments),
      cmocka_unit_test(not_finite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
