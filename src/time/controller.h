/* controller.h -- the next step size, from the errors of this step and those before. */
#ifndef SPH_CONTROLLER_H
#define SPH_CONTROLLER_H
#include "sphode/base.h"

typedef struct sph_controller {
  const char *name;
  double beta[3]; /* of the errors of this step and of the two accepted before */
  double alpha;   /* of the ratio of this step to the one accepted before */
  int limited;    /* its factor x becomes 1 + arctan(x - 1) (Soederlind & Wang 2006) */
} sph_controller;

/* Of the last two accepted steps. */
typedef struct sph_controller_past {
  double error[2]; /* over the tolerance */
  double h;        /* of the last one; 0: none */
} sph_controller_past;

/* By name; NULL: the name is unknown, recorded with the known ones. */
const sph_controller *sph_controller_find(const char *name, sph_error *error);
const char *sph_controller_name(int k); /* NULL behind the last */
/* Does it remember steps? */
int sph_controller_remembers(const sph_controller *controller);
void sph_controller_forget(sph_controller_past *past);
/* The step after one of size h with that error (over the tolerance, > 1: it is repeated), of a
 * scheme of that order with an embedded one of order - 1. */
double sph_controller_next(const sph_controller *controller, int order, double h, double error,
                           sph_controller_past *past);

#endif
