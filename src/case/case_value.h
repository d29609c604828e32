/* case_value.h -- numbers as expressions (muParser) with units, whose dimensions are checked. */
#ifndef SPH_CASE_VALUE_H
#define SPH_CASE_VALUE_H
#include "case_unit.h"
#include "sphode/base.h"

enum { SPH_CASE_VALUE_LENGTH = 1000 };

/* A name that expressions may use: a parameter, a coordinate. */
typedef struct sph_case_name {
  char *name;
  double value; /* SI */
  double power[SPH_CASE_BASES];
} sph_case_name;

typedef struct sph_case_value {
  double value;                 /* SI */
  double power[SPH_CASE_BASES]; /* of kg, m, s */
  int any;                      /* the value is 0: it fits any unit */
  int column;                   /* of a problem, from 0 */
  char problem[300];            /* what was found; what is right; "" without */
} sph_case_value;

/* Evaluates text with names[n]; problems (also values not finite, sums of metres and seconds)
 * are told in result and give SPH_ERR_PARSE. */
int sph_case_value_evaluate(const char *text, const sph_case_name *names, int n,
                            sph_case_value *result);
/* out[count], SI, at the points x[d][count] [m], called x, y, z, beside names[n]. */
int sph_case_value_field(const char *text, const sph_case_name *names, int n, int dim, long count,
                         const double *const x[], double *out, sph_case_value *result);
/* The unit of an expression in x, y, z at some point; not finite there is no problem. */
int sph_case_value_field_unit(const char *text, const sph_case_name *names, int n, int dim,
                              sph_case_value *result);

#endif
