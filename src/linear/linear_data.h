/* linear_data.h -- what the methods of linear.h have in common. */
#ifndef SPH_LINEAR_DATA_H
#define SPH_LINEAR_DATA_H
#include "linear.h"

struct sph_linear {
  const struct sph_linear_method *method;
  const struct sph_linear_method *used; /* of the last solve: another one with "auto" */
  void *own;                            /* the method's */
  int threads;
  long pattern, values; /* of the matrix that was prepared last */
  int has_pattern, has_values;
  sph_linear_stats stats;
  char reason[200];
};

/* What is new in a matrix. */
enum sph_linear_change { SPH_LINEAR_VALUES, SPH_LINEAR_PATTERN };

/* A row of the table of methods.  SPH_RETRY comes with a reason (sph_linear_refuse). */
typedef struct sph_linear_method {
  const char *name;
  int kind;                                            /* the method's own */
  int (*create)(sph_linear *solver, sph_error *error); /* sets own */
  int (*prepare)(sph_linear *solver, const sph_csr *A, int change, sph_error *error);
  int (*solve)(sph_linear *solver, const sph_linear_task *task, sph_error *error);
  void (*free)(sph_linear *solver);                /* own may be NULL */
  int (*keep)(sph_linear *solver, sph_keep *keep); /* NULL: it remembers nothing but factors */
} sph_linear_method;

extern const sph_linear_method sph_linear_pcg_jacobi, sph_linear_ic0;
extern const sph_linear_method sph_linear_cholmod_supernodal, sph_linear_cholmod_simplicial;
extern const sph_linear_method sph_linear_klu, sph_linear_auto;

/* As sph_linear_create, of a method that need not stand in the table. */
sph_linear *sph_linear_create_method(const sph_linear_method *method, int threads,
                                     sph_error *error);

/* Writes down a reason; returns SPH_RETRY. */
int sph_linear_refuse(sph_linear *solver, const char *format, ...) SPH_PRINTF(2, 3);

#endif
