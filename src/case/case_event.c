#include "case_event.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "memory.h"
#include "sphode/event.h"
#include "text.h"

#define get_text sph_case_reader_text
#define get_number sph_case_reader_number
#define get_vector sph_case_reader_vector
#define child_of sph_case_reader_find
#define FAIL(node, ...) sph_case_schema_fail(c, c->error, node, 0, 0, __VA_ARGS__)
#define FAIL_VALUE(node, ...) sph_case_schema_fail(c, c->error, node, 1, 0, __VA_ARGS__)

/* ---- checks */

static int kind_is(const sph_case *c, const char *group, const char *kind)
{
  const sph_case_node *map = child_of(child_of(c->root, "groups"), group);
  return map && !strcmp(get_text(map, "kind", ""), kind);
}

static int check_walls(const sph_case *c, const sph_case_node *walls)
{
  for (const sph_case_node *wall = walls ? walls->first : NULL; wall; wall = wall->next) {
    const sph_case_node *group = child_of(child_of(c->root, "groups"), wall->key);
    if (!kind_is(c, wall->key, "wall"))
      return FAIL(wall, "walls: there is no wall '%.60s'", wall->key);
    if (child_of(wall, "rotation"))
      return FAIL(child_of(wall, "rotation"),
                  "walls: an event changes velocities; a rotation goes on as the group has it");
    if (!child_of(child_of(group, "boundary"), "motion"))
      return FAIL(wall,
                  "walls: '%.60s' has no motion to change; give it one, boundary: {motion: "
                  "{velocity: ...}}, zero if it is at rest",
                  wall->key);
  }
  return SPH_OK;
}

static int check_properties(const sph_case *c, const sph_case_node *groups)
{
  static const char *const wants[][2] = {{"viscosity", "viscosity-laminar"},
                                         {"conductivity", "conduction"}};
  for (const sph_case_node *one = groups ? groups->first : NULL; one; one = one->next) {
    if (!child_of(child_of(c->root, "groups"), one->key))
      return FAIL(one, "groups: there is no group '%.60s'", one->key);
    for (int k = 0; k < 2; k++)
      if (child_of(one, wants[k][0]) && !child_of(child_of(c->root, "terms"), wants[k][1]))
        return FAIL(child_of(one, wants[k][0]), "change: the case has no term '%s'", wants[k][1]);
  }
  return SPH_OK;
}

static int is_group(const char *key) { return !strcmp(key, "walls") || !strcmp(key, "groups"); }

static int check_change(const sph_case *c, const sph_case_node *change)
{
  const sph_case_node *terms = child_of(c->root, "terms"), *node = change->first;
  if (!node) return FAIL(change, "change: found nothing to change");
  for (; node; node = node->next)
    if (!is_group(node->key) && !child_of(terms, node->key))
      return FAIL(node, "change: the case has no term '%.60s'", node->key);
  int status = check_properties(c, child_of(change, "groups"));
  return status ? status : check_walls(c, child_of(change, "walls"));
}

static int check_group(const sph_case *c, const sph_case_node *group)
{
  if (!group || kind_is(c, group->text, "fluid")) return SPH_OK;
  return FAIL_VALUE(group, "group: there is no fluid '%.60s'", group->text);
}

static int check_axis(const sph_case *c, const sph_case_node *axis)
{
  if (!axis || axis->text[0] - 'x' < c->dim) return SPH_OK;
  return FAIL_VALUE(axis, "axis: there is no %s in %d dimension%s", axis->text, c->dim,
                    c->dim == 1 ? "" : "s");
}

/* J, in 2D J/m, in 1D J/m^2. */
static int check_level(const sph_case *c, const sph_case_node *level)
{
  static const char *const unit[] = {"J/m^2", "J/m", "J"};
  sph_case_value value;
  double off = 0, dimension = 0;
  char got[80];
  if (!level || sph_case_value_evaluate(level->text, c->names, c->n, &value)) return SPH_OK;
  const double energy[SPH_SI_BASES] = {1, c->dim - 1, -2};
  for (int b = 0; b < SPH_SI_BASES; b++) {
    dimension += fabs(value.power[b]);
    off += fabs(value.power[b] - energy[b]);
  }
  if (dimension == 0 || off < 1e-6) return SPH_OK;
  sph_si_unit_write(value.power, got, sizeof got);
  return FAIL_VALUE(level, "level: found %s, wanted %s, an energy in %d dimension%s", got,
                    unit[c->dim - 1], c->dim, c->dim == 1 ? "" : "s");
}

int sph_case_event_check(const sph_case *c)
{
  const sph_case_node *events = child_of(c->root, "events");
  int status = SPH_OK;
  for (const sph_case_node *e = events ? events->first : NULL; e && !status; e = e->next) {
    const sph_case_node *front = child_of(child_of(e, "when"), "front");
    const sph_case_node *change = child_of(e, "change");
    status = check_group(c, child_of(front, "group"));
    if (!status) status = check_axis(c, child_of(front, "axis"));
    if (!status)
      status = check_level(c, child_of(child_of(child_of(e, "when"), "energy"), "level"));
    if (!status && change) status = check_change(c, change);
  }
  return status;
}

/* ---- changes */

enum { TERMS_MAX = 8, NAME_MAX = 64 };

typedef struct changes {
  int terms, groups, walls;
  struct {
    sph_term term;
    char form[NAME_MAX];
  } of_term[TERMS_MAX];
  struct {
    char name[NAME_MAX];
    double viscosity, conductivity; /* NaN: stays */
  } of_group[SPH_SETS_MAX];
  struct {
    sph_case_motion *motion, next;
  } of_wall[SPH_SETS_MAX];
} changes;

static int apply(void *ctx, sph_sim *sim)
{
  const changes *all = ctx;
  for (int k = 0; k < all->walls; k++)
    sph_case_motion_change(all->of_wall[k].motion, sph_sim_time(sim), &all->of_wall[k].next);
  for (int k = 0; k < all->groups; k++) {
    sph_group *group = sph_sim_group(sim, all->of_group[k].name);
    if (!isnan(all->of_group[k].viscosity))
      sph_group_set_viscosity(group, all->of_group[k].viscosity);
    if (!isnan(all->of_group[k].conductivity))
      sph_group_set_conductivity(group, all->of_group[k].conductivity);
  }
  for (int k = 0; k < all->terms; k++) sph_sim_change_term(sim, all->of_term[k].term);
  return SPH_OK;
}

/* The term as it stands above, with a new strength. */
static void add_term(changes *all, const sph_case *c, const sph_case_node *node)
{
  sph_term *term = &all->of_term[all->terms].term;
  char *form = all->of_term[all->terms++].form;
  *term = sph_case_build_term(child_of(child_of(c->root, "terms"), node->key));
  if (term->form) {
    snprintf(form, NAME_MAX, "%s", term->form);
    term->form = form;
  }
  if (!strcmp(node->key, "gravity"))
    for (int d = 0; d < 3; d++) term->g[d] = 0;
  int d = 0;
  for (const sph_case_node *g = node->first; g; g = g->next) term->g[d++] = g->number;
  if (!strcmp(node->key, "harmonic"))
    term->omega = node->number;
  else if (!strcmp(node->key, "delta"))
    term->delta = node->number;
  else if (!strcmp(node->key, "xsph"))
    term->epsilon = node->number;
  else if (strcmp(node->key, "gravity"))
    term->alpha = node->number;
}

static void add_wall(changes *all, const sph_case_motions *motions, const sph_case_node *wall)
{
  for (int k = 0; k < motions->n; k++) {
    if (strcmp(motions->of[k].group, wall->key)) continue;
    sph_case_motion *next = &all->of_wall[all->walls].next;
    all->of_wall[all->walls++].motion = motions->of[k].motion;
    get_vector(wall, "velocity", next->velocity);
    next->slide = get_number(wall, "slide", 0) != 0;
  }
}

static changes *changes_of(const sph_case *c, const sph_case_motions *motions,
                           const sph_case_node *map, sph_error *error)
{
  changes *all = SPH_NEW(changes, 1, "the changes of an event", error);
  if (!all) return NULL;
  for (const sph_case_node *node = map->first; node; node = node->next)
    if (!is_group(node->key)) add_term(all, c, node);
  const sph_case_node *groups = child_of(map, "groups");
  for (const sph_case_node *one = groups ? groups->first : NULL; one; one = one->next) {
    snprintf(all->of_group[all->groups].name, NAME_MAX, "%s", one->key);
    all->of_group[all->groups].viscosity = get_number(one, "viscosity", NAN);
    all->of_group[all->groups++].conductivity = get_number(one, "conductivity", NAN);
  }
  const sph_case_node *walls = child_of(map, "walls");
  for (const sph_case_node *wall = walls ? walls->first : NULL; wall; wall = wall->next)
    add_wall(all, motions, wall);
  return all;
}

/* ---- events */

static void occasion_of(const sph_case_node *when, sph_event *event)
{
  const sph_case_node *what = when->first;
  event->type = what->key;
  if (!strcmp(what->key, "front")) {
    event->group = get_text(what, "group", NULL);
    event->axis = get_text(what, "axis", "x")[0] - 'x';
    event->threshold = get_number(what, "at", 0);
  } else if (!strcmp(what->key, "energy")) {
    event->quantity = get_text(what, "quantity", NULL);
    event->threshold = get_number(what, "level", 0);
  } else if (what->kind == SPH_CASE_LIST) { /* wet, dry */
    get_vector(when, what->key, event->x);
  } else {
    event->threshold = what->number;
  }
}

static int add_event(const sph_case *c, sph_sim *sim, const sph_case_motions *motions,
                     const sph_case_node *map, sph_error *error)
{
  const sph_case_node *change = child_of(map, "change");
  sph_event event = {.name = map->key,
                     .direction = get_text(map, "direction", NULL),
                     .samples = (int)get_number(map, "samples", 0),
                     .once = get_number(map, "once", 0) != 0,
                     .snapshot = get_number(map, "snapshot", 0) != 0,
                     .stop = get_number(map, "stop", 0) != 0};
  occasion_of(child_of(map, "when"), &event);
  if (change) {
    event.ctx = changes_of(c, motions, change, error);
    if (!event.ctx) return SPH_ERR_MEMORY;
    event.change = apply;
    event.free = sph_memory_free;
  }
  sph_sim_add_event(sim, &event);
  if (sph_sim_status(sim) == SPH_OK) return SPH_OK;
  return sph_case_schema_fail(c, error, map, 0, 0, "%s", sph_sim_error(sim));
}

/* ---- in words */

static void add_numbers(sph_text *text, const sph_case_node *node)
{
  const sph_case_node *one = node->kind == SPH_CASE_LIST ? node->first : NULL;
  if (!one) sph_text_add(text, "%g", node->number);
  for (; one; one = one->next)
    sph_text_add(text, "%s%g%s", one == node->first ? "(" : ", ", one->number,
                 one->next ? "" : ")");
}

static void tell_occasion(sph_text *text, const sph_case *c, const sph_case_node *when)
{
  static const char *const unit[] = {"J/m^2", "J/m", "J"};
  const sph_case_node *what = when->first;
  if (!strcmp(what->key, "front"))
    sph_text_add(text, "the front of %s passes %s = %g m", get_text(what, "group", "all fluids"),
                 get_text(what, "axis", "x"), get_number(what, "at", 0));
  else if (!strcmp(what->key, "energy"))
    sph_text_add(text, "the %s energy passes %g %s", get_text(what, "quantity", "total"),
                 get_number(what, "level", 0), unit[c->dim - 1]);
  else if (!strcmp(what->key, "steady"))
    sph_text_add(text, "the rates pass %g 1/s", what->number);
  else if (!strcmp(what->key, "time"))
    sph_text_add(text, "t = %g s", what->number);
  else {
    add_numbers(text, what);
    sph_text_add(text, " m becomes %s", what->key);
  }
}

/* Of a term: what stands there, and what comes. */
static void tell_strength(sph_text *text, const sph_case *c, const sph_case_node *next)
{
  static const char *const of[] = {"acceleration", "omega", "alpha", "epsilon", "delta"};
  const sph_case_node *term = child_of(child_of(c->root, "terms"), next->key), *now = NULL;
  for (int k = 0; k < 5 && !now; k++) now = child_of(term, of[k]);
  sph_text_add(text, ", %s ", next->key);
  if (now) add_numbers(text, now);
  sph_text_add(text, " -> ");
  add_numbers(text, next);
}

static void tell_change(sph_text *text, const sph_case *c, const sph_case_node *change)
{
  for (const sph_case_node *next = change ? change->first : NULL; next; next = next->next) {
    if (!is_group(next->key)) {
      tell_strength(text, c, next);
      continue;
    }
    for (const sph_case_node *group = next->first; group; group = group->next)
      for (const sph_case_node *key = group->first; key; key = key->next) {
        if (key->origin && !strcmp(key->origin, "default")) continue;
        sph_text_add(text, ", %s of %s -> ", key->key, group->key);
        add_numbers(text, key);
      }
  }
}

int sph_case_event_text(const sph_case *c, int k, char *to, size_t size)
{
  const sph_case_node *events = c ? child_of(c->root, "events") : NULL;
  const sph_case_node *e = events && k >= 0 ? events->first : NULL;
  for (; e && k > 0; k--) e = e->next;
  if (!e) return 0;
  sph_text text = {0}, does = {0};
  const char *direction = get_text(e, "direction", "");
  if (get_number(e, "snapshot", 0) != 0) sph_text_add(&does, ", snapshot");
  tell_change(&does, c, child_of(e, "change"));
  if (get_number(e, "stop", 0) != 0) sph_text_add(&does, ", stop");
  sph_text_add(&text, "%s: ", e->key);
  tell_occasion(&text, c, child_of(e, "when"));
  sph_text_add(&text, "%s%s%s: %s", *direction ? ", " : "", direction,
               get_number(e, "once", 0) != 0 ? ", once" : "",
               does.data ? does.data + 2 : "a row of events.csv");
  if (size) snprintf(to, size, "%s", text.data ? text.data : "");
  sph_text_free(&text);
  sph_text_free(&does);
  return 1;
}

int sph_case_event_add(const sph_case *c, sph_sim *sim, const sph_case_motions *motions,
                       sph_error *error)
{
  const sph_case_node *events = child_of(c->root, "events");
  int status = SPH_OK;
  for (const sph_case_node *e = events ? events->first : NULL; e && !status; e = e->next)
    status = add_event(c, sim, motions, e, error);
  return status;
}
