#include "sim_parameter.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "sim_prepare.h"
#include "words.h"

/* ---- what there is ---- */

/* Numbers of built-in pair terms; those of a term that does nothing are not there. */
static const struct {
  const char *name;
  unsigned bits;
  size_t offset; /* in sph_term_set */
  unsigned acts;
} term_numbers[] = {
    {"viscosity-artificial.alpha", SPH_ARTIFICIAL, offsetof(sph_term_set, alpha), 0},
    {"viscosity-artificial.beta", SPH_ARTIFICIAL, offsetof(sph_term_set, beta), 0},
    {"viscosity-signal.alpha", SPH_SIGNAL, offsetof(sph_term_set, signal_alpha), 0},
    {"viscosity-signal.beta", SPH_SIGNAL, offsetof(sph_term_set, signal_beta), 0},
    {"conductivity-artificial.alpha", SPH_CONDUCTIVITY, offsetof(sph_term_set, alpha_u), 0},
    {"delta.delta", SPH_DIFFUSION, offsetof(sph_term_set, delta), SPH_ACTS_RATES},
    {"xsph.epsilon", SPH_XSPH, offsetof(sph_term_set, epsilon), 0},
    {"drag.K", SPH_DRAG, offsetof(sph_term_set, drag_K), 0},
    {"drag.rate", SPH_DRAG, offsetof(sph_term_set, drag_rate), 0}, /* 1/stopping time */
    {"gravity.x", 0, offsetof(sph_term_set, g), SPH_ACTS_WALLS | SPH_ACTS_RATES},
    {"gravity.y", 0, offsetof(sph_term_set, g) + sizeof(double), SPH_ACTS_WALLS | SPH_ACTS_RATES},
    {"gravity.z", 0, offsetof(sph_term_set, g) + 2 * sizeof(double),
     SPH_ACTS_WALLS | SPH_ACTS_RATES},
};
enum { TERM_NUMBERS = sizeof term_numbers / sizeof *term_numbers };

static const struct {
  const char *name;
  size_t offset; /* in sph_eos */
} eos_numbers[] = {
    {"c0", offsetof(sph_eos, c0)},       {"rho0", offsetof(sph_eos, rho0)},
    {"gamma", offsetof(sph_eos, gamma)}, {"p_background", offsetof(sph_eos, p_background)},
    {"p_inf", offsetof(sph_eos, p_inf)}, {"q", offsetof(sph_eos, q)},
    {"slope", offsetof(sph_eos, slope)}, {"grueneisen", offsetof(sph_eos, grueneisen)},
    {"c_v", offsetof(sph_eos, c_v)},
};
enum { EOS_NUMBERS = sizeof eos_numbers / sizeof *eos_numbers };

static double *number_of(void *at, size_t offset)
{
  void *number = (char *)at + offset;
  return number;
}

static int same_eos(const sph_eos *a, const sph_eos *b)
{
  if (a->pressure != b->pressure || a->ctx != b->ctx) return 0;
  for (int k = 0; k < EOS_NUMBERS; k++)
    if (*number_of((sph_eos *)a, eos_numbers[k].offset) !=
        *number_of((sph_eos *)b, eos_numbers[k].offset))
      return 0;
  return 1;
}

/* ---- the search ---- */

typedef struct search {
  sph_sim *sim;
  sph_parameter *found;
  sph_words words; /* wanted NULL: by number */
  int number;      /* wanted; counted down */
  int hit;
} search;

/* One parameter that there is: is it the one? */
static int offer(search *s, double *value, double scale, const char *format, const char *a,
                 const char *b)
{
  char name[SPH_PARAMETER_NAME_MAX];
  snprintf(name, sizeof name, format, a, b);
  if (s->words.wanted) sph_words_add(&s->words, name);
  int it = s->words.wanted ? !strcmp(name, s->words.wanted) : s->number-- == 0;
  if (!it) return 0;
  *s->found = (sph_parameter){.value = value, .scale = *value != 0 ? fabs(*value) : scale};
  snprintf(s->found->name, sizeof s->found->name, "%s", name);
  return s->hit = 1;
}

static void offer_group(search *s, sph_group *group)
{
  const unsigned terms = s->sim->loop_terms;
  if (group->viscosity > 0 && (terms & (SPH_MORRIS | SPH_MCG)))
    offer(s, &group->viscosity, 0, "%s.%s", group->name, "viscosity");
  if (group->conductivity > 0 && (terms & SPH_CONDUCTION))
    offer(s, &group->conductivity, 0, "%s.%s", group->name, "conductivity");
  if (group->wall && group->boundary.temperature > 0 && !group->boundary.temperature_at)
    offer(s, &group->boundary.temperature, 0, "%s.%s", group->name, "temperature");
  for (int k = 0; k < EOS_NUMBERS && !group->wall; k++) {
    double *value = number_of(&group->eos, eos_numbers[k].offset);
    if (*value == 0 && strcmp(eos_numbers[k].name, "p_background")) continue; /* not one of its */
    double scale = group->eos.rho0 * group->eos.c0 * group->eos.c0;
    if (!offer(s, value, scale > 0 ? scale : 1, "%s.%s", group->name, eos_numbers[k].name))
      continue;
    s->found->eos_member = eos_numbers[k].offset;
    s->found->acts = SPH_ACTS_ALL;
    for (int g = 0; g < s->sim->groups; g++)
      s->found->shares[g] = same_eos(&s->sim->group[g]->eos, &group->eos) != 0;
  }
}

static void look(search *s)
{
  sph_sim *sim = s->sim;
  if (offer(s, &sim->h, 0, "%s%s", "h", "")) {
    s->found->is_h = 1;
    s->found->acts = SPH_ACTS_RATES; /* walls take ratios of sums */
  }
  for (int k = 0; k < TERM_NUMBERS; k++) {
    double *value = number_of(&sim->terms, term_numbers[k].offset);
    int there = term_numbers[k].bits ? (sim->loop_terms & term_numbers[k].bits) != 0
                                     : sim->part[SPH_WHOLE].gravity;
    if (term_numbers[k].bits == SPH_DRAG && *value == 0) continue; /* it is the other one */
    if (there && offer(s, value, 1, "%s%s", term_numbers[k].name, ""))
      s->found->acts = term_numbers[k].acts;
  }
  for (int k = 0; k < sim->terms.called; k++)
    if (sim->terms.call[k].term.omega != 0 &&
        offer(s, &sim->terms.call[k].term.omega, 1, "%s.%s", sim->terms.call[k].name, "omega"))
      s->found->acts = SPH_ACTS_RATES;
  for (int g = 0; g < sim->groups; g++) offer_group(s, sim->group[g]);
}

int sph_sim_parameter_get(sph_sim *sim, int k, sph_parameter *parameter)
{
  search s = {.sim = sim, .found = parameter, .number = k};
  if (k >= 0 && !sph_sim_prepare(sim)) look(&s);
  return s.hit;
}

int sph_sim_parameter_find(sph_sim *sim, const char *name, sph_parameter *parameter)
{
  search s = {.sim = sim, .found = parameter, .words.wanted = name ? name : ""};
  int status = sph_sim_prepare(sim);
  if (status) return status;
  look(&s);
  if (s.hit) return SPH_OK;
  return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "parameter \"%.80s\" is unknown here; %sknown: %s",
                      s.words.wanted, s.words.nearest, s.words.known);
}

void sph_sim_parameter_own(const char *name, double *value, sph_parameter *parameter)
{
  *parameter = (sph_parameter){.value = value,
                               .scale = *value != 0 ? fabs(*value) : 1,
                               .acts = SPH_ACTS_ALL,
                               .is_own = 1};
  snprintf(parameter->name, sizeof parameter->name, "%s", name);
}

void sph_sim_parameter_set(sph_sim *sim, const sph_parameter *parameter, double value)
{
  if (!parameter->value) return;
  *parameter->value = value;
  for (int g = 0; parameter->eos_member && g < sim->groups; g++)
    if (parameter->shares[g]) *number_of(&sim->group[g]->eos, parameter->eos_member) = value;
  if (parameter->is_h) sph_sim_prepare_h(sim);
}
