/* The searches by name. */
#include <math.h>
#include <string.h>

#include "searches.h"
#include "words.h"

static const struct {
  const char *name, *about;
  int (*make)(const sph_neighbors_def *def, sph_search *search, sph_error *error);
} table[] = {
    {"grid",
     "columns cut into fine cells, at most a few cells a point; sorted by counting: the quickest "
     "where points fill their space",
     sph_neighbors_grid},
    {"hash",
     "the same columns, but only those that hold points, found by a hash of their numbers; sorted "
     "along each: for spray, clusters and near-empty spaces",
     sph_neighbors_hash},
    {"tree",
     "boxes around halves of halves of the points (a bounding volume hierarchy), whatever their "
     "spacing",
     sph_neighbors_tree},
    {"brute-force", "all sources for all targets, in the order of grid: the reference",
     sph_neighbors_grid},
};
enum { ROWS = sizeof table / sizeof *table };

const char *sph_neighbors_search_name(int k) { return k >= 0 && k < ROWS ? table[k].name : NULL; }

static int find(const char *name)
{
  for (int k = 0; k < ROWS; k++)
    if (!strcmp(table[k].name, name)) return k;
  return -1;
}

const char *sph_neighbors_search_about(const char *name)
{
  int k = name ? find(name) : -1;
  return k >= 0 ? table[k].about : NULL;
}

int sph_neighbors_search_check(const char *name, const sph_search *own, sph_error *error)
{
  sph_words words = {.wanted = name};
  const char *lacks = !own ? NULL : !own->name ? "name" : !own->sort ? "sort" : "near";
  if (own && !(own->name && own->sort && own->near))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "a search of your own lacks %s; name, sort and near are required", lacks);
  if (!name || find(name) >= 0) return SPH_OK;
  for (int k = 0; k < ROWS; k++) sph_words_add(&words, table[k].name);
  return sph_error_set(error, SPH_ERR_ARGUMENT, "search \"%.40s\"; %sknown: %s", name,
                       words.nearest, words.known);
}

int sph_neighbors_search_make(const char *name, const sph_neighbors_def *def, sph_search *search,
                              sph_error *error)
{
  return table[name ? find(name) : 0].make(def, search, error);
}

/* 2 dx in 3D, 3 dx in 2D; not too many within reach. */
double sph_neighbors_search_column(const sph_neighbors_def *def)
{
  return fmax((def->dim == 3 ? 2 : 3) * def->dx, def->reach / 8);
}
