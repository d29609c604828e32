/* sphode/adjoint.h -- the gradient of a functional of a whole run, with respect to parameters and
 * to every entry of the start, in one run backwards:
 *
 *   J = phi(y(T)) + int_0^T r(t, y) dt
 *
 * of explicit Runge-Kutta runs with fixed steps (erk:..., dt_fixed of the simulation's integrator).
 * The adjoint is that of the scheme itself (Hager 2000; Sandu 2006): the gradient is that of the
 * numerical result, up to rounding, not an approximation of another one.
 *
 * A stage backwards costs about 180 right-hand sides (3D: 200), and for each parameter 2 to 11
 * more: 3 for a number of yours that body terms read, 7 for a viscosity.  Each costs 13 in
 * sphode/sensitivity.h: for more than 20 to 30 parameters, or the start, the adjoint is cheaper. */
#ifndef SPHODE_ADJOINT_H
#define SPHODE_ADJOINT_H
#include "sphode/group.h"
#include "sphode/sensitivity.h"
#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sph_adjoint sph_adjoint;

/* Callbacks see the simulation at a state of the run, as outputs do.  A gradient is added to the
 * arrays of sph_adjoint_gradient, which come as zeros.  A part is there with both of its functions,
 * or with neither. */
typedef struct sph_functional {
  double (*end)(void *ctx, sph_sim *sim); /* phi */
  void (*end_gradient)(void *ctx, sph_sim *sim, sph_adjoint *adjoint);
  double (*running)(void *ctx, sph_sim *sim); /* r, at sph_sim_time(sim) */
  void (*running_gradient)(void *ctx, sph_sim *sim, sph_adjoint *adjoint);
  void *ctx; /* borrowed */
} sph_functional;

typedef struct sph_adjoint_def {
  sph_functional functional;
  int n; /* parameters, as in sphode/sensitivity.h; 0: none, the start alone */
  const sph_sensitivity_parameter *parameters;
  /* States that are kept on the way, at most; between two of them the run is made again, and its
   * states are kept then: checkpoints + steps/checkpoints vectors in all.  0: the root of the
   * number of steps. */
  int checkpoints;
} sph_adjoint_def;

/* Of a simulation, which must outlive it and has neither events nor modifiers, tiles nor a phi of
 * your own.  NULL: the error is the simulation's. */
SPH_API sph_adjoint *sph_adjoint_create(sph_sim *sim, const sph_adjoint_def *def);
SPH_API void sph_adjoint_free(sph_adjoint *adjoint); /* NULL is fine */

/* Runs the simulation to t_end [s] and the adjoint back to where it began; the simulation is at
 * t_end then.  Called again, it goes on from there, with a functional of that run alone.  Outputs
 * are not written. */
SPH_API int sph_adjoint_run(sph_adjoint *adjoint, double t_end);

/* ... J alone, without its gradient: for line searches. */
SPH_API int sph_adjoint_evaluate(sph_adjoint *adjoint, double t_end);

SPH_API double sph_adjoint_value(const sph_adjoint *adjoint);            /* J */
SPH_API double sph_adjoint_parameter(const sph_adjoint *adjoint, int k); /* dJ/dtheta_k */
/* dJ/d(field at the start) of an integrated field of a fluid, [count]. */
SPH_API const double *sph_adjoint_start(const sph_adjoint *adjoint, const sph_group *group,
                                        const char *field, int component);

/* Inside a gradient: d(phi or r)/d(field), [count], of an integrated field or "pressure" of a
 * fluid; NULL: no such field. */
SPH_API double *sph_adjoint_gradient(sph_adjoint *adjoint, const sph_group *group,
                                     const char *field, int component);

#ifdef __cplusplus
}
#endif
#endif
