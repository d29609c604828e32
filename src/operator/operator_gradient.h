/* operator_gradient.h -- first derivatives of one or more fields at a place, in any form. */
#ifndef SPH_OPERATOR_GRADIENT_H
#define SPH_OPERATOR_GRADIENT_H
#include "operator_data.h"

/* What becomes of the derivatives G[component][direction] at place i. */
typedef void sph_gradient_use(int dim, const double G[][3], long i, double *const out[]);

typedef struct sph_gradient_call {
  const char *what, *form;    /* "divergence", "corrected" */
  const char *field, *result; /* names of the arguments */
  int components, results;    /* at most 3; arrays written */
  const double *const *f;     /* [components] */
  double *const *out;         /* [results] */
  sph_gradient_use *use;
} sph_gradient_call;

int sph_operator_gradient_call(sph_operator *op, const sph_gradient_call *call, sph_error *error);

/* M_i = sum_j V_j (x_j - x_i) (x) grad_i W_ij = -sum_j V_j r_ij (x) r_ij F_ij, [dim][dim]. */
void sph_operator_gradient_matrix(int dim, const sph_row *row, double M[9]);
/* Corrected gradient of f at a point; 1: M_i is singular. */
int sph_operator_gradient_corrected(int dim, const sph_row *row, const double *f, double *gradient);

#endif
