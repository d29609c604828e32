/* integrator_table.h -- which integrators there are. */
#ifndef SPH_INTEGRATOR_TABLE_H
#define SPH_INTEGRATOR_TABLE_H
#include "integrator_data.h"
#include "sphode/integrator.h"
#include "sundials.h"

/* Row k = 0, 1, ... of the table; NULL behind the last.  The first rows are our own schemes. */
const char *sph_integrator_table_name(int k);
/* Row of that name (NULL: the default), or a status < 0, recorded: an unknown one, with the known
 * names and the nearest, or one that needs a newer SUNDIALS, with its version. */
int sph_integrator_table_find(const char *name, sph_error *error);
/* Row k of those that a newer SUNDIALS has; 0 behind the last. */
int sph_integrator_table_missing(int k, sph_integrator_missing *missing);
/* How row k steps; -1: a user's own scheme. */
const sph_stepper *sph_integrator_table_stepper(int k);
/* The scheme of row k if it is our own, else NULL. */
const sph_scheme *sph_integrator_table_scheme(int k);
/* What a scheme says of itself. */
sph_integrator_info sph_integrator_table_scheme_info(const sph_scheme *scheme);
/* The Butcher table of row k, owned by the caller; NULL: no explicit one, or out of memory. */
ARKodeButcherTable sph_integrator_table_butcher(int k);
/* The explicit and the implicit table of row k, owned by the caller: [2]; 0 and NULL: no such pair,
 * or out of memory. */
int sph_integrator_table_pair(int k, ARKodeButcherTable pair[2]);
/* Exponents of its step size controller, [3]; NULL: the integral one. */
const double *sph_integrator_table_control(int k);
/* What row k is; 0 if it is no row, or without memory for its Butcher table. */
int sph_integrator_table_info(int k, sph_integrator_info *info);
/* Is the last stage of that table the next step's first? */
int sph_integrator_table_fsal(const struct ARKodeButcherTableMem *table);

#endif
