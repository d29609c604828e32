/* integrator_arkode.h -- what all steppers of ARKODE share: one step a call, error weights, the
 * controller, stability, stop times, retries, dense output.
 *
 * A kind of stepper adds its creator: sph_integrator_arkode_create, then `memory` with its
 * right-hand sides, then sph_integrator_arkode_configure, then its tables; the other callbacks of
 * its sph_stepper are these. */
#ifndef SPH_INTEGRATOR_ARKODE_H
#define SPH_INTEGRATOR_ARKODE_H
#include "integrator_data.h"

typedef struct sph_integrator_arkode {
  void *memory; /* ARKODE's; made by the kind of stepper, freed here */
  const sph_sundials_calls *call;
  SUNContext context;
  sph_sundials_listener listener;
  sph_sundials_controller controller;
  int listening;
  int fresh; /* the next attempt starts anew, with the step size of its plan */
  sph_controller_past past;
  double resume; /* > 0: start anew with this step, which a stop time had cut short [s] */
  double ahead;  /* > 0: of a checkpoint, the step that ARKODE had set out to take [s] */
  double last;   /* ... and the one before it, as ARKODE has it [s] */
  /* Rates at the end of a step that are those of its last stage, whose state may differ from that
   * at the end in the last bits: they cannot be worked out again. */
  int fsal;       /* the table has such a last stage */
  N_Vector rates; /* where the last evaluation wrote to, borrowed; */
  double rates_t; /* its time [s] */
  N_Vector kept;  /* those of a checkpoint; NULL: none */
  int use_kept;   /* the next evaluation is that one */
  double trial;   /* the step that is tried [s] */
  double end;     /* of the last step, as ARKODE has it: relaxed ones may miss a stop time [s] */
  void *kind;     /* what the kind of stepper keeps, its own */
  char text[400]; /* what ARKODE said last */
} sph_integrator_arkode;

/* it->own, without its memory yet; NULL: recorded. */
sph_integrator_arkode *sph_integrator_arkode_create(sph_integrator *it, SUNContext context,
                                                    const sph_sundials_calls *call);
/* All that is no matter of tables: user data (the integrator), weights, dense output, controller.
 * A status: SPH_ERR_MEMORY also where `memory` is NULL. */
int sph_integrator_arkode_configure(sph_integrator *it);
void sph_integrator_arkode_free(sph_integrator *it);

/* All of f, for ARKODE. */
int sph_integrator_arkode_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *it);

/* A piece of it: sph_integrator_piece, for vectors that ARKODE cloned. */
int sph_integrator_arkode_piece(sph_integrator *it, int piece, double t, N_Vector y, N_Vector ydot);

/* As in sph_stepper. */
int sph_integrator_arkode_start(sph_integrator *it);
int sph_integrator_arkode_attempt(sph_integrator *it, sph_attempt *attempt, double t_stop);
int sph_integrator_arkode_reject(sph_integrator *it);
int sph_integrator_arkode_interpolate(sph_integrator *it, double t, N_Vector at);
int sph_integrator_arkode_keep(sph_integrator *it, sph_keep *keep);

#endif
