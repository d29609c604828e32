/* clock.h */
#ifndef SPH_CLOCK_H
#define SPH_CLOCK_H

double sph_clock(void); /* wall time that never jumps [s] */

#endif
