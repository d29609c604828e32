/* group_data.h -- the particles of one group and where each field of theirs lives. */
#ifndef SPH_GROUP_DATA_H
#define SPH_GROUP_DATA_H
#include "layout.h"
#include "sphode/boundary.h"
#include "sphode/eos.h"
#include "sphode/field.h"
#include "sphode/shape.h"
#include "sphode/term.h"

/* Fields, then the scalars that terms bring along (sphode/term.h). */
enum {
#define X(id, name, symbol, unit, vector, integrated, saved) SPH_##id,
#include "fields.def"
#undef X
  SPH_SCALAR,
  SPH_FIELDS = SPH_SCALAR + SPH_SCALARS_MAX
};

/* Which energy a group integrates; the field of each: sph_group_data_energy. */
enum sph_energy {
  SPH_ENERGY_DEFAULT, /* u for a thermal equation of state, else none */
  SPH_ENERGY_NONE,
  SPH_ENERGY_U,
  SPH_ENERGY_TOTAL,
  SPH_ENERGY_ENTROPY,
  SPH_ENERGY_TEMPERATURE
};

/* What a wall does, in the order of sph_boundary_name. */
enum sph_wall_model { SPH_MODEL_ADAMI, SPH_MODEL_DBC, SPH_MODEL_MIRROR };

/* An image of a fluid particle: reflected in planes, one after another, each of a mirror group. */
typedef struct sph_ghost {
  long parent; /* its number in its group */
  int group;   /* index of that group */
  int planes;
  struct {
    unsigned char group, plane; /* index of the mirror group, number in its boundary */
  } in[3];
} sph_ghost;

enum { SPH_NAME_MAX = 64 };

struct sph_group {
  struct sph_sim *sim; /* whose it is */
  char name[SPH_NAME_MAX];
  int wall;  /* 0: fluid */
  int index; /* in the simulation, also its set number in the neighbour search */
  int dim;
  long n, capacity;   /* capacity is a multiple of 8 */
  long first_id, *id; /* [capacity]; NULL: first_id + i */
  /* Walls: positions at displacement zero; ghosts of a mirror: the velocity that viscous terms see;
   * [capacity]; NULL for fluids. */
  double *start[3];
  /* A component lives either here, [capacity], or in the ODE vector at offset >= 0. */
  double *own[SPH_FIELDS][3];
  long offset[SPH_FIELDS][3];
  sph_eos eos; /* eos.name points to eos_name */
  char eos_name[SPH_NAME_MAX];
  sph_boundary boundary; /* walls; its name points to a built-in one; normals have length 1 */
  enum sph_wall_model model;
  sph_ghost *ghost; /* of a mirror, [capacity] */
  double placed[3]; /* displacement of a mirror at the last list build [m] */
  int has_eos, has_boundary;
  double viscosity;    /* dynamic [Pa s] */
  double repulsion;    /* of a wall (term_repulsion.h) */
  double conductivity; /* of heat [W/(m K)] */
  enum sph_energy energy;
  int summed;          /* density is a sum over neighbours, not integrated */
  int scalars;         /* integrated besides: fields SPH_SCALAR, ... */
  double rho0;         /* walls: density where no fluid tells it [kg/m^3] */
  sph_packing packing; /* of its last packed shape; particles 0: none */
  double packed_to;    /* what was wanted of it */
  int shapes;          /* that were filled by a lattice */
  int loose;           /* some particles were given, or moved off their lattice */
};

/* All pointers of one evaluation: made at its start from the vectors at hand, never stored. */
typedef struct sph_view {
  long n;
  double *x[3], *v[3], *rho, *m, *p, *c;
  double *u;      /* NULL unless the group has an energy */
  double *energy; /* the one that is integrated: u itself or another; NULL without one */
  double *T;      /* NULL where nobody needs it */
  double *s[SPH_SCALARS_MAX];
  /* Rates; NULL for walls, without ydot, and of what is not integrated.  du holds the heating until
   * the phase pairs makes it the rate of `energy`. */
  double *dx[3], *dv[3], *drho, *du, *ds[SPH_SCALARS_MAX];
} sph_view;

/* Field number of the energy that the group integrates, or -1. */
int sph_group_data_energy(const struct sph_group *group);
/* A wall whose surface has a temperature? */
int sph_group_data_isothermal(const struct sph_group *group);
/* An array of its own for a field that has none yet, zero. */
int sph_group_data_own(struct sph_group *group, int field, sph_error *error);
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
/* Number of particle i; all of them as an array, from then on kept: NULL: no memory, recorded. */
long sph_group_data_id(const struct sph_group *group, long i);
long *sph_group_data_ids(struct sph_group *group, sph_error *error);
double *sph_group_data_component(const struct sph_group *group, const double *y, int field, int c);
sph_view sph_group_data_view(const struct sph_group *group, const double *y, double *ydot);

#endif
