/* searches.h -- the built-in searches, and what two of them sort with. */
#ifndef SPH_SEARCHES_H
#define SPH_SEARCHES_H
#include "sphode/neighbors.h"

/* Each fills *search, whose ctx is then owned by it; def is complete, and copied.  The status is
 * recorded in error. */
int sph_neighbors_grid(const sph_neighbors_def *def, sph_search *search, sph_error *error);
int sph_neighbors_hash(const sph_neighbors_def *def, sph_search *search, sph_error *error);
int sph_neighbors_tree(const sph_neighbors_def *def, sph_search *search, sph_error *error);

/* The one of that name, "brute-force" being the grid. */
int sph_neighbors_search_make(const char *name, const sph_neighbors_def *def, sph_search *search,
                              sph_error *error);
/* Unknown names, a search of the user's own that lacks something: SPH_ERR_ARGUMENT.  Either may be
 * NULL. */
int sph_neighbors_search_check(const char *name, const sph_search *own, sph_error *error);

/* Width of the columns of grid and hash in direction d < dim - 1 [m]. */
double sph_neighbors_search_column(const sph_neighbors_def *def);

/* Cells of one set; the last coordinate is cut into fine cells, the others into columns; cell
 * numbers run fastest along the fine axis, so that a stretch of a column is one stretch of the
 * sorted order. */
typedef struct sph_grid {
  long cells[3];          /* per direction; 1 for d >= dim */
  double origin[3];       /* lower corner [m] */
  double size[3];         /* of a cell [m] */
  double inverse[3];      /* 1/size [1/m] */
  double rounding[3];     /* points may lie this far outside of their cell [m] */
  double cut[3], skip[3]; /* cut .. cut + skip, between two heaps of points, takes no cells [m] */
  int *start;             /* [cells + 1] first sorted place of each cell */
  int *cell;              /* [room] of point i, not sorted */
  int *heaped;            /* [room] points, those of some cells together; NULL: one thread */
  long start_room, room;
} sph_grid;

/* Of a search that sph_neighbors_grid made. */
const sph_grid *sph_neighbors_grid_of(const sph_search *search, int set);

/* A point on its way to its place. */
typedef struct sph_item {
  double x[3];
  int id;
} sph_item;

/* Items in the order of coordinate d, ties by id, all of them; or so that item `middle` is in its
 * place, none before it is greater, and none behind it less. */
void sph_neighbors_rank_sort(sph_item *item, long n, int d);
void sph_neighbors_rank_split(sph_item *item, long n, long middle, int d);

#endif
