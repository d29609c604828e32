#include <gsl/gsl_errno.h>
#include <pthread.h>

#include "gsl.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static gsl_error_handler_t *saved; /* guarded by lock */

void sph_gsl_begin(void)
{
  pthread_mutex_lock(&lock);
  saved = gsl_set_error_handler_off();
}

void sph_gsl_end(void)
{
  gsl_set_error_handler(saved);
  pthread_mutex_unlock(&lock);
}
