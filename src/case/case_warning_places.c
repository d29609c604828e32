/* Where a case looks: monitors, probes and events far from all particles see nothing. */
#include <math.h>
#include <string.h>

#include "case_warning.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find
#define get_text sph_case_reader_text

/* Of all particles at the start, along each direction [m]. */
typedef struct box {
  double low[3], high[3];
} box;

static box box_of(const sph_sim *sim)
{
  box b = {{0}, {0}};
  const sph_group *group;
  for (int d = 0; d < 3; d++) b.low[d] = INFINITY, b.high[d] = -INFINITY;
  for (int k = 0; (group = sph_sim_group_get(sim, k)); k++)
    for (int d = 0; d < sph_sim_dim(sim); d++) {
      const double *x = sph_group_read(group, "position", d);
      for (long i = 0; x && i < sph_group_count(group); i++)
        b.low[d] = fmin(b.low[d], x[i]), b.high[d] = fmax(b.high[d], x[i]);
    }
  return b;
}

/* Farther outside than the box is long, as a probe must not be: a wrong unit, or a wrong sign. */
static int is_far(const sph_sim *sim, const box *b, int d, double x)
{
  const double more = fmax(b->high[d] - b->low[d], sph_sim_dx(sim));
  return !sph_sim_periodic(sim, d, NULL, NULL) &&
         !(x >= b->low[d] - more && x <= b->high[d] + more);
}

/* node: whose place it is, which "what" says. */
static void look_at_place(sph_case_finder *f, const sph_sim *sim, const box *b,
                          const sph_case_node *node, const char *what, const double *x, int from,
                          int to)
{
  for (int d = from; d < to; d++) {
    if (!is_far(sim, b, d, x[d])) continue;
    sph_case_warning_found(
        f, node, "%s %c = %g m is far outside of all particles, which are from %.4g to %.4g m",
        what, 'x' + d, x[d], b->low[d], b->high[d]);
    return;
  }
}

/* A gauge goes through its place along the last direction. */
static void look_at_monitor(sph_case_finder *f, const sph_sim *sim, const box *b,
                            const sph_case_node *monitor)
{
  const char *type = get_text(monitor, "type", "");
  const int dim = sph_sim_dim(sim), gauge = type[0] == 'g';
  double x[3];
  if (sph_case_reader_vector(monitor, "at", x) && (gauge || type[0] == 'p'))
    look_at_place(f, sim, b, monitor, "its place", x, 0, gauge ? dim - 1 : dim);
}

/* Ends, corners and points of it; where all of them are far, the run is refused. */
static void look_at_probe(sph_case_finder *f, const sph_sim *sim, const box *b,
                          const sph_case_node *probe)
{
  static const char *const ends[][2] = {{"line", "from"},
                                        {"line", "to"},
                                        {"plane", "corner"},
                                        {"plane", "along"},
                                        {"plane", "across"}};
  const sph_case_node *points = child_of(probe, "points");
  const int before = f->found;
  double x[3];
  for (size_t k = 0; k < sizeof ends / sizeof *ends && f->found == before; k++)
    if (sph_case_reader_vector(child_of(probe, ends[k][0]), ends[k][1], x))
      look_at_place(f, sim, b, probe, "its end", x, 0, sph_sim_dim(sim));
  for (points = points ? points->first : NULL; points && f->found == before; points = points->next)
    if (sph_case_reader_vector(points, "at", x))
      look_at_place(f, sim, b, probe, "its point", x, 0, sph_sim_dim(sim));
}

static void look_at_event(sph_case_finder *f, const sph_sim *sim, const box *b,
                          const sph_case_node *event)
{
  const sph_case_node *when = child_of(event, "when"), *front = child_of(when, "front");
  double x[3] = {0};
  if (sph_case_reader_vector(when, "wet", x) || sph_case_reader_vector(when, "dry", x))
    look_at_place(f, sim, b, event, "its point", x, 0, sph_sim_dim(sim));
  if (!front) return;
  const int d = get_text(front, "axis", "x")[0] - 'x';
  x[d] = sph_case_reader_number(front, "at", 0);
  look_at_place(f, sim, b, event, "its front, at", x, d, d + 1);
}

/* Dust, which holds nothing, has no pressure. */
static int holds(const sph_group *group)
{
  return !sph_group_eos(group) || !sph_group_eos(group)->dust;
}

/* Is x, but for direction `up`, within a box? */
static int within(const sph_group *group, long i, int dim, int up, const double *low,
                  const double *high)
{
  int in = 1;
  for (int d = 0; in && d < dim; d++) {
    const double x = sph_group_read(group, "position", d)[i];
    in = d == up || (x >= low[d] && x <= high[d]);
  }
  return in;
}

/* Has it one top, over half of its extent or more? */
static int is_flat(const sph_sim *sim, const sph_group *group, int up, const double *low,
                   const double *high)
{
  const double dx = sph_sim_dx(sim), *x = sph_group_read(group, "position", up);
  double room = 1, top = 0;
  for (int d = 0; d < sph_sim_dim(sim); d++)
    if (d != up) room *= (high[d] - low[d]) / dx + 1;
  for (long i = 0; i < sph_group_count(group); i++) top += x[i] > high[up] - 0.75 * dx;
  return top > 0.5 * room;
}

/* The surface whose column it is given, and the one that it has: half a spacing above its highest
 * particles.  Below something else, a lid or another liquid, it may have none. */
static void look_at_surface(sph_case_finder *f, const sph_sim *sim, const sph_group *group,
                            const sph_case_node *column, int up, const double *low,
                            const double *high)
{
  const double dx = sph_sim_dx(sim), surface = sph_case_reader_number(column, "surface", 0);
  const double above = (surface - high[up]) / dx - 0.5;
  const sph_group *other;
  if (!(fabs(above) > 0.75) || !is_flat(sim, group, up, low, high)) return;
  for (int k = 0; (other = sph_sim_group_get(sim, k)); k++)
    for (long i = 0; other != group && holds(other) && i < sph_group_count(other); i++) {
      const double over = sph_group_read(other, "position", up)[i] - high[up];
      if (over > 0 && over < 2.9 * dx && within(other, i, sph_sim_dim(sim), up, low, high)) return;
    }
  sph_case_warning_found(f, child_of(column, "surface"),
                         "%g m is %.3g m (%.2g dx) %s the top of %s, which is at %.6g m: it will "
                         "%s",
                         surface, fabs(above) * dx, fabs(above), above > 0 ? "above" : "below",
                         sph_group_name(group), high[up] + dx / 2,
                         above > 0 ? "spring up" : "fall");
}

/* A liquid that is given the pressure of a column at rest, with nothing to stand on. */
static void look_at_column(sph_case_finder *f, const sph_sim *sim, const sph_group *group,
                           const sph_case_node *column)
{
  const int dim = sph_sim_dim(sim);
  const char last[2] = {"xyz"[dim - 1]};
  const int up = get_text(column, "axis", last)[0] - 'x';
  double low[3] = {0}, high[3] = {0}, beneath = -INFINITY;
  const sph_group *other;
  for (int d = 0; d < dim; d++) {
    const double *x = sph_group_read(group, "position", d);
    low[d] = INFINITY, high[d] = -INFINITY;
    for (long i = 0; i < sph_group_count(group); i++)
      low[d] = fmin(low[d], x[i]), high[d] = fmax(high[d], x[i]);
  }
  if (sph_sim_periodic(sim, up, NULL, NULL)) return;
  look_at_surface(f, sim, group, column, up, low, high);
  for (int k = 0; (other = sph_sim_group_get(sim, k)); k++) {
    if (other == group || !holds(other)) continue;
    for (long i = 0; i < sph_group_count(other); i++) {
      const double x = sph_group_read(other, "position", up)[i];
      if (x < low[up] && within(other, i, dim, up, low, high)) beneath = fmax(beneath, x);
    }
  }
  const double gap = (low[up] - beneath) / sph_sim_dx(sim);
  if (gap > 2.9 && isfinite(gap)) /* less is told by the simulation */
    sph_case_warning_found(
        f, column,
        "nothing holds this pressure: the particles beneath %s are %.3g m (%.3g dx) "
        "away",
        sph_group_name(group), gap * sph_sim_dx(sim), gap);
}

static void look_at_columns(sph_case_finder *f, const sph_sim *sim)
{
  const sph_case_node *groups = child_of(f->c->root, "groups");
  for (const sph_case_node *g = groups->first; g; g = g->next)
    if (!strcmp(get_text(child_of(g, "boundary"), "model", ""), "mirror")) return; /* planes */
  for (const sph_case_node *g = groups->first; g; g = g->next) {
    const sph_case_node *column = child_of(child_of(g, "initial"), "hydrostatic");
    const sph_group *group = sph_sim_group(sim, g->key);
    if (column && group && sph_group_count(group) > 0) look_at_column(f, sim, group, column);
  }
}

int sph_case_warning_places(const sph_case *c, const sph_sim *sim, int k, char *text, size_t size)
{
  sph_case_finder f = {.c = c, .wanted = k, .text = text, .size = size};
  if (!c || !sim || k < 0) return 0;
  const box b = box_of(sim);
  const sph_case_node *output = child_of(c->root, "output");
  const sph_case_node *monitors = child_of(output, "monitors"),
                      *probes = child_of(output, "probes");
  const sph_case_node *events = child_of(c->root, "events");
  for (const sph_case_node *m = monitors ? monitors->first : NULL; m; m = m->next)
    look_at_monitor(&f, sim, &b, m);
  for (const sph_case_node *p = probes ? probes->first : NULL; p; p = p->next)
    look_at_probe(&f, sim, &b, p);
  for (const sph_case_node *e = events ? events->first : NULL; e; e = e->next)
    look_at_event(&f, sim, &b, e);
  if (sph_sim_time(sim) == 0) look_at_columns(&f, sim);
  return f.found > k;
}
