/* process.h -- runs another program, without a shell. */
#ifndef SPH_PROCESS_H
#define SPH_PROCESS_H
#include <stddef.h>

enum { SPH_PROCESS_MISSING = -2 }; /* there is no such program */

/* Runs argv[0], looked for in PATH, in a directory; said[size] gets the beginning of what it
 * printed.  Its exit status, SPH_PROCESS_MISSING, or -1: it was killed or could not be started. */
typedef struct sph_process_stop {
  int (*is)(void *ctx); /* not 0: the program gets SIGTERM; NULL: never */
  void *ctx;
} sph_process_stop;

int sph_process_run(const char *directory, const char *const argv[], char *said, size_t size);
/* The same of a program that takes long: asks ten times a second whether it is to be stopped. */
int sph_process_run_until(const char *directory, const char *const argv[], char *said, size_t size,
                          const sph_process_stop *stop);

#endif
