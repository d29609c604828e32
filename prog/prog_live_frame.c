/* What the live page shows of a state. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"
#include "prog_live.h"

void sph_prog_live_frame_note(prog_live_history *history, sph_sim *sim)
{
  if (++history->skipped < history->every) return;
  history->skipped = 0;
  if (!history->every) history->every = 1;
  if (history->n == LIVE_HISTORY) {
    for (int k = 0; k < LIVE_HISTORY / 2; k++)
      memcpy(history->row[k], history->row[2 * k + 1], sizeof *history->row);
    history->n = LIVE_HISTORY / 2, history->every *= 2;
  }
  sph_sim_stats s;
  sph_sim_get_stats(sim, &s);
  const double now = sph_prog_progress_now(), used = now - history->last;
  const double rate = history->last > 0 && used > 0 ? 1e-6 * (s.pairs - history->pairs) / used : 0;
  history->last = now, history->pairs = s.pairs;
  const double row[] = {sph_sim_time(sim), s.step.dt_last, rate};
  memcpy(history->row[history->n++], row, sizeof row);
}

static int reserve(prog_live_frame *frame, size_t more)
{
  if (frame->size + more <= frame->capacity) return 0;
  size_t capacity = 2 * (frame->size + more);
  char *bytes = realloc(frame->bytes, capacity);
  if (!bytes) return -1;
  frame->bytes = bytes, frame->capacity = capacity;
  return 0;
}

static int put(prog_live_frame *frame, const char *format, ...) SPH_PRINTF(2, 3);
static int put(prog_live_frame *frame, const char *format, ...)
{
  va_list arguments;
  char text[500];
  va_start(arguments, format);
  const int n = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (n < 0 || n >= (int)sizeof text || reserve(frame, (size_t)n)) return -1;
  memcpy(frame->bytes + frame->size, text, (size_t)n);
  frame->size += (size_t)n;
  return 0;
}

/* JSON knows no NaN. */
static double number(double x) { return isfinite(x) ? x : 0; }

/* Which of the particles of one kind are shown: every k-th. */
static long count(const sph_sim *sim, const char *kind)
{
  const sph_group *group;
  long n = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    if (!strcmp(sph_group_kind(group), kind)) n += sph_group_count(group);
  return n;
}
static long step_of(long n) { return n > LIVE_PARTICLES ? (n - 1) / LIVE_PARTICLES + 1 : 1; }

static const sph_field_info *find(const sph_group *group, const char *name)
{
  const sph_field_info *field;
  for (int k = 0; (field = sph_group_field(group, k)); k++)
    if (!strcmp(field->name, name) && sph_group_read(group, name, 0)) return field;
  return NULL;
}

/* A component, or the length of a vector. */
static double value(const sph_group *group, const sph_field_info *field, int dim, long i)
{
  if (!field->vector) return sph_group_read(group, field->name, 0)[i];
  double square = 0;
  for (int d = 0; d < dim; d++) {
    double v = sph_group_read(group, field->name, d)[i];
    square += v * v;
  }
  return sqrt(square);
}

static int put_particles(prog_live_frame *frame, const sph_sim *sim, const char *kind,
                         const char *name)
{
  const int dim = sph_sim_dim(sim), fluid = !strcmp(kind, "fluid");
  const long step = step_of(count(sim, kind));
  const sph_group *group;
  long at = 0;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++) {
    if (strcmp(sph_group_kind(group), kind)) continue;
    const long n = sph_group_count(group);
    const sph_field_info *field = fluid ? find(group, name) : NULL;
    const double *x[3] = {0};
    for (int d = 0; d < dim; d++) x[d] = sph_group_read(group, "position", d);
    for (long i = (step - at % step) % step; i < n; i += step) {
      float row[4];
      for (int d = 0; d < dim; d++) row[d] = (float)x[d][i];
      row[dim] = field ? (float)value(group, field, dim, i) : NAN;
      const size_t size = (size_t)(dim + 1) * sizeof *row;
      if (reserve(frame, size)) return -1;
      memcpy(frame->bytes + frame->size, row, size);
      frame->size += size;
    }
    at += n;
  }
  return 0;
}

/* In 2D a simulation is a metre deep, in 1D a square metre across. */
static const char *unit_of(const sph_field_info *field, int dim)
{
  static const char *const mass[] = {"kg/m^2", "kg/m", "kg"};
  return strcmp(field->name, "mass") ? field->unit : mass[dim - 1];
}

static int put_fields(prog_live_frame *frame, const sph_sim *sim)
{
  const sph_group *group;
  const sph_field_info *field;
  int any = 0, bad = put(frame, "\"fields\":[");
  for (int k = 0; (group = sph_sim_group_get(sim, k)) && strcmp(sph_group_kind(group), "fluid");)
    k++;
  for (int k = 0; !bad && group && (field = sph_group_field(group, k)); k++)
    if (strcmp(field->name, "position") && sph_group_read(group, field->name, 0))
      bad = put(frame, "%s[\"%s\",\"%s\"]", any++ ? "," : "", field->name,
                unit_of(field, sph_sim_dim(sim)));
  return bad || put(frame, "],");
}

static int put_history(prog_live_frame *frame, const prog_live_history *history)
{
  int bad = put(frame, "\"history\":[");
  for (int k = 1; k < history->n && !bad; k++) { /* the first knows no rate */
    const double *row = history->row[k];
    bad = put(frame, "%s[%.7g,%.4g,%.4g]", k > 1 ? "," : "", number(row[0]), number(row[1]),
              number(row[2]));
  }
  return bad || put(frame, "]");
}

/* What bound most of the steps. */
static const char *bound(const sph_sim *sim, const sph_step_stats *s)
{
  int most = 0;
  for (int k = 1; k < SPH_BOUND_COUNT; k++)
    if (s->bound_by[k] > s->bound_by[most]) most = k;
  return sph_sim_bound_name(sim, most);
}

int sph_prog_live_frame_fill(prog_live_frame *frame, sph_sim *sim, const char *field, double end,
                             int paused, const prog_live_history *history)
{
  const long fluids = count(sim, "fluid"), walls = count(sim, "wall");
  const long shown = (fluids - 1) / step_of(fluids) + 1;
  sph_sim_stats s;
  sph_sim_get_stats(sim, &s);
  frame->size = 0;
  int bad = put(frame, "{\"t\":%.9g,\"end\":%.9g,\"step\":%ld,\"dt\":%.4g,\"bound\":\"%s\",",
                sph_sim_time(sim), end, s.step.steps, number(s.step.dt_last), bound(sim, &s.step));
  bad = bad || put(frame, "\"paused\":%d,\"dim\":%d,\"dx\":%.6g,\"field\":\"%s\",", paused,
                   sph_sim_dim(sim), sph_sim_dx(sim), field);
  bad = bad || put(frame, "\"particles\":%ld,\"wall_particles\":%ld,\"fluid\":%ld,", fluids, walls,
                   fluids ? shown : 0);
  bad = bad || put_fields(frame, sim) || put_history(frame, history) || put(frame, "}");
  while (!bad && frame->size % 4 != 3) bad = put(frame, " ");
  bad = bad || put(frame, "\n");
  bad = bad || put_particles(frame, sim, "fluid", field);
  return bad || put_particles(frame, sim, "wall", field) ? -1 : 0;
}
