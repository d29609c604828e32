/* relax.h -- relaxation (Ketcheson 2019): each step is made shorter or longer along itself, so that
 * a quantity that f conserves is conserved by the step, too.  SUNDIALS 6.6 and later. */
#ifndef SPH_RELAX_H
#define SPH_RELAX_H
#include "integrator_data.h"

/* Is def.relax right for that integrator?  Else recorded. */
int sph_relax_check(const sph_integrator_def *def, const sph_integrator_info *info,
                    sph_error *error);
/* An integrator of ARKODE relaxes from now on, if it->def says so.  0 or a status (recorded). */
int sph_relax_attach(sph_integrator *it);
/* Does this flag of ARKODE say that there is no such step?  A shorter one may do. */
int sph_relax_failed(int flag);

#endif
