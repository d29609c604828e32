/* 08_drive_gsl -- GSL's ODE solvers step a simulation: any solver of plain arrays can.
 *
 * Equations  y' = f(t, y), vortices in a periodic box, as an array of doubles
 * Reference  GNU Scientific Library, chapter Ordinary Differential Equations; P. J. Prince & J. R.
 *            Dormand (1981), J. Comput. Appl. Math. 7, 67 (rk8pd)
 * Run        ./08_drive_gsl
 * See        steps, evaluations and kinetic energy for two of GSL's schemes
 * Check      particles end where the library's own integrator brings them, within 1e-6 dx
 *
 * Where sphode is installed: cc 08_drive_gsl.c $(pkg-config --cflags --libs sphode-sundials gsl) */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>
#include <sphode.h>
#include <sphode/sundials.h>
#include <stdio.h>
#include <stdlib.h>

static const double L = 1, U = 1, dx = 1.0 / 24, t_end = 0.1; /* [m], [m/s], [m], [s] */

static sph_sim *make(void)
{
  const double k = 2 * acos(-1) / L;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){
      .dim = 2, .dx = dx, .periodic = {1, 1}, .length = {L, L}, .kernel = "wendland-c6"});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, L}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 10 * U, 7));
  const double *x = sph_group_read(water, "position", 0), *y = sph_group_read(water, "position", 1);
  double *u = sph_group_write(water, "velocity", 0), *v = sph_group_write(water, "velocity", 1);
  for (long i = 0; v && i < sph_group_count(water); i++) {
    u[i] = -U * cos(k * x[i]) * sin(k * y[i]);
    v[i] = U * sin(k * x[i]) * cos(k * y[i]);
  }
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  /* The library's own run, to compare with. */
  sph_sim_set_integrator(sim, &(sph_integrator_def){.method = "erk:dormand-prince-7-4-5",
                                                    .tolerance = 1e-7});
  return sim;
}

typedef struct plain {
  sph_sim *sim;
  N_Vector y, ydot; /* of the simulation's kind: copies of the arrays, with its padding */
  long evaluations;
} plain;

/* GSL repeats a step that returns GSL_FAILURE with a smaller one, and stops at GSL_EBADFUNC. */
static int f(double t, const double y[], double ydot[], void *data)
{
  plain *p = data;
  p->evaluations++;
  N_VBufUnpack(p->y, (void *)y); /* only read */
  int status = sph_sim_rhs(t, p->y, p->ydot, p->sim);
  N_VBufPack(p->ydot, ydot);
  return status == 0 ? GSL_SUCCESS : status > 0 ? GSL_FAILURE : GSL_EBADFUNC;
}

/* To t_end, with errors of 1e-8 of each field's scale a step; the steps, < 0: failed. */
static long drive(plain *p, const gsl_odeiv2_step_type *type, double *array, double *scale)
{
  size_t n = (size_t)N_VGetLength(p->y);
  sph_sim_weights(p->y, p->ydot, p->sim);
  N_VInv(p->ydot, p->ydot);
  N_VBufPack(p->ydot, scale);
  N_VBufPack(sph_sim_vector(p->sim), array);
  gsl_odeiv2_system system = {f, NULL, n, p};
  gsl_odeiv2_step *step = gsl_odeiv2_step_alloc(type, n);
  gsl_odeiv2_evolve *evolve = gsl_odeiv2_evolve_alloc(n);
  gsl_odeiv2_control *control = gsl_odeiv2_control_scaled_new(1e-8, 0, 0, 0, scale, n);
  double t = 0, h = 1e-3 * dx / U;
  int status = step && evolve && control ? GSL_SUCCESS : GSL_ENOMEM;
  while (status == GSL_SUCCESS && t < t_end)
    status = gsl_odeiv2_evolve_apply(evolve, control, step, &system, &t, t_end, &h, array);
  long steps = status == GSL_SUCCESS ? (long)evolve->count : -1;
  if (control) gsl_odeiv2_control_free(control);
  if (evolve) gsl_odeiv2_evolve_free(evolve);
  if (step) gsl_odeiv2_step_free(step);
  return steps;
}

/* Largest distance of a particle from where it is in another simulation [dx]. */
static double apart(sph_sim *a, sph_sim *b)
{
  double most = 0;
  for (int d = 0; d < 2; d++) {
    const double *x = sph_group_read(sph_sim_group(a, "water"), "position", d);
    const double *y = sph_group_read(sph_sim_group(b, "water"), "position", d);
    for (long i = 0; i < sph_group_count(sph_sim_group(a, "water")); i++)
      most = fmax(most, x && y ? fabs(x[i] - y[i]) / dx : INFINITY);
  }
  return most;
}

static int compare(const gsl_odeiv2_step_type *type, sph_sim *own)
{
  plain p = {.sim = make()};
  sph_balance balance = {.kinetic = 0};
  N_Vector y = sph_sim_vector(p.sim);
  p.y = y ? N_VClone(y) : NULL;
  p.ydot = y ? N_VClone(y) : NULL;
  size_t n = p.ydot ? (size_t)N_VGetLength(y) : 0;
  double *array = calloc(2 * n + 1, sizeof *array), distance = INFINITY;
  long steps = array && n ? drive(&p, type, array, array + n) : -1;
  if (steps > 0) {
    N_VBufUnpack(p.y, array);
    sph_sim_set_vector(p.sim, t_end, p.y); /* the simulation shows what GSL found */
    sph_sim_balance(p.sim, &balance);
    distance = apart(p.sim, own);
  }
  printf("%-6s %ld steps, %ld evaluations, kinetic energy %.6f J/m, %.1e dx from the library's\n",
         type->name, steps, p.evaluations, balance.kinetic, distance);
  free(array);
  if (p.y) N_VDestroy(p.y);
  if (p.ydot) N_VDestroy(p.ydot);
  if (sph_sim_status(p.sim)) fprintf(stderr, "08_drive_gsl: %s\n", sph_sim_error(p.sim));
  sph_sim_free(p.sim);
  return distance < 1e-6;
}

int main(void)
{
  sph_sim *own = make();
  gsl_set_error_handler_off();
  int good = sph_sim_run(own, t_end) == SPH_OK;
  good = good && compare(gsl_odeiv2_step_rkf45, own) && compare(gsl_odeiv2_step_rk8pd, own);
  if (sph_sim_status(own)) fprintf(stderr, "08_drive_gsl: %s\n", sph_sim_error(own));
  sph_sim_free(own);
  return !good;
}
