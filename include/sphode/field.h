/* sphode/field.h -- the fields a particle has; one table (src/state/fields.def) names each once. */
#ifndef SPHODE_FIELD_H
#define SPHODE_FIELD_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_field_info {
  const char *name;   /* "position", "velocity", "density", "energy", "pressure", ... */
  const char *symbol; /* "x" */
  const char *unit; /* "m/s"; mass: "kg" in 3D, "kg/m" in 2D, "kg/m^2" in 1D: see sph_field_unit */
  int vector;       /* 1: dim components, 0: one */
  int integrated;   /* may be part of the ODE vector (fluids) */
  int saved;        /* written to snapshots */
} sph_field_info;

/* Field k = 0, 1, ...; NULL behind the last.  A group's own scalars besides: sph_group_field. */
SPH_API const sph_field_info *sph_field_get(int k);
/* Its number, or -1. */
SPH_API int sph_field_find(const char *name);

#ifdef __cplusplus
}
#endif
#endif
