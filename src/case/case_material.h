/* case_material.h -- equation of state, viscosity, conductivity and specific heat of a group. */
#ifndef SPH_CASE_MATERIAL_H
#define SPH_CASE_MATERIAL_H
#include "case_schema.h"
#include "sphode/group.h"

/* Checks what no key of a group alone can tell; a status, the reason in c->error. */
int sph_case_material_check(const sph_case *c);
/* Density [kg/m^3] of a checked group: its own or its material's. */
double sph_case_material_density(const sph_case_node *map);
/* Gives the group what its checked node tells; groups above it exist.  Failures stick to the
 * simulation. */
void sph_case_material_set(sph_sim *sim, sph_group *group, const sph_case_node *map);

#endif
