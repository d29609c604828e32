/* case_warning.h -- warnings are found one after another, in files by subject. */
#ifndef SPH_CASE_WARNING_H
#define SPH_CASE_WARNING_H
#include "case_schema.h"

/* Warning number `wanted` of those that are found. */
typedef struct sph_case_finder {
  const sph_case *c;
  int wanted, found;
  char *text;
  size_t size;
} sph_case_finder;

/* One more, of the key of a node. */
void sph_case_warning_found(sph_case_finder *f, const sph_case_node *node, const char *format, ...)
    SPH_PRINTF(3, 4);

#endif
