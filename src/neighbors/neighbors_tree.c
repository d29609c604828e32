/* The tree: a bounding volume hierarchy (Rubin & Whitted 1980; Bentley 1975).  Points are halved
 * along the longest side of the box around them until a block is left; nodes stand in the order of
 * a walk, each with the box around its points, so that a node too far is skipped with all below it
 * (Smits 1998).  The depth follows the number of points alone, whatever their spacing. */
#include <math.h>
#include <string.h>

#include "memory.h"
#include "searches.h"

enum { LEAF = 8 }; /* points: those of a block of targets */

typedef struct node {
  double lo[3], hi[3]; /* the least box around its points */
  int begin, end;      /* sorted places */
  int next;            /* the node behind all below this one */
} node;

typedef struct grown { /* one set */
  long nodes, points_room, nodes_room;
  node *node;     /* [nodes] in the order of the walk */
  sph_item *item; /* [points_room] */
} grown;

typedef struct trees {
  sph_neighbors_def def;
  grown set[SPH_SETS_MAX];
} trees;

/* ---- sort */

static int reserve(grown *g, long n, sph_error *error)
{
  if (n <= g->points_room && g->item) return SPH_OK;
  const size_t room = (size_t)n + (size_t)n / 8 + 16, leaves = room / LEAF + 1;
  int status = sph_memory_grow((void **)&g->item, 0, room, sizeof *g->item, "tree", error);
  if (!status)
    status = sph_memory_grow((void **)&g->node, 0, 2 * leaves, sizeof *g->node, "tree", error);
  if (status) return status;
  g->points_room = (long)room;
  g->nodes_room = 2 * (long)leaves;
  return SPH_OK;
}

/* Sets the box; returns its longest side. */
static int bound(int dim, const sph_item *item, node *n)
{
  int longest = 0;
  for (int d = 0; d < dim; d++) {
    n->lo[d] = INFINITY;
    n->hi[d] = -INFINITY;
  }
  for (int k = n->begin; k < n->end; k++)
    for (int d = 0; d < dim; d++) {
      const double x = item[k].x[d];
      n->lo[d] = x < n->lo[d] ? x : n->lo[d];
      n->hi[d] = x > n->hi[d] ? x : n->hi[d];
    }
  for (int d = 1; d < dim; d++)
    if (n->hi[d] - n->lo[d] > n->hi[longest] - n->lo[longest]) longest = d;
  return longest;
}

/* Nodes in the order of the walk: one is opened, then its first half, with all below it, then its
 * second half.  `open` holds second halves that wait. */
static void grow(int dim, grown *g, long n)
{
  enum { DEPTH = 64 };
  node open[DEPTH] = {{.end = (int)n}};
  int waiting = n > 0;
  g->nodes = 0;
  while (waiting) {
    node *here = &g->node[g->nodes++];
    *here = open[--waiting];
    const int longest = bound(dim, g->item, here), count = here->end - here->begin;
    if (count <= LEAF) {
      sph_neighbors_rank_sort(g->item + here->begin, count, longest);
      continue;
    }
    const int half = (count / 2 + LEAF - 1) / LEAF * LEAF; /* whole blocks */
    sph_neighbors_rank_split(g->item + here->begin, count, half, longest);
    open[waiting++] = (node){.begin = here->begin + half, .end = here->end};
    open[waiting++] = (node){.begin = here->begin, .end = here->begin + half};
  }
  for (long k = g->nodes - 1; k >= 0; k--) { /* the first node from k on that begins at its end */
    long next = k + 1;
    while (next < g->nodes && g->node[next].begin < g->node[k].end) next = g->node[next].next;
    g->node[k].next = (int)next;
  }
}

static int sort(void *ctx, int set, const sph_points *points, int *order, sph_error *error)
{
  trees *all = ctx;
  grown *g = &all->set[set];
  int status = reserve(g, points->n, error);
  if (status) return status;
  for (long i = 0; i < points->n; i++) {
    g->item[i].id = (int)i;
    for (int d = 0; d < all->def.dim; d++) g->item[i].x[d] = points->x[d][i];
  }
  grow(all->def.dim, g, points->n);
  for (long s = 0; s < points->n; s++) order[s] = g->item[s].id;
  return SPH_OK;
}

/* ---- near */

/* Squared distance of the boxes. */
static inline double apart2(int dim, const node *n, const double *lo, const double *hi)
{
  double sum = 0;
  for (int d = 0; d < dim; d++) {
    const double below = n->lo[d] - hi[d], above = lo[d] - n->hi[d];
    const double gap = below > above ? below : above;
    sum += gap > 0 ? gap * gap : 0;
  }
  return sum;
}

/* Is all of the node within reach of all of the box? */
static inline int whole(int dim, const node *n, const double *lo, const double *hi, double reach2)
{
  double sum = 0;
  for (int d = 0; d < dim; d++) {
    const double up = n->hi[d] - lo[d], down = hi[d] - n->lo[d], span = up > down ? up : down;
    sum += span * span;
  }
  return sum <= reach2;
}

static inline int walk(int dim, const grown *g, const double *lo, const double *hi, double reach2,
                       int max, sph_stretch *stretch)
{
  int n = 0;
  for (int k = 0; k < g->nodes;) {
    const node *here = &g->node[k];
    if (apart2(dim, here, lo, hi) > reach2)
      k = here->next;
    else if (here->end - here->begin <= LEAF || whole(dim, here, lo, hi, reach2)) {
      sph_stretch_add(stretch, &n, max, here->begin, here->end);
      k = here->next;
    } else
      k++;
  }
  return n;
}

static int near(const void *ctx, int set, const double *lo, const double *hi, double reach, int max,
                sph_stretch *stretch)
{
  const trees *all = ctx;
  const grown *g = &all->set[set];
  const double reach2 = reach * reach * (1 + 1e-12);
  return all->def.dim == 1   ? walk(1, g, lo, hi, reach2, max, stretch)
         : all->def.dim == 2 ? walk(2, g, lo, hi, reach2, max, stretch)
                             : walk(3, g, lo, hi, reach2, max, stretch);
}

/* ---- the search */

static double bytes(const void *ctx)
{
  const trees *all = ctx;
  double sum = sizeof *all;
  for (int s = 0; s < SPH_SETS_MAX; s++)
    sum += (double)sizeof(sph_item) * (double)all->set[s].points_room +
           (double)sizeof(node) * (double)all->set[s].nodes_room;
  return sum;
}

static void release(void *ctx)
{
  trees *all = ctx;
  for (int s = 0; s < SPH_SETS_MAX; s++) {
    sph_memory_free(all->set[s].node);
    sph_memory_free(all->set[s].item);
  }
  sph_memory_free(all);
}

int sph_neighbors_tree(const sph_neighbors_def *def, sph_search *search, sph_error *error)
{
  trees *all = SPH_NEW(trees, 1, "the tree of neighbours", error);
  if (!all) return SPH_ERR_MEMORY;
  all->def = *def;
  *search = (sph_search){"tree", sort, near, bytes, release, all};
  return SPH_OK;
}
