/* sphode/export.h -- snapshots as files that other tools read.
 *
 *   csv      snapshot_0000.csv, walls_0000.csv, ...: a line with names and units of the columns
 *            ("x [m],y [m],velocity_x [m/s],..."), then a row a particle; times.csv tells the time
 *            of each.  For gnuplot, pandas, spreadsheets
 *   vtu      snapshot_0000.vtu, walls_0000.vtu, ...: VTK's XML, particles as vertices, fields named
 *            with their units; snapshot.pvd, walls.pvd are the series with their times.  For
 *            ParaView, VisIt, VTK
 *   gadget   snapshot_0000.hdf5, ...: GADGET's HDF5 layout alone, PartType0 fluids and PartType1
 *            walls, with the header of the snapshot.  For yt, pynbody
 *   splash   snapshot_0000.txt, walls_0000.txt, ...: columns of text under the names that SPLASH
 *            knows, and the time; all digits (it drops the exponents of a CSV) */
#ifndef SPHODE_EXPORT_H
#define SPHODE_EXPORT_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_export_def {
  const char *path;      /* a snapshot, or a directory: all of its snapshots */
  const char *format;    /* "csv", "vtu", "gadget", "splash" */
  const char *directory; /* of the new files; made if need be */
  /* Names of fields with spaces or commas between them ("velocity density"), besides the position;
   * NULL: all.  A field that walls do not have is written for the fluids alone. */
  const char *fields;
  int single;            /* 1: numbers of single precision, half the size; 0: double */
  sph_left_out left_out; /* of a directory: of snapshots that cannot be read, or are missing between
                          * others */
} sph_export_def;

SPH_API const char *sph_export_format(int k); /* NULL behind the last */
/* Returns how many snapshots were exported, or < 0: a status.  Whole files or none. */
SPH_API int sph_export(const sph_export_def *def, sph_error *error);

#ifdef __cplusplus
}
#endif
#endif
