/* gsl.h -- GSL's error handler is global and aborts: what may meet an error is called between
 * these, one thread at a time.  Not around functions of a user, who may call GSL themselves. */
#ifndef SPH_GSL_H
#define SPH_GSL_H

void sph_gsl_begin(void); /* handler off */
void sph_gsl_end(void);   /* and back */

#endif
