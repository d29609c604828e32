/* sphode/output.h -- what is written while a simulation runs.
 *
 * A built-in output and a user's own are the same struct.  While a callback runs, the simulation shows the state at
 * sph_sim_time(sim): dense output, so that no frame shortens a step. */
#ifndef SPHODE_OUTPUT_H
#define SPHODE_OUTPUT_H
#include "sphode/base.h"

#ifdef __cplusplus
extern "C" {
#endif

struct sph_sim;

typedef struct sph_output {
  const char *name;
  double
      interval; /* [s] between frames, from the start; 0: every step; INFINITY: start and end only */
  /* Each returns 0 or < 0 with the reason in error.  open: before the first frame; NULL is fine. */
  int (*open)(void *ctx, struct sph_sim *sim, sph_error *error);
  int (*frame)(void *ctx, struct sph_sim *sim, sph_error *error);
  int (*close)(void *ctx, struct sph_sim *sim,
               sph_error *error); /* after the last frame, also of a failed run */
  void *ctx;
  void (*free)(void *ctx); /* called once */
} sph_output;

#ifdef __cplusplus
}
#endif
#endif
