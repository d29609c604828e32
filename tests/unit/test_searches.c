/* Grid, hash, tree and a search of the user's own list the same pairs, on random sets that are hard
 * on one or another of them: as many as brute force finds, which is held to the definition
 * |x_i - x_j - k L| < reach.  SPHODE_TEST_QUICK=1: a quarter of the sets. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "memory.h"
#include "neighbors_data.h"
#include "searches.h"
#include "sphode/sim.h"

enum { SETS = 200, MOST = 320, FOUND = 27 * MOST };

typedef struct points {
  long n;
  double x[3][MOST];
} points;

static points both[2]; /* targets, sources */
static sph_neighbors_def def;

static double uniform(void)
{
  static uint64_t state = 7;
  state = state * 6364136223846793005u + 1442695040888963407u;
  return (double)(state >> 11) / 9007199254740992.0;
}

static long any(long n) { return (long)(uniform() * (double)n); }

/* ---- hostile sets; the reach is about 1 */

static void set_uniform(points *p, double size)
{
  for (int d = 0; d < 3; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] = size * uniform();
}

/* A few heaps, each ten times as dense as the one before. */
static void set_clusters(points *p, double size)
{
  double at[3] = {0}, width = size;
  for (long i = 0; i < p->n; i++) {
    if (i % 80 == 0)
      for (int d = 0; d < 3; d++) at[d] = size * uniform();
    if (i % 80 == 0) width /= 2.15;
    for (int d = 0; d < 3; d++) p->x[d][i] = at[d] + width * (uniform() - 0.5);
  }
}

static void set_flyers(points *p, double size)
{
  set_uniform(p, size);
  for (long i = 0; i < p->n; i += 1 + any(9))
    for (int d = 0; d < 3; d++) p->x[d][i] += size * pow(10, 10 * uniform()) * (uniform() - 0.5);
}

static void set_duplicates(points *p, double size)
{
  set_uniform(p, size);
  for (long i = 1; i < p->n; i++)
    for (int d = 0; d < 3 && i % 3; d++) p->x[d][i] = p->x[d][i - 1];
}

static void set_far(points *p, double size)
{
  const double far = pow(10, 1 + 11 * uniform());
  set_uniform(p, size);
  for (int d = 0; d < 3; d++)
    for (long i = 0; i < p->n; i++) p->x[d][i] += far * (double)(i % 2 ? d : -1);
}

static void set_flat(points *p, double size)
{
  const int d = (int)any(3);
  set_uniform(p, size);
  for (long i = 0; i < p->n; i++) p->x[d][i] = 0.5 * size;
}

/* Distances of exactly the reach, faces of cells. */
static void set_lattice(points *p, double size)
{
  for (int d = 0; d < 3; d++)
    for (long i = 0; i < p->n; i++)
      p->x[d][i] = 0.25 * (double)((d == 0 ? i : d == 1 ? i / 7 : i / 49) % 7);
  (void)size;
}

static void set_sparse(points *p, double size) { set_uniform(p, 1e4 * size); }

static void set_ordered(points *p, double size)
{
  for (int d = 0; d < 3; d++)
    for (long i = 0; i < p->n; i++)
      p->x[d][i] = size * (double)(d == 1 ? p->n - i : i) / (double)MOST;
}

static void fill(points *p)
{
  static void (*const kinds[])(points * p,
                               double size) = {set_uniform,    set_clusters, set_flyers,
                                               set_duplicates, set_far,      set_flat,
                                               set_lattice,    set_sparse,   set_ordered};
  static const long some[] = {0, 1, 2, 7, 8, 9};
  p->n = uniform() < 0.2 ? some[any(6)] : 10 + any(MOST - 10);
  kinds[any(sizeof kinds / sizeof *kinds)](p, 1 + 8 * uniform());
}

/* Boxes down to twice the reach; points may lie many of them away. */
static void choose(void)
{
  const double sizes[] = {0, 0.01, 0.3, 1, 50};
  def = (sph_neighbors_def){.dim = 1 + (int)any(3),
                            .reach = 0.8 + 0.4 * uniform(),
                            .dx = sizes[any(5)],
                            .lanes = 1 << any(4),
                            .threads = 1 + (int)any(2)};
  for (int d = 0; d < def.dim; d++) {
    def.periodic[d] = uniform() < 0.3;
    def.origin[d] = 3 * uniform() - 2;
    def.length[d] = def.reach * (uniform() < 0.5 ? 2 : 2 + 5 * uniform());
  }
  for (int k = 0; k < 2; k++) fill(&both[k]);
}

/* ---- a search of the user's own: along the first coordinate only */

typedef struct sorted_x {
  long n[SPH_SETS_MAX];
  double x[SPH_SETS_MAX][MOST];
  int broken; /* 1: an order that is none; 2, 3: stretches that are none; 4: a status */
  int freed;
} sorted_x;

static const double *column;

static int by_x(const void *a, const void *b)
{
  const int i = *(const int *)a, j = *(const int *)b;
  if (column[i] != column[j]) return column[i] > column[j] ? 1 : -1;
  return i - j;
}

static int own_sort(void *ctx, int set, const sph_points *p, int *order, sph_error *error)
{
  sorted_x *s = ctx;
  if (s->broken == 4) return sph_error_set(error, SPH_ERR_STATE, "not today");
  s->n[set] = p->n;
  column = p->x[0];
  for (int i = 0; i < p->n; i++) order[i] = i;
  qsort(order, (size_t)p->n, sizeof *order, by_x);
  for (long i = 0; i < p->n; i++) {
    assert_true(p->lo[0] <= p->x[0][i] && p->x[0][i] <= p->hi[0]);
    s->x[set][i] = p->x[0][order[i]];
  }
  if (s->broken == 1 && p->n > 1) order[0] = order[1];
  return SPH_OK;
}

static int own_near(const void *ctx, int set, const double *lo, const double *hi, double reach,
                    int max, sph_stretch *stretch)
{
  const sorted_x *s = ctx;
  int n = 0, begin = 0, end = (int)s->n[set];
  while (begin < end && s->x[set][begin] < lo[0] - reach) begin++;
  while (begin < end && s->x[set][end - 1] > hi[0] + reach) end--;
  for (int i = begin; i < end; i++) sph_stretch_add(stretch, &n, max, i, i + 1);
  if (s->broken == 2 && n) stretch[0].end = (int)s->n[set] + 1;
  if (s->broken == 3 && n) stretch[0].begin = stretch[0].end;
  return n;
}

static double own_bytes(const void *ctx) { return (double)sizeof *(const sorted_x *)ctx; }
static void own_free(void *ctx) { ((sorted_x *)ctx)->freed++; }

static sorted_x own_data;
static const sph_search own = {"along x", own_sort, own_near, own_bytes, own_free, &own_data};

/* ---- pairs */

static sph_neighbors *make(const char *search, const sph_search *by, sph_error *error)
{
  sph_neighbors_def d = def;
  d.search = search;
  d.own = by;
  sph_neighbors *nb = sph_neighbors_create(&d, error);
  for (int k = 0; k < 2; k++) {
    const double *const x[3] = {both[k].x[0], both[k].x[1], both[k].x[2]};
    sph_neighbors_sort(nb, k, both[k].n, x, error);
  }
  for (int k = 0; k < 2; k++) sph_neighbors_build(nb, 0, k, error);
  return nb;
}

/* Blocks, runs inside the set, no source twice in an image. */
static void check_runs(const sph_neighbors *nb, int source, const char *name)
{
  static char seen[SPH_IMAGES_MAX][MOST];
  const sph_list list = sph_neighbors_list(nb, 0, source);
  assert_int_equal(list.blocks, (both[0].n + def.lanes - 1) / def.lanes);
  for (long b = 0; b < list.blocks; b++) {
    memset(seen, 0, sizeof seen);
    for (long r = list.first[b]; r < list.first[b + 1]; r++) {
      const sph_run run = list.runs[r];
      if (!sph_run_count(run) || sph_run_start(run) + sph_run_count(run) > both[source].n)
        fail_msg("%s: a run of %ld from %ld", name, sph_run_count(run), sph_run_start(run));
      for (long s = sph_run_start(run); s < sph_run_start(run) + sph_run_count(run); s++)
        if (seen[sph_run_image(run)][s]++) fail_msg("%s: place %ld twice", name, s);
    }
  }
}

/* As many images of the pair as the definition has, give or take those at just the reach. */
static long images(long i, long j, int source, double r)
{
  double shift[3] = {0};
  long n = 0, span[3] = {0};
  for (int d = 0; d < def.dim; d++) {
    shift[d] = both[0].x[d][i] - both[source].x[d][j];
    span[d] = def.periodic[d];
    if (span[d]) shift[d] -= def.length[d] * round(shift[d] / def.length[d]);
  }
  for (long a = -span[0]; a <= span[0]; a++)
    for (long b = -span[1]; b <= span[1]; b++)
      for (long c = -span[2]; c <= span[2]; c++) {
        const double k[3] = {(double)a, (double)b, (double)c};
        double r2 = 0;
        for (int d = 0; d < def.dim; d++)
          r2 += (shift[d] + k[d] * def.length[d]) * (shift[d] + k[d] * def.length[d]);
        n += r2 < r * r;
      }
  return n;
}

/* What rounding of positions alone may move: those many boxes away. */
static double fuzz(int source, long i)
{
  double size = 0;
  for (int d = 0; d < def.dim; d++) {
    size = fmax(size, fabs(both[0].x[d][i]));
    for (long j = 0; def.periodic[d] && j < both[source].n; j++)
      size = fmax(size, fabs(both[source].x[d][j]));
  }
  return 1e-12 + 4e-16 * size;
}

static void check_definition(const sph_neighbors *nb, int source, long *pairs)
{
  for (long i = 0; i < both[0].n; i++) {
    const double f = fuzz(source, i);
    if (f > 0.1) continue; /* where it is depends on how it is wrapped */
    long least = 0, most = 0, n = sph_neighbors_find(nb, 0, source, i, 0, NULL, NULL);
    for (long j = 0; j < both[source].n; j++) {
      least += images(i, j, source, def.reach - f);
      most += images(i, j, source, def.reach + f);
    }
    if (source == 0) least--, most--; /* itself */
    if (n < least || n > most)
      fail_msg("brute force finds %ld neighbours of %ld; right is %ld .. %ld", n, i, least, most);
    *pairs += n;
  }
}

static void check_same(const sph_neighbors *a, const sph_neighbors *b, int source, const char *name)
{
  static long found[2][FOUND];
  static double far[2][FOUND];
  for (long i = 0; i < both[0].n; i++) {
    const long n = sph_neighbors_find(a, 0, source, i, FOUND, found[0], far[0]);
    const long m = sph_neighbors_find(b, 0, source, i, FOUND, found[1], far[1]);
    assert_true(n >= 0 && n <= FOUND);
    if (n != m)
      fail_msg("%s finds %ld neighbours of %ld in set %d, not %ld", name, m, i, source, n);
    for (long k = 0; k < n; k++)
      if (found[0][k] != found[1][k] || far[0][k] != far[1][k])
        fail_msg("%s: neighbour %ld of %ld is %ld, %.17g m away, not %ld, %.17g m", name, k, i,
                 found[1][k], far[1][k], found[0][k], far[0][k]);
  }
}

static void same_pairs(void **state)
{
  (void)state;
  static const char *const names[] = {"grid", "hash", "tree", NULL};
  const int sets = getenv("SPHODE_TEST_QUICK") ? SETS / 4 : SETS;
  long pairs = 0, freed = own_data.freed;
  for (int k = 0; k < sets; k++) {
    sph_error error = {0};
    choose();
    sph_neighbors *all = make("brute-force", NULL, &error);
    for (int source = 0; source < 2 && !error.status; source++)
      check_definition(all, source, &pairs);
    for (int m = 0; m < 4 && !error.status; m++) {
      const char *name = names[m] ? names[m] : own.name;
      sph_neighbors *nb = make(names[m], names[m] ? NULL : &own, &error);
      for (int source = 0; source < 2 && !error.status; source++) {
        check_runs(nb, source, name);
        check_same(all, nb, source, name);
      }
      sph_neighbors_free(nb);
    }
    if (error.status) fail_msg("set %d: %s", k, error.text);
    sph_neighbors_free(all);
  }
  assert_true(pairs > 1000L * sets);
  assert_int_equal(own_data.freed - freed, sets);
  print_message("# %d sets, %ld pairs\n", sets, pairs);
}

/* Coincident points stand in the order of their index; sorting is the same for any order of
 * evaluation and takes no memory once it has some. */
static void ties(void **state)
{
  (void)state;
  static const char *const names[] = {"grid", "hash", "tree"};
  for (int m = 0; m < 3; m++)
    for (int dim = 1; dim <= 3; dim++) {
      sph_error error = {0};
      def = (sph_neighbors_def){.dim = dim, .reach = 1, .lanes = 4};
      for (int k = 0; k < 2; k++) both[k].n = MOST;
      for (int d = 0; d < 3; d++)
        for (long i = 0; i < MOST; i++) both[0].x[d][i] = 0.3, both[1].x[d][i] = (double)(i % 5);
      sph_neighbors *nb = make(names[m], NULL, &error);
      const int *one = sph_neighbors_order(nb, 0), *five = sph_neighbors_order(nb, 1);
      for (int s = 0; s < MOST; s++) assert_int_equal(one[s], s);
      for (int s = 1; s < MOST; s++)
        assert_true(five[s] % 5 > five[s - 1] % 5 ||
                    (five[s] % 5 == five[s - 1] % 5 && five[s] > five[s - 1]));
      const double bytes = sph_neighbors_bytes(nb);
      for (int again = 0; again < 3; again++)
        for (int k = 0; k < 2; k++) {
          const double *const x[3] = {both[k].x[0], both[k].x[1], both[k].x[2]};
          assert_int_equal(sph_neighbors_sort(nb, k, both[k].n, x, &error), SPH_OK);
          assert_int_equal(sph_neighbors_build(nb, k, k, &error), SPH_OK);
          if (again) assert_true(sph_neighbors_bytes(nb) >= bytes);
        }
      sph_neighbors_free(nb);
    }
}

/* Ranks against qsort, for every length and middle place, with many ties. */
static void ranks(void **state)
{
  (void)state;
  static sph_item item[MOST], right[MOST];
  for (int n = 0; n < MOST; n += 1 + n / 8)
    for (int kinds = 1; kinds < 2000; kinds *= 3) {
      static double x[MOST];
      static int order[MOST];
      for (int i = 0; i < n; i++) {
        x[i] = (double)any(kinds);
        order[i] = i;
        item[i] = (sph_item){{0, x[i], 0}, i};
      }
      column = x;
      qsort(order, (size_t)n, sizeof *order, by_x);
      memcpy(right, item, sizeof item);
      const long middle = n ? any(n) : 0;
      sph_neighbors_rank_split(right, n, middle, 1);
      if (n) assert_int_equal(right[middle].id, order[middle]);
      for (long i = 0; i < n; i++)
        assert_true(i < middle    ? right[i].x[1] <= right[middle].x[1]
                    : i == middle ? 1
                                  : right[i].x[1] >= right[middle].x[1]);
      sph_neighbors_rank_sort(item, n, 1);
      for (int i = 0; i < n; i++) assert_int_equal(item[i].id, order[i]);
    }
}

/* What a search of the user's own does wrong is told. */
static void broken(void **state)
{
  (void)state;
  static const char *const says[] = {"", "no permutation", "stretches", "stretches", "not today"};
  def = (sph_neighbors_def){.dim = 2, .reach = 1, .lanes = 4};
  for (int k = 0; k < 2; k++) {
    both[k].n = 100;
    set_uniform(&both[k], 5);
  }
  for (int k = 0; k <= 4; k++) {
    sph_error error = {0};
    own_data.broken = k;
    sph_neighbors *nb = make(NULL, &own, &error);
    if (k == 0) assert_true(sph_neighbors_bytes(nb) > (double)sizeof own_data);
    assert_int_equal(error.status, k == 0 ? SPH_OK : k == 4 ? SPH_ERR_STATE : SPH_ERR_ARGUMENT);
    assert_non_null(strstr(error.text, says[k]));
    if (k) assert_non_null(strstr(error.text, "along x"));
    sph_neighbors_free(nb);
  }
  own_data.broken = 0;
  const sph_search lacking[] = {{.name = "half", .sort = own_sort},
                                {.name = "half", .near = own_near},
                                {.sort = own_sort, .near = own_near}};
  const char *const lacks[] = {"lacks near", "lacks sort", "lacks name"};
  for (int k = 0; k < 3; k++) {
    sph_error error = {0};
    sph_neighbors_def d = def;
    d.own = &lacking[k];
    assert_null(sph_neighbors_create(&d, &error));
    assert_non_null(strstr(error.text, lacks[k]));
  }
}

/* In a simulation: the accelerations of a jittered column are those with the grid, to rounding. */
static void simulation(void **state)
{
  (void)state;
  static double a[2][MOST];
  double most = 0;
  const int freed = own_data.freed;
  for (int k = 0; k < 2; k++) {
    sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 1, .own_search = k ? &own : NULL});
    sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){20, 15}, 1000);
    sph_group_set_eos(water, sph_eos_tait(1000, 100, 7));
    sph_group_jitter(water, 0.3, 1);
    double *rho = sph_group_write(water, "density", 0);
    for (int i = 0; rho && i < 300; i++) rho[i] += i % 7;
    sph_sim_add_term(sim, sph_term_continuity());
    sph_sim_add_term(sim, sph_term_pressure());
    if (sph_sim_evaluate(sim)) fail_msg("%s", sph_sim_error(sim));
    memcpy(a[k], sph_group_rate(water, "velocity", 0), 300 * sizeof(double));
    for (int s = 0; s < 300; s++) most = fmax(most, fabs(a[k][s]));
    sph_sim_free(sim);
  }
  assert_true(most > 1);
  for (int s = 0; s < 300; s++)
    if (!(fabs(a[1][s] - a[0][s]) <= 1e-13 * most))
      fail_msg("particle %d: %.17g, not %.17g", s, a[1][s], a[0][s]);
  assert_int_equal(own_data.freed - freed, 1);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 9, .dx = 1, .own_search = &own});
  assert_int_equal(sph_sim_status(sim), SPH_ERR_ARGUMENT);
  sph_sim_free(sim);
  assert_int_equal(own_data.freed - freed, 2);
}

static void names(void **state)
{
  (void)state;
  sph_error error = {0};
  int n = 0;
  for (; sph_neighbors_search_name(n); n++)
    assert_true(strlen(sph_neighbors_search_about(sph_neighbors_search_name(n))) > 20);
  assert_int_equal(n, 4);
  assert_null(sph_neighbors_search_about("oak"));
  assert_null(sph_neighbors_search_about(NULL));
  assert_null(sph_neighbors_search_name(-1));
  assert_null(
      sph_neighbors_create(&(sph_neighbors_def){.dim = 2, .reach = 1, .search = "gird"}, &error));
  assert_non_null(strstr(error.text, "did you mean 'grid'"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(same_pairs), cmocka_unit_test(ties),   cmocka_unit_test(ranks),
      cmocka_unit_test(simulation), cmocka_unit_test(broken), cmocka_unit_test(names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
