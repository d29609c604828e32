#include "shape_lattice.h"

#include <stdio.h>
#include <string.h>

#include "sphode/shape.h"

/* Sides such that cell volume/points = 1: hexagonal, a = (4/3)^(1/4), rows a sqrt(3)/2 apart; bcc,
 * 2^(1/3); fcc, 4^(1/3); hcp, a = 2^(1/6), layers a sqrt(2/3) apart.  Points stand off the sides of
 * the cell, as far from the lower as from the upper ones. */
static const sph_shape_lattice lattices[] = {
    {"square", 2, 1, {1, 1, 1}, {{0.5, 0.5, 0.5}}},
    {"hexagonal",
     2,
     2,
     {1.0745699318235418, 1.8612097182041991, 1},
     {{0.25, 0.25, 0.5}, {0.75, 0.75, 0.5}}},
    {"cubic", 3, 1, {1, 1, 1}, {{0.5, 0.5, 0.5}}},
    {"bcc",
     3,
     2,
     {1.2599210498948732, 1.2599210498948732, 1.2599210498948732},
     {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}}},
    {"fcc",
     3,
     4,
     {1.5874010519681994, 1.5874010519681994, 1.5874010519681994},
     {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.25}, {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}}},
    {"hcp",
     3,
     4,
     {1.1224620483093730, 1.9441612972396656, 1.8329728493314703},
     {{0.25, 1. / 6, 0.25}, {0.75, 2. / 3, 0.25}, {0.75, 1. / 3, 0.75}, {0.25, 5. / 6, 0.75}}},
};
enum { LATTICES = sizeof lattices / sizeof *lattices };

const char *sph_shape_lattice_name(int k)
{
  return k >= 0 && k < LATTICES ? lattices[k].name : NULL;
}

int sph_shape_lattice_dim(const char *name)
{
  for (int k = 0; name && k < LATTICES; k++)
    if (!strcmp(name, lattices[k].name)) return lattices[k].dim;
  return 0;
}

int sph_shape_lattice_cell(const char *name, double *side)
{
  for (int k = 0; name && k < LATTICES; k++)
    for (int d = 0; d < 3 && !strcmp(name, lattices[k].name); d++) side[d] = lattices[k].cell[d];
  return sph_shape_lattice_dim(name) > 0;
}

const sph_shape_lattice *sph_shape_lattice_find(const char *name, int dim, sph_error *error)
{
  char known[80] = "";
  if (!name || dim == 1) name = dim < 3 ? "square" : "cubic";
  for (int k = 0; k < LATTICES; k++) {
    const int fits = lattices[k].dim == dim || (dim == 1 && k == 0);
    if (fits && !strcmp(name, lattices[k].name)) return &lattices[k];
    const size_t n = strlen(known);
    if (fits) snprintf(known + n, sizeof known - n, "%s%s", n ? ", " : "", lattices[k].name);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "lattice '%.40s'; in %d dimensions known are %s", name,
                dim, known);
  return NULL;
}
