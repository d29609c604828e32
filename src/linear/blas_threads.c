#include "blas_threads.h"

#include <pthread.h>

/* There where the process has an OpenBLAS; no dependency on it. */
extern void openblas_set_num_threads(int threads) __attribute__((weak));
extern int openblas_get_num_threads(void) __attribute__((weak));

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int holders, before;

static int there(void) { return openblas_set_num_threads && openblas_get_num_threads; }

void sph_blas_threads_hold(void)
{
  if (!there()) return;
  pthread_mutex_lock(&lock);
  if (holders++ == 0) {
    before = openblas_get_num_threads();
    openblas_set_num_threads(1);
  }
  pthread_mutex_unlock(&lock);
}

void sph_blas_threads_release(void)
{
  if (!there()) return;
  pthread_mutex_lock(&lock);
  if (--holders == 0) openblas_set_num_threads(before);
  pthread_mutex_unlock(&lock);
}
