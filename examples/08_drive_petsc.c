/* 08_drive_petsc -- PETSc's TS steps a simulation, and its options choose how.
 *
 * Equations  y' = f(t, y), a patch of fluid on a spring, dv/dt = ... - Omega^2 x: its centre swings
 *            as X(t) = X0 cos(Omega t) whatever happens inside, where forces are antisymmetric in
 *            pairs
 * Reference  S. Abhyankar et al. (2018), PETSc/TS: a modern scalable ODE/DAE solver library,
 *            arXiv:1806.01437
 * Run        ./08_drive_petsc; with options of PETSc: -ts_rk_type 3bs, or implicit, Newton's
 *            method without a matrix: -ts_type cn -ts_dt 2e-3 -ts_adapt_type none -snes_mf
 * See        the place of the centre at ten times of a swing
 * Check      it is the exact one within 1e-5 X0
 *
 * Where sphode and PETSc are installed:
 *   mpicc 08_drive_petsc.c $(pkg-config --cflags --libs sphode-sundials PETSc) -lm */
#include <math.h>
#include <petscts.h>
#include <sphode.h>
#include <sphode/sundials.h>
#include <stdio.h>

static const double X0 = 0.5, omega = 2; /* [m], [1/s] */

static sph_sim *make(void)
{
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.025, .speed = X0 * omega});
  sph_group *patch =
      sph_group_box(sim, "patch", (double[]){X0 - 0.2, -0.2}, (double[]){X0 + 0.2, 0.2}, 1000);
  sph_group_set_eos(patch, sph_eos_tait(1000, 10 * X0 * omega, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_add_term(sim, sph_term_harmonic(omega));
  return sim;
}

typedef struct problem {
  sph_sim *sim;
  N_Vector y, ydot; /* of the simulation's kind: copies of PETSc's arrays, with its padding */
  int outside;      /* f was asked for a state that is not admissible */
  int good, frames;
} problem;

static PetscErrorCode rhs(TS ts, PetscReal t, Vec Y, Vec F, void *data)
{
  problem *p = data;
  (void)ts;
  const PetscScalar *y;
  PetscScalar *ydot;
  PetscCall(VecGetArrayRead(Y, &y));
  N_VBufUnpack(p->y, (void *)y); /* only read */
  PetscCall(VecRestoreArrayRead(Y, &y));
  int status = sph_sim_rhs(t, p->y, p->ydot, p->sim);
  if (status < 0) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "%s", sph_sim_error(p->sim));
  if (status > 0) p->outside = 1;
  PetscCall(VecGetArray(F, &ydot));
  N_VBufPack(p->ydot, ydot);
  PetscCall(VecRestoreArray(F, &ydot));
  return 0;
}

/* PETSc asks before each stage; a step that is not accepted is repeated with a smaller one. */
static PetscErrorCode admissible(TS ts, PetscReal t, Vec Y, PetscBool *accept)
{
  problem *p;
  (void)t, (void)Y;
  PetscCall(TSGetApplicationContext(ts, &p));
  *accept = p->outside ? PETSC_FALSE : PETSC_TRUE;
  p->outside = 0;
  return 0;
}

/* After each step: where is the centre? */
static PetscErrorCode watch(TS ts, PetscInt step, PetscReal t, Vec Y, void *data)
{
  problem *p = data;
  const PetscScalar *y;
  (void)ts, (void)step;
  if (t < p->frames * 0.1 * 2 * acos(-1) / omega) return 0;
  PetscCall(VecGetArrayRead(Y, &y));
  N_VBufUnpack(p->y, (void *)y);
  PetscCall(VecRestoreArrayRead(Y, &y));
  sph_sim_set_vector(p->sim, t, p->y); /* the simulation shows what PETSc has found */
  const sph_group *patch = sph_sim_group(p->sim, "patch");
  const double *x = sph_group_read(patch, "position", 0);
  long n = sph_group_count(patch);
  double centre = 0, exact = X0 * cos(omega * t);
  for (long i = 0; x && i < n; i++) centre += x[i] / (double)n;
  printf("t = %.5f s: X = %9.6f m, exact %9.6f m\n", t, centre, exact);
  p->good = p->good && fabs(centre - exact) < 1e-5 * X0;
  p->frames++;
  return 0;
}

/* Vectors of the start and of the absolute tolerances, 1e-6 of each field's scale. */
static PetscErrorCode make_vectors(problem *p, Vec *Y, Vec *tolerance)
{
  PetscScalar *array;
  PetscInt n = (PetscInt)N_VGetLength(p->y);
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, Y));
  PetscCall(VecDuplicate(*Y, tolerance));
  PetscCall(VecGetArray(*Y, &array));
  N_VBufPack(sph_sim_vector(p->sim), array);
  PetscCall(VecRestoreArray(*Y, &array));
  sph_sim_weights(p->y, p->ydot, p->sim);
  N_VInv(p->ydot, p->ydot);
  N_VScale(1e-6, p->ydot, p->ydot);
  PetscCall(VecGetArray(*tolerance, &array));
  N_VBufPack(p->ydot, array);
  PetscCall(VecRestoreArray(*tolerance, &array));
  return 0;
}

static PetscErrorCode drive(problem *p)
{
  TS ts;
  Vec Y, tolerance;
  PetscInt steps;
  PetscCall(make_vectors(p, &Y, &tolerance));
  PetscCall(TSCreate(PETSC_COMM_SELF, &ts));
  PetscCall(TSSetType(ts, TSRK));
  PetscCall(TSRKSetType(ts, TSRK5DP));
  PetscCall(TSSetRHSFunction(ts, NULL, rhs, p));
  PetscCall(TSSetApplicationContext(ts, p));
  PetscCall(TSSetFunctionDomainError(ts, admissible));
  PetscCall(TSMonitorSet(ts, watch, p, NULL));
  PetscCall(TSSetTolerances(ts, 0, tolerance, 0, NULL));
  PetscCall(TSSetTimeStep(ts, 1e-3));
  PetscCall(TSSetMaxTime(ts, 2 * acos(-1) / omega));
  PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetFromOptions(ts));
  PetscCall(TSSolve(ts, Y));
  PetscCall(TSGetStepNumber(ts, &steps));
  printf("%d steps\n", (int)steps);
  PetscCall(TSDestroy(&ts));
  PetscCall(VecDestroy(&Y));
  PetscCall(VecDestroy(&tolerance));
  return 0;
}

int main(int argc, char **argv)
{
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  problem p = {.sim = make(), .good = 1};
  N_Vector y = sph_sim_vector(p.sim);
  p.y = y ? N_VClone(y) : NULL;
  p.ydot = y ? N_VClone(y) : NULL;
  int good = p.y && p.ydot && !drive(&p) && p.good && p.frames > 10;
  if (sph_sim_status(p.sim)) fprintf(stderr, "08_drive_petsc: %s\n", sph_sim_error(p.sim));
  if (p.y) N_VDestroy(p.y);
  if (p.ydot) N_VDestroy(p.ydot);
  sph_sim_free(p.sim);
  PetscCall(PetscFinalize());
  return !good;
}
