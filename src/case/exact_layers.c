/* Two liquids at rest, one above the other: dp/dz = -rho g in each (exact_column.c), and p
 * continuous where they meet, so that the lower one is a column whose surface carries the weight
 * of the upper one. */
#include <math.h>
#include <stddef.h>

#include "exact.h"

int sph_exact_layers_column(const sph_exact_layers *layers, int upper, sph_exact_column *column,
                            sph_error *error)
{
  sph_exact_column top = {layers->upper, layers->surface, layers->p_surface, layers->g};
  double weight;
  if (!(isfinite(layers->meet) && layers->surface >= layers->meet))
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "layers: they meet at %g m; right is finite and not above the surface at "
                         "%g m",
                         layers->meet, layers->surface);
  int status = sph_exact_column_at(&top, 1, &layers->meet, NULL, &weight, error);
  if (status) return status;
  *column = upper ? top : (sph_exact_column){layers->lower, layers->meet, weight, layers->g};
  return SPH_OK;
}
