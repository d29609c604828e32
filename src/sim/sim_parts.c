/* Parts of f.  Each rate belongs to exactly one of explicit (slow), implicit and fast:
 *
 *   terms                  as set, else explicit
 *   dx/dt = v              with the pressure force, else explicit; and with it the limits of steps
 *                          by waves (where something makes them) and by motion
 *   work of pressure       heats with the pressure force, whose partner it is
 *
 * An evaluation of a part runs the phases that its terms read from, no others:
 *
 *   pair terms                                       lists, pairs; density where it is a sum
 *   those that read p, c, u, T; body terms; walls    eos
 *   pair terms that act at walls                     walls
 *   drag                                             drag
 *   Antuono's diffusion, corrected terms             gradients; these: walls
 *   switched artificial viscosity                    switches
 *   shifting, transport velocity                     shift */
#include "sim_parts.h"

#include <string.h>

#include "sim_rhs.h"
#include "term_part.h"

enum {
  READ_EOS = SPH_PRESSURE_FORCE | SPH_ARTIFICIAL | SPH_SIGNAL | SPH_CONDUCTIVITY | SPH_CONDUCTION |
             SPH_STRESS,
  WALLS_READ_EOS =
      SPH_CONTINUITY | SPH_DIFFUSION | SPH_XSPH, /* mass, phi, density of wall particles */
  TILES_READ_EOS = 1 << SPH_TILE_PRESSURE | 1 << SPH_TILE_SOUND_SPEED | 1 << SPH_TILE_ENERGY |
                   1 << SPH_TILE_TEMPERATURE
};

void sph_sim_set_part(sph_sim *sim, const char *term, const char *part)
{
  if (!sph_sim_data_ok(sim)) return;
  if (sim->prepared)
    sph_sim_fail(sim, SPH_ERR_STATE, "part of term %s: parts are set before the run",
                 term ? term : "");
  else
    sph_term_part_set(&sim->terms, term, part, &sim->error);
}

/* ---- which terms ---- */

static unsigned called_of(const sph_sim *sim, int number)
{
  unsigned called = 0;
  for (int k = 0; k < sim->terms.called; k++)
    if (sim->terms.call[k].part == number) called |= 1u << k;
  return called;
}

static unsigned bits_of(const sph_sim *sim, int number)
{
  const sph_term_set *set = &sim->terms;
  if (number == SPH_TERM_IMPLICIT) return set->implicit;
  if (number == SPH_TERM_FAST) return set->fast;
  return ~(set->implicit | set->fast);
}

static void choose(const sph_sim *sim, sph_part *part, int piece)
{
  const unsigned loop = sim->loop_terms;
  unsigned bits = ~0u;
  part->called = ~0u;
  if (piece <= SPH_PIECE_FAST) {
    static const int number[] = {[SPH_PIECE_EXPLICIT] = SPH_TERM_EXPLICIT,
                                 [SPH_PIECE_IMPLICIT] = SPH_TERM_IMPLICIT,
                                 [SPH_PIECE_FAST] = SPH_TERM_FAST};
    int home = loop & bits_of(sim, SPH_TERM_FAST) & SPH_PRESSURE_FORCE ? SPH_PIECE_FAST
                                                                       : SPH_PIECE_EXPLICIT;
    bits = bits_of(sim, number[piece]);
    part->called = called_of(sim, number[piece]);
    part->positions = part->motion = piece == home;
  } else {
    const unsigned moving = SPH_XSPH | SPH_SHIFTS;
    if (piece == SPH_PIECE_DRIFT) bits = moving, part->called = 0;
    if (piece == SPH_PIECE_KICK) bits = ~moving;
    part->positions = piece != SPH_PIECE_KICK;
    part->motion = piece != SPH_PIECE_DRIFT;
  }
  part->acoustic = part->motion && ((loop & SPH_PRESSURE_FORCE) || sim->terms.pairs);
  part->gravity = sim->terms.uniform && (bits & SPH_UNIFORM);
  part->drag = (loop & bits & SPH_DRAG) != 0;
  part->shift = (loop & bits & SPH_SHIFTS) && !sim->terms.shift.steps;
  part->rates = loop & bits & SPH_PAIR_TERMS;
  if (sim->terms.summed) part->rates &= ~(unsigned)SPH_CONTINUITY;
  part->terms = part->rates;
  /* The work of pressure needs the sum of continuity. */
  if ((loop & SPH_THERMAL) && (part->rates & SPH_PRESSURE_FORCE))
    part->terms |= loop & SPH_CONTINUITY;
}

/* ---- which phases ---- */

/* Does any pair term of the part act between a fluid and a wall? */
static int meets_walls(const sph_sim *sim, const sph_part *part)
{
  for (int g = 0; g < sim->groups; g++)
    for (int w = 0; w < sim->groups; w++)
      if (!sim->group[g]->wall && sim->group[w]->wall &&
          (part->tiles || part->shift ||
           (sph_sim_interaction_constants(sim, part, sim->group[g], sim->group[w]).terms &
            SPH_PAIR_TERMS)))
        return 1;
  return 0;
}

/* What body terms read; unless a term tells it, anything. */
static void bodies_read(const sph_sim *sim, sph_part *part)
{
  for (int k = 0; k < sim->terms.called; k++) {
    const sph_term *term = &sim->terms.call[k].term;
    if (!(part->called >> k & 1) || !(term->body || term->dt_max)) continue;
    if (term->reads && !term->pair && !*term->reads) continue;
    part->density = part->eos = 1;
  }
}

static void find_phases(const sph_sim *sim, sph_part *part)
{
  const int whole = part == &sim->part[SPH_WHOLE]; /* also tells what is shown */
  part->pairs = whole || part->rates || part->tiles || part->drag || part->shift;
  if (part->pairs) part->terms |= sim->loop_terms & (SPH_FORM_C2 | SPH_FORM_PHI | SPH_THERMAL);
  if (part->pairs)
    part->terms |= fluid_corrections(part->terms | (sim->loop_terms & SPH_CORRECTED));
  part->gradients = (part->rates & SPH_ANTUONO) || (part->terms & SPH_CORRECTED);
  part->walls = whole || (part->terms & SPH_CORRECTED) || (part->pairs && meets_walls(sim, part));
  if (part->rates & (SPH_ARTIFICIAL | SPH_SIGNAL)) part->terms |= sim->loop_terms & SPH_SWITCHES;
  part->switches = (part->terms & SPH_SWITCHES) != 0;
  /* Of a wall that only viscosity or conduction sees, pressure and density count for nothing. */
  part->eos = (part->walls && ((part->rates & WALLS_READ_EOS) || part->tiles || part->shift)) ||
              (part->rates & READ_EOS) || (part->tile_fields & TILES_READ_EOS) || part->acoustic ||
              whole;
  part->density = part->pairs || part->eos;
  bodies_read(sim, part);
  part->density = part->density && sim->terms.summed;
  part->lists = part->pairs || part->density;
}

int sph_sim_parts_of(sph_sim *sim, sph_part *part, unsigned bits, unsigned called)
{
  *part = (sph_part){.called = called, .rates = sim->loop_terms & bits & SPH_PAIR_TERMS};
  part->drag = (sim->loop_terms & bits & SPH_DRAG) != 0;
  part->shift = (sim->loop_terms & bits & SPH_SHIFTS) != 0;
  part->terms = part->rates;
  int status = sph_sim_interaction_prepare(sim, part);
  if (!status) find_phases(sim, part);
  return status;
}

int sph_sim_parts_make(sph_sim *sim)
{
  int status = SPH_OK;
  for (int piece = SPH_PARTS - 1; !status && piece >= 0; piece--) {
    sph_part *part = &sim->part[piece];
    choose(sim, part, piece);
    status = sph_sim_interaction_prepare(sim, part);
    if (!status) find_phases(sim, part);
  }
  /* Steps of a scheme that takes parts are limited by those that it steps explicitly. */
  for (int piece = 0; piece < SPH_PARTS; piece++) {
    const sph_part *limits =
        piece <= SPH_PIECE_FAST ? &sim->part[piece] : &sim->part[SPH_PIECE_EXPLICIT];
    sim->part[piece].limit_terms = limits->rates | (limits->drag ? SPH_DRAG : 0) |
                                   (limits->shift ? sim->loop_terms & SPH_SHIFTS : 0);
    sim->part[piece].limit_called = limits->called;
  }
  return status;
}

/* ---- do they fit the integrator? ---- */

int sph_sim_parts_fit(sph_sim *sim)
{
  const char *method = sph_sim_integrator(sim);
  int imex = !strncmp(method, "imex:", 5), mri = !strncmp(method, "mri:", 4);
  if (imex && sph_term_part_default(&sim->terms, &sim->error)) return sim->error.status;
  const char *implicit = sph_term_part_first(&sim->terms, SPH_TERM_IMPLICIT);
  const char *fast = sph_term_part_first(&sim->terms, SPH_TERM_FAST);
  if (implicit && !imex)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "term %s is implicit, but integrator %s steps all terms alike; right is "
                        "imex:<table>",
                        implicit, method);
  if (fast && !mri)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "term %s is fast, but integrator %s steps all terms alike; right is "
                        "mri:<coupling>",
                        fast, method);
  if ((sim->terms.bits & SPH_CULLEN_DEHNEN) && (imex || mri))
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "the switch cullen-dehnen follows from the whole acceleration, of which "
                        "integrator %s takes parts; right is one that steps all terms alike, or "
                        "morris-monaghan",
                        method);
  if (mri && !fast)
    return sph_sim_fail(sim, SPH_ERR_ARGUMENT,
                        "integrator %s needs fast terms, and none is: sph_sim_set_part", method);
  return SPH_OK;
}
