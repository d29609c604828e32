#include "term_set.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int not_below_zero(const char *term, const char *name, double value, sph_error *error)
{
  if (isfinite(value) && value >= 0) return SPH_OK;
  return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: %s = %g; right is a finite number >= 0",
                       term, name, value);
}

/* A second term of the same kind would silently replace the first. */
static int claim(sph_term_set *set, unsigned bit, const char *name, sph_error *error)
{
  if (set->bits & bit) return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: added twice", name);
  set->bits |= bit;
  return SPH_OK;
}

static int add_form(sph_term_set *set, unsigned bit, const sph_term *term, const char *other,
                    sph_error *error)
{
  if (!term->form || !strcmp(term->form, "c2"))
    set->form_c2 |= bit;
  else if (!strcmp(term->form, other))
    set->form_c1 |= bit;
  else
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: form \"%s\"; known: c2, %s", term->name,
                         term->form, other);
  return claim(set, bit, term->name, error);
}

static int add_viscosity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "alpha", term->alpha, error);
  if (!status) status = not_below_zero(term->name, "beta", term->beta, error);
  if (!status) status = claim(set, SPH_ARTIFICIAL, term->name, error);
  set->alpha = term->alpha;
  set->beta = term->beta;
  return status;
}

static int add_conductivity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int status = not_below_zero(term->name, "alpha", term->alpha, error);
  if (!status) status = claim(set, SPH_CONDUCTIVITY, term->name, error);
  set->alpha_u = term->alpha;
  return status;
}

static int add_delta(sph_term_set *set, const sph_term *term, sph_error *error)
{
  unsigned bit = 0;
  if (term->form && !strcmp(term->form, "molteni")) bit = SPH_MOLTENI;
  if (term->form && !strcmp(term->form, "antuono")) bit = SPH_ANTUONO;
  if (!bit)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term delta: model \"%s\"; known: molteni, antuono",
                         term->form ? term->form : "");
  int status = not_below_zero(term->name, "delta", term->delta, error);
  if (!status && (set->bits & (SPH_MOLTENI | SPH_ANTUONO)))
    status = sph_error_set(error, SPH_ERR_ARGUMENT, "term delta: added twice");
  set->bits |= bit;
  set->delta = term->delta;
  return status;
}

static int add_gravity(sph_term_set *set, const sph_term *term, sph_error *error)
{
  for (int d = 0; d < 3; d++) {
    if (!isfinite(term->g[d]))
      return sph_error_set(error, SPH_ERR_ARGUMENT, "term gravity: g[%d] = %g is not finite", d,
                           term->g[d]);
    set->g[d] += term->g[d];
  }
  return SPH_OK;
}

static int add_body(sph_term_set *set, const sph_term *term, sph_error *error)
{
  if (!term->body)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term \"%s\": not a built-in one and without a body function", term->name);
  if (!isfinite(term->omega))
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: omega = %g is not finite", term->name,
                         term->omega);
  if (set->bodies == SPH_BODY_TERMS_MAX)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: more than %d body terms", term->name,
                         SPH_BODY_TERMS_MAX);
  int k = set->bodies++;
  snprintf(set->name[k], sizeof set->name[k], "%s", term->name);
  set->body[k] = *term;
  set->body[k].name = set->name[k];
  set->body[k].form = NULL;
  return SPH_OK;
}

static int add(sph_term_set *set, const sph_term *term, sph_error *error)
{
  if (!term->name || !*term->name)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a term without a name");
  if (term->body) return add_body(set, term, error);
  if (!strcmp(term->name, "continuity")) return add_form(set, SPH_CONTINUITY, term, "c1", error);
  if (!strcmp(term->name, "pressure")) return add_form(set, SPH_PRESSURE_FORCE, term, "s", error);
  if (!strcmp(term->name, "viscosity-artificial")) return add_viscosity(set, term, error);
  if (!strcmp(term->name, "conductivity-artificial")) return add_conductivity(set, term, error);
  if (!strcmp(term->name, "delta")) return add_delta(set, term, error);
  if (!strcmp(term->name, "gravity")) return add_gravity(set, term, error);
  return add_body(set, term, error);
}

int sph_term_set_add(sph_term_set *set, const sph_term *term, sph_error *error)
{
  int bodies = set->bodies, status = add(set, term, error);
  if (set->bodies == bodies && term->free) term->free(term->ctx); /* not kept */
  return status;
}

int sph_term_set_check(const sph_term_set *set, sph_error *error)
{
  if (set->form_c2 && set->form_c1)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "continuity and pressure of different rows do not conserve energy: "
                         "use c2 with c2, or c1 with s");
  return SPH_OK;
}

void sph_term_set_free(sph_term_set *set)
{
  for (int k = 0; k < set->bodies; k++)
    if (set->body[k].free) set->body[k].free(set->body[k].ctx);
  set->bodies = 0;
}

double sph_term_set_potential(const sph_term_set *set, const double x[3])
{
  double potential = 0;
  for (int d = 0; d < 3; d++) potential -= set->g[d] * x[d];
  for (int k = 0; k < set->bodies; k++)
    if (set->body[k].potential) potential += set->body[k].potential(&set->body[k], x);
  return potential;
}
