/* sphode/material.h -- a material: an equation of state, viscosity and conductivity of heat in one,
 * and presets with the sources of their constants; docs/theory.md, Materials. */
#ifndef SPHODE_MATERIAL_H
#define SPHODE_MATERIAL_H
#include "sphode/eos.h"
#include "sphode/group.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_material {
  const char *name;    /* a preset's or the user's own; borrowed */
  sph_eos eos;         /* eos.rho0: the density [kg/m^3] it usually starts with */
  double viscosity;    /* dynamic [Pa s] */
  double conductivity; /* of heat [W/(m K)] */
  const char *source;  /* where the constants come from; may be NULL */
} sph_material;

/* A preset by its name.  c0: the numerical sound speed [m/s] of a weakly compressible one, about
 * ten times the largest speed; 0: the physical one.  An unknown name, or a c0 where it has no
 * place: refused where it is attached, with what would be right. */
SPH_API sph_material sph_material_preset(const char *name, double c0);

/* Names of the presets, NULL at the end of the list, and one line about each; NULL for an unknown
 * name. */
SPH_API const char *sph_material_name(int k);
SPH_API const char *sph_material_about(const char *name);

/* Gives a group the equation of state, viscosity and conductivity of a material, before the run. */
SPH_API void sph_group_set_material(sph_group *group, sph_material material);

#ifdef __cplusplus
}
#endif
#endif
