/* Grid, hash and tree on points of very different spacing: full right-hand sides with lists made
 * anew in each (search/.../rebuild) and with lists that stay (.../lists), million directed pairs
 * inside the support a second, and over the grid by turns. */
#include <math.h>
#include <sphode.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"

enum { REPEATS = 9, SEARCHES = 3 };
static const char *const searches[SEARCHES] = {"grid", "hash", "tree"};

/* Points with spacing 1 where they are dense. */
typedef struct places {
  const char *name;
  int dim;
  long n, room;
  double *x[3]; /* [room] */
  unsigned state;
} places;

static double uniform(places *p)
{
  p->state = p->state * 1664525u + 1013904223u;
  return (double)(p->state >> 8) / (1 << 24);
}

/* A cube, in 2D a square, of across^dim points around a place, each moved by up to jitter. */
static void add_cube(places *p, const double *at, long across, double spacing, double jitter)
{
  long n = 1;
  for (int d = 0; d < p->dim; d++) n *= across;
  for (long i = 0; i < n && p->n < p->room; i++, p->n++) {
    long place = i;
    for (int d = 0; d < p->dim; d++, place /= across)
      p->x[d][p->n] = at[d] + spacing * ((double)(place % across) - 0.5 * (double)across +
                                         jitter * (2 * uniform(p) - 1));
  }
}

static long across(const places *p, double share)
{
  return lround(pow(share * (double)p->room, 1.0 / p->dim) - 0.5);
}

/* Neighbours in space are no neighbours in memory, as after a long run. */
static void shuffle(places *p)
{
  for (long i = p->n - 1; i > 0; i--) {
    const long j = (long)(uniform(p) * (double)i);
    for (int d = 0; d < p->dim; d++) {
      const double x = p->x[d][i];
      p->x[d][i] = p->x[d][j];
      p->x[d][j] = x;
    }
  }
}

static void lattice(places *p)
{
  const double at[3] = {0.1, 0.2, 0.3};
  add_cube(p, at, across(p, 1), 1, 0.1);
}

static void developed(places *p)
{
  const double at[3] = {0.1, 0.2, 0.3};
  add_cube(p, at, across(p, 1), 1, 0.4);
  shuffle(p);
}

/* Half of the points in a body; around it spray that thins out, some of it very far away.  Golden
 * angles: none of it is as near to another as to be refused. */
static void spray(places *p)
{
  const double at[3] = {0.1, 0.2, 0.3};
  const long n = across(p, 0.5);
  add_cube(p, at, n, 1, 0.3);
  for (long first = p->n; p->n < p->room; p->n++) {
    const long k = p->n - first;
    const double share = (double)k / (double)(p->room - first),
                 angle = 2.399963229728653 * (double)k;
    const double far = (double)n * pow(k % 100 ? 30 : 1e6, share);
    const double z = p->dim == 3 ? 2 * fmod(0.618033988749895 * (double)k, 1) - 1 : 0;
    const double direction[3] = {sqrt(1 - z * z) * cos(angle), sqrt(1 - z * z) * sin(angle), z};
    for (int d = 0; d < p->dim; d++) p->x[d][p->n] = at[d] + far * direction[d];
  }
  shuffle(p);
}

/* Clusters in a background whose number density is a thousandth. */
static void contrast(places *p)
{
  const double zero[3] = {0}, spacing = p->dim == 3 ? 10 : 31.6;
  const long background = across(p, 0.5), heap = across(p, 0.5 / 8);
  const double size = spacing * (double)background;
  add_cube(p, zero, background, spacing, 0.4);
  for (int k = 0; k < 8; k++) {
    double at[3];
    for (int d = 0; d < 3; d++) at[d] = size * (uniform(p) - 0.5);
    add_cube(p, at, heap, 1, 0.3);
  }
  shuffle(p);
}

/* Droplets in a space ten thousand spacings wide. */
static void empty(places *p)
{
  while (p->n < p->room) {
    double at[3];
    for (int d = 0; d < 3; d++) at[d] = 1e4 * uniform(p);
    add_cube(p, at, p->dim == 3 ? 5 : 11, 1, 0.3);
  }
  shuffle(p);
}

static sph_sim *make(const places *p, const char *search)
{
  const double corner[3] = {0}, far[3] = {(double)p->n, 1, 1};
  sph_sim *sim = sph_sim_create(
      &(sph_sim_def){.dim = p->dim, .dx = 1, .h_over_dx = 1.5, .skin = -1, .search = search});
  sph_group *fluid = sph_group_box(sim, "fluid", corner, far, 1000);
  sph_group_set_eos(fluid, sph_eos_tait(1000, 10, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.02, 0));
  sph_sim_add_term(sim, sph_term_delta("molteni", 0.1));
  for (int d = 0; d < p->dim; d++) {
    double *x = sph_group_write(fluid, "position", d);
    for (long i = 0; x && i < p->n; i++) x[i] = p->x[d][i];
  }
  return sim;
}

/* Seconds of a right-hand side; of its pairs, too. */
static double seconds_of(sph_sim *sim, int rebuild, double *pairs)
{
  sph_sim_stats before, after;
  sph_group *fluid = sph_sim_group(sim, "fluid");
  double *x = sph_group_write(fluid, "position", 0);
  for (long i = 0; rebuild && x && i < sph_group_count(fluid); i++) x[i] += 1e-3;
  sph_sim_get_stats(sim, &before);
  const double begin = bench_thread_seconds();
  if (sph_sim_evaluate(sim)) bench_complain("%s", sph_sim_error(sim));
  const double seconds = bench_thread_seconds() - begin;
  sph_sim_get_stats(sim, &after);
  *pairs = after.pairs - before.pairs;
  return seconds;
}

static void measure(const places *p)
{
  sph_sim *sim[SEARCHES];
  for (int s = 0; s < SEARCHES; s++) sim[s] = make(p, searches[s]);
  for (int rebuild = 1; rebuild >= 0; rebuild--) {
    double rate[SEARCHES][REPEATS], ratio[SEARCHES][REPEATS];
    for (int k = -2; k < REPEATS; k++) {
      double seconds[SEARCHES], pairs;
      for (int s = 0; s < SEARCHES; s++) seconds[s] = seconds_of(sim[s], rebuild, &pairs);
      for (int s = 0; s < SEARCHES && k >= 0; s++) {
        rate[s][k] = pairs / seconds[s] / 1e6;
        ratio[s][k] = seconds[0] / seconds[s];
      }
    }
    for (int s = 0; s < SEARCHES; s++) {
      char name[80], baseline[80];
      const char *what = rebuild ? "rebuild" : "lists";
      snprintf(name, sizeof name, "search/%dd/%s/%s/%s", p->dim, p->name, searches[s], what);
      snprintf(baseline, sizeof baseline, "grid/%s", what);
      bench_report_over(name, "Mpairs/s", rate[s], REPEATS, s ? baseline : NULL,
                        s ? ratio[s] : NULL);
    }
  }
  for (int s = 0; s < SEARCHES; s++) sph_sim_free(sim[s]);
}

void bench_search(void)
{
  if (!bench_filtered()) return;
  static const struct {
    const char *name;
    void (*fill)(places *p);
  } kinds[] = {{"lattice", lattice},
               {"developed", developed},
               {"spray", spray},
               {"contrast", contrast},
               {"empty", empty}};
  enum { KINDS = sizeof kinds / sizeof *kinds };
  for (int k = 0; k < 2 * KINDS; k++) {
    places one = {.name = kinds[k % KINDS].name, .dim = k < KINDS ? 3 : 2}, *p = &one;
    int good = 1;
    char name[80];
    snprintf(name, sizeof name, "search/%dd/%s", p->dim, p->name);
    if (!bench_wanted(name)) continue;
    p->state = 1;
    p->room = bench_quick() ? 8000 : 64000;
    for (int d = 0; d < 3; d++) good &= !!(p->x[d] = malloc((size_t)p->room * sizeof(double)));
    if (good) kinds[k % KINDS].fill(p), measure(p);
    for (int d = 0; d < 3; d++) free(p->x[d]);
  }
}
