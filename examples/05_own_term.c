/* 05_own_term -- a term of your own: the Coriolis force of a rotating frame.
 *
 * Equations  a_i = -2 Omega x v_i        (Omega along z; built-in terms use the same struct)
 * Reference  inertial oscillation: a free patch moving at v0 turns clockwise through circles of
 *            radius v0/(2 Omega), period pi/Omega
 * Run        ./05_own_term
 * See        the printed error of the mean velocity and position
 * Check      after a quarter of a period the patch moves at right angles, with the same speed; its
 *            centre has moved by (R, -R), R = v0/(2 Omega) */
#include <sphode.h>
#include <stdio.h>

/* The whole term: add to the accelerations of one group.  ctx is Omega [1/s]. */
static int coriolis(const sph_term *term, const sph_particles *s)
{
  const double omega = *(const double *)term->ctx;
  for (long i = 0; i < s->n; i++) {
    s->a[0][i] += 2 * omega * s->v[1][i];
    s->a[1][i] -= 2 * omega * s->v[0][i];
  }
  return SPH_OK;
}

static double coriolis_dt_max(const sph_term *term, const sph_particles *s)
{
  (void)s;
  return 0.1 / *(const double *)term->ctx; /* a tenth of a radian */
}

static double mean(const sph_group *group, const char *field, int component)
{
  const double *a = sph_group_read(group, field, component);
  double sum = 0;
  for (long i = 0; i < sph_group_count(group); i++) sum += a[i];
  return sum / (double)sph_group_count(group);
}

int main(void)
{
  double omega = 0.5, v0 = 1, R = v0 / (2 * omega),
         quarter = acos(-1) / omega / 4; /* [1/s] [m/s] [m] [s] */

  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.05, .speed = v0});
  sph_group *patch =
      sph_group_box(sim, "patch", (double[]){-0.5, -0.5}, (double[]){0.5, 0.5}, 1000);
  sph_group_set_eos(patch, sph_eos_tait(1000, 10 * v0, 7));
  double *v = sph_group_write(patch, "velocity", 0);
  for (long i = 0; v && i < sph_group_count(patch); i++) v[i] = v0;

  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, (sph_term){.name = "coriolis",
                                   .body = coriolis,
                                   .dt_max = coriolis_dt_max,
                                   .ctx = &omega});
  sph_sim_set_integrator(sim, &(sph_integrator_def){.tolerance = 1e-4});

  double error = INFINITY;
  if (sph_sim_run(sim, quarter) == SPH_OK) {
    error = fabs(mean(patch, "velocity", 0)) + fabs(mean(patch, "velocity", 1) + v0);
    error += fabs(mean(patch, "position", 0) - R) + fabs(mean(patch, "position", 1) + R);
    printf("a quarter of a circle: error of the mean velocity and position %.1e\n", error);
  } else
    fprintf(stderr, "own_term: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return !(error < 1e-3);
}
