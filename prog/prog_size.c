/* sphode check: what the run will write, and is there room for it? */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/statvfs.h>

#include "prog.h"

/* In (-1, 1), the same every time. */
static double noise(unsigned *state)
{
  *state = *state * 1664525u + 1013904223u;
  return (double)(*state >> 8) / (1 << 23) - 1;
}

/* At the start particles stand on a lattice and hardly move: such numbers are small when they are
 * compressed.  Now they are as later in the run, no two alike; then a step, which the integrator
 * remembers, and a frame of it. */
static int stir(sph_sim *sim)
{
  static const char *const fields[] = {"position", "velocity", "density", "energy"};
  enum { FIELDS = sizeof fields / sizeof *fields };
  sph_sim_stats stats;
  sph_group *fluid;
  unsigned state = 1;
  sph_sim_get_stats(sim, &stats);
  const double by = 1e-4 * sph_sim_dx(sim), speed = by / stats.step.dt_largest;
  for (int k = 0; (fluid = sph_sim_group_get(sim, k)); k++)
    for (int f = 0; f < FIELDS && !strcmp(sph_group_kind(fluid), "fluid"); f++)
      for (int d = 0; d < sph_sim_dim(sim); d++) {
        double *x = sph_group_write(fluid, fields[f], d);
        for (long i = 0; x && i < sph_group_count(fluid); i++)
          x[i] += noise(&state) * (f == 0 ? by : f == 1 ? speed : 1e-7 * x[i]);
      }
  sph_sim_changed(sim);
  int status = sph_sim_step(sim);
  return status ? status : sph_sim_run(sim, sph_sim_time(sim));
}

/* "1.2 GB" */
static const char *bytes(double n, char text[32])
{
  static const char *const unit[] = {"B", "kB", "MB", "GB", "TB", "PB", "EB"};
  int k = 0;
  for (; n >= 999.5 && k < 6; k++) n /= 1000;
  snprintf(text, 32, "%.3g %s", n, unit[k]);
  return text;
}

/* Behind what text[size] has. */
static void tell(const sph_case_size *s, int k, char *text, size_t size)
{
  char one[32];
  const size_t n = strlen(text);
  bytes(s->bytes, one);
  if (k == 0)
    snprintf(text + n, size - n, "%.6g %s of %s", s->frames, s->name, one);
  else if (s->interval > 0)
    snprintf(text + n, size - n, ", %.6g %s of %s in %s", s->frames, k == 1 ? "rows" : "frames",
             one, s->name);
  else
    snprintf(text + n, size - n, ", at most %.6g %s of %s", s->frames, s->name, one);
}

/* Free for this user in a directory. */
static double free_in(const char *directory)
{
  struct statvfs s;
  return statvfs(directory, &s) ? INFINITY : (double)s.f_bavail * (double)s.f_frsize;
}

void sph_prog_sizes_warn(const sph_case *c, sph_sim *sim, const char *directory)
{
  enum { MOST = 300 }; /* bytes of a particle in a snapshot, and more */
  char all[32], there[32];
  sph_case_size s;
  const sph_group *group;
  double particles = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    particles += (double)sph_group_count(group);
  if (sph_case_size_get(c, sim, NULL, 0, &s, NULL) < 1) return;
  if (s.frames * particles * MOST < free_in(directory)) return; /* it takes time to make one */
  if (sph_case_size_get(c, sim, directory, 0, &s, NULL) < 1) return;
  if (s.frames * s.bytes > free_in(directory))
    sph_prog_error(PROG_OK,
                   "warning: the run writes %s of snapshots, or more, but %s are free in %s; fewer "
                   "are right (output: snapshots), or precision: single",
                   bytes(s.frames * s.bytes, all), bytes(free_in(directory), there), directory);
}

int sph_prog_sizes(const sph_case *c, sph_sim *sim, const char *stage, int *warnings,
                   sph_error *error)
{
  sph_case_size s;
  char all[32], there[32], text[2000] = "";
  double total = 0;
  int status = stir(sim), k = 0;
  if (status) return sph_error_set(error, status, "%s", sph_sim_error(sim));
  for (; (status = sph_case_size_get(c, sim, stage, k, &s, error)) > 0; k++) {
    tell(&s, k, text, sizeof text);
    total += s.bytes * (s.frames + !(s.interval > 0)); /* a checkpoint beside those that stay */
  }
  if (status) return status;
  printf("%-12s %s; %s in all\n", "output", text, bytes(total, all));
  if (total <= free_in(".")) return SPH_OK;
  printf("warning      the run writes %s, but %s are free here; fewer snapshots are right (output: "
         "snapshots), or precision: single\n",
         bytes(total, all), bytes(free_in("."), there));
  ++*warnings;
  return SPH_OK;
}
