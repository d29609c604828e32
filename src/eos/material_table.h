/* material_table.h -- what is wrong with a preset that could not be made. */
#ifndef SPH_MATERIAL_TABLE_H
#define SPH_MATERIAL_TABLE_H
#include "sphode/material.h"

/* Records why a material has no equation of state: an unknown preset, or its c0. */
int sph_material_explain(const sph_material *material, sph_error *error);

#endif
