/* Controllers of the step size as digital filters (Soederlind 2003), k = order:
 *   h_new = h x,  x = e_n^(-beta_1/k) e_(n-1)^(-beta_2/k) e_(n-2)^(-beta_3/k) (h/h_last)^(-alpha)
 * e: errors over the tolerance, ~ h^k.  Where nothing is remembered, e = 1 and h/h_last = 1. */
#include "controller.h"

#include <math.h>
#include <string.h>

#include "words.h"

static const sph_controller table[] = {
    {.name = "i", .beta = {1}},
    {.name = "pi", .beta = {0.6, -0.2}},                    /* PI42: Soederlind & Wang (2006) */
    {.name = "gustafsson", .beta = {0.7, -0.4}},            /* PI34: Gustafsson (1991) */
    {.name = "pid", .beta = {1.0 / 18, 1.0 / 9, 1.0 / 18}}, /* H312PID: Soederlind (2003) */
    {.name = "h211", .beta = {0.25, 0.25}, .alpha = 0.25},  /* H211b, b = 4: the same */
};
enum { CONTROLLERS = sizeof table / sizeof *table };

const char *sph_controller_name(int k) { return k >= 0 && k < CONTROLLERS ? table[k].name : NULL; }

const sph_controller *sph_controller_find(const char *name, sph_error *error)
{
  sph_words words = {.wanted = name};
  for (int k = 0; k < CONTROLLERS; k++) {
    if (!strcmp(name, table[k].name)) return &table[k];
    sph_words_add(&words, table[k].name);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "integrator: controller \"%.40s\"; %sknown: %s", name,
                words.nearest, words.known);
  return NULL;
}

int sph_controller_remembers(const sph_controller *c)
{
  return c->beta[1] != 0 || c->beta[2] != 0 || c->alpha != 0;
}

void sph_controller_forget(sph_controller_past *past)
{
  *past = (sph_controller_past){.error = {1, 1}};
}

double sph_controller_next(const sph_controller *c, int order, double h, double error,
                           sph_controller_past *past)
{
  const double e[3] = {fmax(error, 1e-10), past->error[0], past->error[1]};
  double x = 1;
  if (!(error < INFINITY)) return h / 10;
  for (int i = 0; i < 3; i++) x *= pow(e[i], -c->beta[i] / order);
  if (past->h > 0) x *= pow(h / past->h, -c->alpha);
  if (error <= 1) *past = (sph_controller_past){.error = {e[0], e[1]}, .h = h};
  return h * (c->limited ? 1 + atan(x - 1) : x);
}
