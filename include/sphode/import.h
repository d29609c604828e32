/* sphode/import.h -- particles of a file as the start of a group. */
#ifndef SPHODE_IMPORT_H
#define SPHODE_IMPORT_H
#include "sphode/group.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Adds the particles of a file to a group, before the run:
 *
 *   .csv            a line with names, and units in brackets or none, then a row a particle;
 *                   columns x (y, z), and where they are there velocity_x ..., density, mass,
 *                   energy; other fields (pressure, ...) are passed over, other columns refused
 *   .hdf, .hdf5     GADGET's layout, as snapshots of sphode: Coordinates, and Velocities, Density,
 *                   Masses (or MassTable of the header), InternalEnergy where they are there
 *   .vtu, .vtp      VTK's XML, as of `sphode export --vtu` and ParaView (ascii, binary, appended;
 *                   zlib): Points, and velocity, density, mass, energy at them, or by the names of
 *                   snapshots; other data are passed over.  Needs a library built with Expat
 *                   (SPH_ERR_UNBUILT)
 *
 * in SI units, or in those that stand there, as x [mm], which are converted; one of another
 * quantity is an error.  Without a mass it is rho0 dx^dim, without a
 * density rho0, without a velocity 0.  The energy (u) is taken by fluids whose equation of state
 * has one; other fields follow from these.  Positions need not be a lattice, but dx apart or so. */
typedef struct sph_import_def {
  const char *path;
  int part;    /* HDF5: PartType0, 1, ... */
  double rho0; /* [kg/m^3] */
} sph_import_def;

/* Failures stick to the simulation that the group belongs to. */
SPH_API void sph_import(sph_sim *sim, sph_group *group, const sph_import_def *def);

#ifdef __cplusplus
}
#endif
#endif
