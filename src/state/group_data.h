/* group_data.h -- the particles of one group and where each field of theirs lives. */
#ifndef SPH_GROUP_DATA_H
#define SPH_GROUP_DATA_H
#include "layout.h"
#include "sphode/boundary.h"
#include "sphode/eos.h"
#include "sphode/field.h"

enum {
#define X(id, name, symbol, unit, vector, integrated, saved) SPH_##id,
#include "fields.def"
#undef X
  SPH_FIELDS
};

enum { SPH_NAME_MAX = 64 };

struct sph_group {
  struct sph_sim *sim; /* whose it is */
  char name[SPH_NAME_MAX];
  int wall;  /* 0: fluid */
  int index; /* in the simulation, also its set number in the neighbour search */
  int dim;
  long n, capacity; /* capacity is a multiple of 8 */
  long *id;         /* [capacity] */
  double *start[3]; /* walls: positions at displacement zero, [capacity]; NULL for fluids */
  /* A component lives either here, [capacity], or in the ODE vector at offset >= 0. */
  double *own[SPH_FIELDS][3];
  long offset[SPH_FIELDS][3];
  sph_eos eos; /* eos.name points to eos_name */
  char eos_name[SPH_NAME_MAX];
  sph_boundary boundary; /* walls; its name points to a built-in one */
  int has_eos, has_boundary;
  double viscosity;    /* dynamic [Pa s] */
  double conductivity; /* of heat [W/(m K)] */
  double rho0;         /* walls: density where no fluid tells it [kg/m^3] */
};

/* All pointers of one evaluation: made at its start from the vectors at hand, never stored. */
typedef struct sph_view {
  long n;
  double *x[3], *v[3], *rho, *u, *m, *p, *c; /* u: NULL unless thermal */
  double *dx[3], *dv[3], *drho, *du;         /* rates; NULL for walls and without ydot */
} sph_view;

/* Number of components of a field in dim dimensions. */
int sph_group_data_components(int dim, int field);
/* Room for `count` particles in all arrays of a group that has not been moved into the ODE
 * vector. */
int sph_group_data_reserve(struct sph_group *group, long count, sph_error *error);
void sph_group_data_free(struct sph_group *group); /* and itself; calls the users' free functions */
/* Is that field of this group integrated? */
int sph_group_data_integrated(const struct sph_group *group, int field);
/* Appends the group's segments to a layout that has room, and sets its offsets. */
void sph_group_data_place(struct sph_group *group, sph_layout *layout);
/* Moves its integrated fields into the ODE vector y: copies, then lets go of its own arrays. */
void sph_group_data_move(struct sph_group *group, double *y);
double *sph_group_data_component(const struct sph_group *group, const double *y, int field, int c);
sph_view sph_group_data_view(const struct sph_group *group, const double *y, double *ydot);

#endif
