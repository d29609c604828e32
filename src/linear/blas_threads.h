/* blas_threads.h -- the BLAS's own threads: sums over them have other bits for each number. */
#ifndef SPH_BLAS_THREADS_H
#define SPH_BLAS_THREADS_H

/* Between the two an OpenBLAS has one thread, in the whole process; then as many as before.  Calls
 * may be nested and come from any thread.  Other BLAS are left as they are. */
void sph_blas_threads_hold(void);
void sph_blas_threads_release(void);

#endif
