/* case_value.h -- numbers as expressions (muParser) with units, whose dimensions are checked. */
#ifndef SPH_CASE_VALUE_H
#define SPH_CASE_VALUE_H
#include "case_table.h"
#include "si_unit.h"
#include "sphode/base.h"

enum { SPH_CASE_VALUE_LENGTH = 1000 };

/* A name that expressions may use: a parameter, a coordinate, in formulas of time a table. */
typedef struct sph_case_name {
  char *name;
  double value; /* SI; of a table: some value of it */
  double power[SPH_SI_BASES];
  sph_case_table *table; /* NULL: it is no table */
} sph_case_name;

typedef struct sph_case_value {
  double value;               /* SI */
  double power[SPH_SI_BASES]; /* of kg, m, s, K, mol */
  int any;                    /* the value is 0: it fits any unit */
  int column;                 /* of a problem, from 0 */
  char problem[300];          /* what was found; what is right; "" without */
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

/* An expression in x, y, z and the time t, translated once: evaluating it allocates nothing. */
typedef struct sph_case_formula sph_case_formula;
/* The unit of one at some point and time. */
int sph_case_value_formula_unit(const char *text, const sph_case_name *names, int n, int dim,
                                sph_case_value *result);
/* names and their tables are copied; NULL: the problem is told in result. */
sph_case_formula *sph_case_value_formula_create(const char *text, const sph_case_name *names, int n,
                                                int dim, sph_case_value *result);
/* out[count], SI, at x[d][count] [m], t [s]; SPH_ERR_ARGUMENT where a value is not finite. */
int sph_case_value_formula_at(sph_case_formula *formula, long count, const double *const x[],
                              double t, double *out);
/* The same, the first `fields` of its names being field[k][count]. */
int sph_case_value_formula_with(sph_case_formula *formula, long count, const double *const x[],
                                double t, int fields, const double *const field[], double *out);
void sph_case_value_formula_free(void *formula);

#endif
