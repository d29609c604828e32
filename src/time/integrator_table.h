/* integrator_table.h -- the table of integrators. */
#ifndef SPH_INTEGRATOR_TABLE_H
#define SPH_INTEGRATOR_TABLE_H
#include "sphode/integrator.h"
#include "sundials.h"

struct sph_scheme;

typedef struct sph_method {
  char name[64];                  /* "erk:bogacki-shampine-4-2-3" */
  char table[64];                 /* ARKODE's name of the Butcher table; "" for our own schemes */
  int order, stages, evaluations; /* right-hand sides a step: first same as last counts once */
  int fsal, error_control;
  double stability; /* S: dt <= S h/(c + |v|) */
  const struct sph_scheme *scheme;
} sph_method;

/* The method of that name (NULL: the default); unknown: recorded with the known ones. */
int sph_integrator_table_find(const char *name, sph_method *method, sph_error *error);

#endif
