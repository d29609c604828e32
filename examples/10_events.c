/* 10_events -- dense output, and events: moments that nobody has to step to.
 *
 * Equations  a drop swings on a spring, dv/dt = ... - Omega^2 x: whatever happens inside, its
 *            centre moves as X(t) = X0 cos(Omega t), V = -X0 Omega sin(Omega t).  An event is a
 *            moment at which a function g(t, y) passes zero; it is found in the dense output of
 *            a step, a polynomial through the states and rates at its ends, and no step is
 *            shortened
 * Reference  R. P. Brent (1973), Algorithms for Minimization without Derivatives
 * Run        ./10_events [particles across the drop]
 * See        the times at which the centre passes x = 0; the frames at times of their own between
 *            steps; the moment at which the spring is cut
 * Check      passages at (k + 1/2) pi/Omega, the cut at acos(1/2)/Omega, the stop as far behind it
 *            as the uniform motion takes, within 1e-6 of a period; frames on the cosine within
 *            1e-5 X0; no force behind the cut: the velocity stays within 1e-9 of itself */
#include <sphode.h>
#include <stdlib.h>

static const double X0 = 0.5, omega = 2; /* [m], [1/s] */

static double centre(sph_sim *sim, const char *field)
{
  const sph_group *drop = sph_sim_group(sim, "drop");
  const double *a = sph_group_read(drop, field, 0);
  long n = sph_group_count(drop);
  double sum = 0;
  for (long i = 0; a && i < n; i++) sum += a[i];
  return sum / (double)n;
}

/* A place on the x axis, and the speed with which the centre came there. */
typedef struct mark {
  double x, speed;
} mark;

/* g of an event: the library asks for it in states of its choice. */
static double beyond(void *ctx, sph_sim *sim)
{
  const mark *m = ctx;
  return centre(sim, "position") - m->x;
}

/* ---- what the library tells */

typedef struct diary {
  int passages, frames;
  double worst_passage, worst_frame; /* [s], [m] */
} diary;

static int frame(void *ctx, sph_sim *sim, sph_error *error)
{
  diary *d = ctx;
  double expected = X0 * cos(omega * sph_sim_time(sim));
  (void)error;
  d->frames++;
  d->worst_frame = fmax(d->worst_frame, fabs(centre(sim, "position") - expected));
  return SPH_OK;
}

static int passage(void *ctx, sph_sim *sim, const sph_event_record *r, sph_error *error)
{
  diary *d = ctx;
  double expected = (d->passages++ + 0.5) * acos(-1) / omega;
  (void)sim, (void)error;
  printf("t = %.9f s, step %3ld: the centre passes 0, expected at %.9f s\n", r->t, r->step,
         expected);
  d->worst_passage = fmax(d->worst_passage, fabs(r->t - expected));
  return SPH_OK;
}

static int cut_the_spring(void *ctx, sph_sim *sim)
{
  mark *m = ctx;
  m->speed = centre(sim, "velocity");
  printf("t = %.9f s: the spring is cut at x = %.9f m\n", sph_sim_time(sim),
         centre(sim, "position"));
  sph_sim_change_term(sim, sph_term_harmonic(0));
  return SPH_OK;
}

/* ---- two runs */

static sph_sim *swing(int n)
{
  double R = 0.2, dx = 2 * R / n;
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = dx, .speed = X0 * omega});
  sph_group *drop = sph_group_create(sim, "drop", "fluid");
  sph_group_add_ball(drop, (double[]){X0, 0}, R, 1000);
  sph_group_set_eos(drop, sph_eos_tait(1000, 10 * X0 * omega, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, sph_term_viscosity_artificial(0.1, 0));
  sph_sim_add_term(sim, sph_term_harmonic(omega));
  return sim;
}

/* A period and a half: each passage is told, and frames come at their own times. */
static int watch(int n)
{
  double period = 2 * acos(-1) / omega;
  mark zero = {0, 0};
  diary d = {0};
  sph_sim *sim = swing(n);
  sph_sim_add_event(sim, &(sph_event){.name = "middle", .value = beyond, .ctx = &zero});
  sph_sim_add_output(
      sim, (sph_output){.interval = period / 1000, .frame = frame, .event = passage, .ctx = &d});
  int failed = sph_sim_run(sim, 1.5 * period);
  sph_sim_stats stats;
  sph_sim_get_stats(sim, &stats);
  printf("%d frames in %ld steps, off the cosine by %.1e X0 at most\n", d.frames, stats.step.steps,
         d.worst_frame / X0);
  if (failed) fprintf(stderr, "10_events: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return failed || d.passages != 3 || !(d.worst_passage < 1e-6 * period) ||
         !(d.worst_frame < 1e-5 * X0);
}

/* Half way the spring is cut; what then moves uniformly is stopped where it had turned. */
static int cut(int n)
{
  double period = 2 * acos(-1) / omega, V = omega * sqrt(X0 * X0 - X0 * X0 / 4);
  double t_cut = acos(0.5) / omega, t_end = t_cut + (X0 / 2 + X0) / V;
  mark half = {X0 / 2, 0}, end = {-X0, 0};
  sph_sim *sim = swing(n);
  sph_sim_add_event(
      sim, &(sph_event){.name = "cut", .value = beyond, .ctx = &half, .change = cut_the_spring});
  sph_sim_add_event(sim, &(sph_event){.name = "end", .value = beyond, .ctx = &end, .stop = 1});
  int failed = sph_sim_run(sim, 2 * period) || !sph_sim_stopped_by(sim);
  sph_event_info info = {0};
  sph_sim_event_get(sim, 0, &info);
  printf("t = %.9f s: stopped at x = %.9f m, expected at %.9f s\n", sph_sim_time(sim),
         centre(sim, "position"), t_end);
  failed |= !(fabs(info.last - t_cut) < 1e-6 * period && fabs(half.speed + V) < 1e-5 * V);
  failed |= !(fabs(sph_sim_time(sim) - t_end) < 1e-6 * period);
  failed |= !(fabs(centre(sim, "velocity") - half.speed) < 1e-9 * V);
  if (sph_sim_status(sim)) fprintf(stderr, "10_events: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return failed;
}

int main(int argc, char **argv)
{
  int n = argc > 1 ? atoi(argv[1]) : 16;
  return watch(n) || cut(n);
}
