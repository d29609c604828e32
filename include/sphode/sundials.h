/* sphode/sundials.h -- for people who drive ARKODE, CVODE or another SUNDIALS solver themselves.
 *
 * The only public header with SUNDIALS types; compile with pkg-config --cflags --libs
 * sphode-sundials.  A simulation is then a system of ODEs: the vector of its state and its
 * right-hand side. */
#ifndef SPHODE_SUNDIALS_H
#define SPHODE_SUNDIALS_H
#include <sundials/sundials_nvector.h>

#include "sphode/sim.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The state: makes the simulation ready for its first evaluation (then no groups or terms are added
 * any more).  Owned by the simulation, as is the SUNContext in it; clone it for vectors of your
 * own, free those before the simulation.  A group's array lies in all of them where it lies in this
 * one: at sph_group_read(group, field, component) - N_VGetArrayPointer(this).  NULL after a
 * failure. */
SPH_API N_Vector sph_sim_vector(sph_sim *sim);

/* Takes (t, y) for the state of the simulation, after a solver of your own has come there: fields,
 * sph_sim_time and outputs then show it, and sph_sim_run goes on from it.  y: that of
 * sph_sim_vector, or a clone, copied.  A status. */
SPH_API int sph_sim_set_vector(sph_sim *sim, double t, N_Vector y);

/* Solvers of plain arrays (GSL, PETSc, your own): N_VBufPack(y, array) copies the N_VGetLength(y)
 * entries of a vector, without padding, to an array, N_VBufUnpack(y, array) back from it. */

/* f(t, y), an ARKRhsFn and CVRhsFn with the simulation as user data: 0, > 0 where y is not
 * admissible (try a smaller step), < 0 after a failure (sph_sim_error tells it). */
SPH_API int sph_sim_rhs(double t, N_Vector y, N_Vector ydot, void *sim);

/* Its parts, for ARKStepCreate (explicit and implicit) and MRIStepCreate (explicit: the slow part,
 * and fast): f is their sum.  Which term belongs to which part: sph_sim_set_part; all are explicit
 * at first.  An evaluation costs what its terms need, none at all where no term is of that part;
 * the explicit part checks what f checks. */
SPH_API int sph_sim_rhs_explicit(double t, N_Vector y, N_Vector ydot, void *sim);
SPH_API int sph_sim_rhs_implicit(double t, N_Vector y, N_Vector ydot, void *sim);
SPH_API int sph_sim_rhs_fast(double t, N_Vector y, N_Vector ydot, void *sim);

/* Solves z = known + gamma f_implicit(t, z), gamma > 0, a stage of a scheme of your own: linear
 * systems with the matrices of the implicit terms, at the positions that `known` has.  z comes as
 * a guess; tolerance: of the error of z in the norm of sph_sim_weights.  0, > 0 where no solution
 * was found or a number of `known` or z is not finite (try a smaller step), < 0 after a failure. */
SPH_API int sph_sim_solve(sph_sim *sim, double t, double gamma, double tolerance, N_Vector known,
                          N_Vector z);

/* Why the last of these calls that returned > 0 did so, "12 particles ..."; "" where none has since
 * the last step of the simulation's own.  Lives until the next call. */
SPH_API const char *sph_sim_retry_reason(const sph_sim *sim);

/* Error weights 1/(tolerance scale) of every entry at tolerance 1: an ARKEwtFn and CVEwtFn. */
SPH_API int sph_sim_weights(N_Vector y, N_Vector weight, void *sim);

/* ---- derivatives of f ------------------------------------------------------------------------*/

/* Jv = (df/dy)(t, y) v: an ARKLsJacTimesVecFn and CVLsJacTimesVecFn (fy and tmp are not read).
 * Exact to rounding but for callbacks of yours (body terms, tiles, phi, an equation of state
 * without slopes), which are differenced, to about 1e-10; a body term's rates of a particle are
 * taken to depend on its own state only.  At kinks (a cut-off, a pair that begins to approach) it
 * is the derivative of one side.  Returns as sph_sim_rhs. */
SPH_API int sph_sim_jacobian_times(N_Vector v, N_Vector Jv, double t, N_Vector y, N_Vector fy,
                                   void *sim, N_Vector tmp);
/* ... of the implicit part alone, for Newton's method of ARKStep (ARKStepSetJacTimes). */
SPH_API int sph_sim_jacobian_times_implicit(N_Vector v, N_Vector Jv, double t, N_Vector y,
                                            N_Vector fy, void *sim, N_Vector tmp);
/* Jw = (df/dy)^T(t, y) w, for adjoints, in about 15 times the time of the product above; not with
 * tiles and a phi of your own (SPH_ERR_ARGUMENT). */
SPH_API int sph_sim_jacobian_transposed_times(N_Vector w, N_Vector Jw, double t, N_Vector y,
                                              N_Vector fy, void *sim, N_Vector tmp);

#ifdef __cplusplus
}
#endif
#endif
