/* An interaction (target <- source): which terms act, with which constants, and in which loop. */
#include <math.h>
#include <string.h>

#include "fluid_loops.h"
#include "sim_rhs.h"
#include "tile_loops.h"

/* A wall around two liquids has the density of one: diffusion would tear off the other. */
int sph_sim_interaction_same_fluid(const sph_group *target, const sph_group *source)
{
  return sph_sim_interaction_same_species(target, source) && source->eos.rho0 == target->eos.rho0 &&
         source->eos.c0 == target->eos.c0;
}

int sph_sim_interaction_same_species(const sph_group *target, const sph_group *source)
{
  return target == source || (!target->eos.dust && !source->eos.dust);
}

int sph_sim_interaction_listed(const sph_sim *sim, const sph_group *target, const sph_group *source)
{
  if (target->wall && (source->wall || target->model == SPH_MODEL_MIRROR)) return 0;
  return sph_sim_interaction_same_species(target, source) || sph_sim_drag_acts(sim, target, source);
}

static unsigned terms_of(const sph_part *part, const sph_group *target, const sph_group *source)
{
  unsigned terms = part->terms;
  if (!sph_sim_interaction_same_species(target, source)) return 0;
  if (target->eos.dust) /* without gradient matrices */
    return terms & (SPH_CONTINUITY | SPH_FORM_C2 | SPH_FORM_PHI | SPH_THERMAL);
  if (!sph_sim_interaction_same_fluid(target, source)) terms &= ~(unsigned)SPH_DIFFUSION;
  if (!source->wall) return terms;
  if (source->model == SPH_MODEL_MIRROR) /* all of them, as with the fluid */
    return terms | SPH_WALL |
           (source->boundary.no_slip && ((terms & SPH_VISCOUS) || part->tiles) ? SPH_NO_SLIP : 0);
  terms &= ~(unsigned)(SPH_CONDUCTIVITY | SPH_XSPH);
  if (!sph_group_data_isothermal(source)) terms &= ~(unsigned)SPH_CONDUCTION; /* adiabatic */
  if (!source->boundary.no_slip)
    terms &= ~(unsigned)(SPH_VISCOUS | SPH_SWITCHES);
  else if ((terms & SPH_VISCOUS) || part->tiles)
    terms |= SPH_NO_SLIP;
  return terms | SPH_WALL;
}

/* 2 a b/(a + b); 0 where one of them is. */
static double harmonic(double a, double b) { return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0; }

/* Viscosity of the fluid itself at a wall; conductivity too unless the wall has its own. */
static void material(const sph_sim *sim, const sph_group *i, const sph_group *j, fluid_constants *k)
{
  double eta = j->wall ? i->viscosity : j->viscosity;
  double kappa = j->wall && j->conductivity == 0 ? i->conductivity : j->conductivity;
  k->laminar = i->viscosity + eta;
  if (k->terms & SPH_MCG) k->laminar = 2 * (sim->dim + 2) * harmonic(i->viscosity, eta);
  k->conduction = 2 * harmonic(i->conductivity, kappa);
}

/* Not of a gas: it is denser at walls than on its lattice. */
static void repulsion(const sph_sim *sim, const sph_group *i, const sph_group *j,
                      fluid_constants *k)
{
  const double unit = i->eos.c0 / sim->dx;
  k->range = 0.8 * sim->dx;
  if (j->wall && j->model == SPH_MODEL_ADAMI && !i->eos.thermal)
    k->repulsion = j->repulsion * unit * unit / sim->F_scale;
}

/* Series of (1 + x)^(1/gamma) - 1 for Fourtakas' diffusion, x = column . r. */
static void column(const sph_sim *sim, const sph_eos *eos, fluid_constants *k)
{
  k->rho0 = eos->rho0;
  for (int d = 0; d < 3; d++) k->column[d] = -eos->gamma * sim->terms.g[d] / (eos->c0 * eos->c0);
  for (int n = 0; n < SPH_FOURTAKAS_TERMS; n++) k->series[n] = (1 / eos->gamma - n) / (n + 1);
}

fluid_constants sph_sim_interaction_constants(const sph_sim *sim, const sph_part *part,
                                              const sph_group *target, const sph_group *source)
{
  const sph_term_set *set = &sim->terms;
  const double h = sim->h;
  fluid_constants k = {.terms = terms_of(part, target, source),
                       .kernel = sim->kernel_number,
                       .inverse_h = 1 / h,
                       .eta2 = 0.01 * h * h,
                       .viscosity_1 = -set->alpha * h,
                       .viscosity_2 = 2 * set->beta * h * h,
                       .signal_1 = -set->signal_alpha,
                       .signal_2 = set->signal_beta,
                       .alpha_u = set->alpha_u,
                       .epsilon = set->epsilon,
                       .stress_tension = set->stress_alpha,
                       .stress_pressure = set->stress_beta};
  k.other = source->wall && source->model != SPH_MODEL_MIRROR ? 0 : 0.5;
  k.own = 1 - k.other;
  material(sim, target, source, &k);
  repulsion(sim, target, source, &k);
  if (k.laminar == 0) k.terms &= ~(unsigned)(SPH_MORRIS | SPH_MCG);
  if (k.conduction == 0) k.terms &= ~(unsigned)SPH_CONDUCTION;
  if ((k.terms & SPH_ARTIFICIAL) && set->beta != 0) k.terms |= SPH_QUADRATIC;
  if (k.terms & SPH_STRESS)
    k.inverse_w_dx = sim->W_scale / sph_kernel_w(sim->kernel, sim->dim, sim->dx, h);
  k.terms = (k.terms & ~(unsigned)SPH_CORRECTED) | fluid_corrections(k.terms);
  if (k.terms & SPH_FOURTAKAS) column(sim, &target->eos, &k);
  return k;
}

tile_constants sph_sim_interaction_tile(const sph_evaluation *e, const fluid_constants *fluid,
                                        int target, int source)
{
  const sph_sim *sim = e->sim;
  const sph_part *part = e->part;
  tile_constants k = {.fluid = *fluid,
                      .F_scale = sim->F_scale,
                      .t = e->t,
                      .h = sim->h,
                      .target = sim->group[target]->name,
                      .source = sim->group[source]->name,
                      .scalars = sim->terms.scalars,
                      .isothermal = sph_group_data_isothermal(sim->group[source]) ||
                                    sim->group[source]->model == SPH_MODEL_MIRROR,
                      .fields = part->tile_fields,
                      .adds = part->tile_adds,
                      .show = part->tile_show,
                      .terms = part->tiles};
  memcpy(k.term, part->tile, sizeof k.term);
  return k;
}

static void add_tiles(const sph_evaluation *e, const sph_share *share, int target, int source,
                      const fluid_constants *fluid, unsigned fused)
{
  tile_constants k = sph_sim_interaction_tile(e, fluid, target, source);
  k.fused = fused;
  sph_sim_pairs_loop_share(e->sim, share,
                           sph_tile_loop(e->sim->isa, e->sim->kernel_number, e->sim->dim, fused),
                           target, source, &k);
}

void sph_sim_interaction_tiles(const sph_evaluation *e, const sph_share *share, int target,
                               int source)
{
  const sph_sim *sim = e->sim;
  const fluid_constants fluid =
      sph_sim_interaction_constants(sim, e->part, sim->group[target], sim->group[source]);
  add_tiles(e, share, target, source, &fluid, 0);
}

void sph_sim_interaction_add(const sph_evaluation *e, const sph_share *share, int target,
                             int source)
{
  const sph_sim *sim = e->sim;
  const fluid_constants k =
      sph_sim_interaction_constants(sim, e->part, sim->group[target], sim->group[source]);
  const int tiles = e->part->tiles && !sim->group[target]->eos.dust;
  const int acts = (k.terms & SPH_PAIR_TERMS) != 0, together = tiles && !(k.terms & SPH_RARE);
  if (acts && !together)
    sph_sim_pairs_loop_share(sim, share,
                             sph_fluid_loop(sim->isa, sim->kernel_number, sim->dim, k.terms),
                             target, source, &k);
  if (tiles) add_tiles(e, share, target, source, &k, together && acts ? k.terms : 0);
}

/* ---- which fields tiles hold ---- */

static int field_number(const sph_sim *sim, const char *name)
{
  static const char *const names[] = {[SPH_TILE_DENSITY] = "density",
                                      [SPH_TILE_PRESSURE] = "pressure",
                                      [SPH_TILE_SOUND_SPEED] = "sound_speed",
                                      [SPH_TILE_ENERGY] = "energy",
                                      [SPH_TILE_TEMPERATURE] = "temperature"};
  for (int f = 0; f < SPH_TILE_SCALAR; f++)
    if (!strcmp(name, names[f])) return f;
  int scalar = sph_term_set_scalar(&sim->terms, name);
  return scalar < 0 ? -1 : SPH_TILE_SCALAR + scalar;
}

/* Bit of a name among some, or 0. */
static unsigned bit_of(const char *word, const char *const *names, int n)
{
  for (int k = 0; k < n; k++)
    if (!strcmp(word, names[k])) return 1u << k;
  return 0;
}

static int read_field(sph_sim *sim, sph_part *part, const char *term, const char *word,
                      sph_tile_term *tile)
{
  int field = field_number(sim, word);
  if (field < 0)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "term %s reads \"%.60s\"; known: density, pressure, sound_speed, energy, "
                        "temperature, scalars of terms, and of the pair r, v, r2, rv, v_viscous, "
                        "rv_viscous, F, V, m",
                        term, word);
  if ((field == SPH_TILE_ENERGY || field == SPH_TILE_TEMPERATURE) &&
      !(sim->loop_terms & SPH_THERMAL))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "term %s reads %s, which no fluid has", term, word);
  if (tile->reads == SPH_TILE_READS)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT, "term %s reads more than %d fields", term,
                        SPH_TILE_READS);
  tile->read[tile->reads++] = (unsigned char)field;
  part->tile_fields |= 1u << field;
  sim->needs_temperature |= field == SPH_TILE_TEMPERATURE;
  return SPH_OK;
}

/* "density sound_speed r2 F": the fields of one term, and what it reads of the pair. */
static int read_reads(sph_sim *sim, sph_part *part, const sph_called_term *call,
                      sph_tile_term *tile)
{
  static const char *const of_pair[] = {"r",          "v", "r2", "rv", "v_viscous",
                                        "rv_viscous", "F", "V",  "m"}; /* enum sph_tile_show */
  char text[SPH_TERM_READS_MAX], *rest = NULL;
  unsigned show = 0;
  int status = SPH_OK;
  memcpy(text, call->reads, sizeof text);
  for (char *word = strtok_r(text, " ,", &rest); word && !status;
       word = strtok_r(NULL, " ,", &rest)) {
    const int field = field_number(sim, word); /* a scalar may have the name of one of a pair */
    const unsigned bit = field < 0 ? bit_of(word, of_pair, sizeof of_pair / sizeof *of_pair) : 0;
    show |= bit;
    if (!bit) status = read_field(sim, part, call->name, word, tile);
  }
  part->tile_show |= show ? show : SPH_TILE_PAIR;
  return status;
}

/* "along_r du": what a term adds to. */
static int read_adds(sph_sim *sim, sph_part *part, const sph_called_term *call)
{
  static const char *const names[] = {"push", "along_r", "along_v", "drho", "du", "ds"};
  char text[SPH_TERM_READS_MAX], *rest = NULL;
  memcpy(text, call->adds, sizeof text);
  if (!call->term.adds) part->tile_adds |= SPH_TILE_ALL;
  for (char *word = strtok_r(text, " ,", &rest); word; word = strtok_r(NULL, " ,", &rest)) {
    const unsigned bit = bit_of(word, names, sizeof names / sizeof *names);
    if (!bit)
      return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                          "term %s adds to \"%.60s\"; known: push, along_r, along_v, drho, du, ds",
                          call->name, word);
    part->tile_adds |= bit;
  }
  return SPH_OK;
}

/* What is shown for other than the terms: where viscous terms see what others do, it stands there
 * once. */
static unsigned shown_besides(const sph_part *part)
{
  unsigned show = 0;
  if (part->tile_show & SPH_TILE_V_VISCOUS) show |= SPH_TILE_V;
  if (part->tile_show & SPH_TILE_RV_VISCOUS) show |= SPH_TILE_RV;
  return show;
}

int sph_sim_interaction_prepare(sph_sim *sim, sph_part *part)
{
  int status = SPH_OK;
  for (int k = 0; !status && k < sim->terms.called; k++) {
    const sph_called_term *call = &sim->terms.call[k];
    if (!call->term.pair || !(part->called >> k & 1)) continue;
    sph_tile_term *tile = &part->tile[part->tiles++];
    *tile = (sph_tile_term){.term = &call->term, .scalar = call->scalar};
    if (call->scalar >= 0) part->tile_fields |= 1u << (SPH_TILE_SCALAR + call->scalar);
    status = read_reads(sim, part, call, tile);
    if (!status) status = read_adds(sim, part, call);
  }
  part->tile_show |= shown_besides(part);
  return status;
}
