/* What a simulation has that does nothing, or lacks that most have: told, not refused. */
#include "sim_warning.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void sph_sim_warning_found(sph_finder *f, const char *format, ...)
{
  va_list arguments;
  if (f->found++ != f->wanted || !f->size) return;
  va_start(arguments, format);
  vsnprintf(f->text, f->size, format, arguments);
  va_end(arguments);
}

static void find_in_terms(sph_finder *f, const sph_term_set *terms)
{
  const double *g = terms->g;
  if (!(terms->bits & SPH_CONTINUITY) && !terms->summed && !terms->pairs)
    sph_sim_warning_found(f, "nothing changes the density: no continuity, no summation");
  if (!(terms->bits & SPH_PRESSURE_FORCE) && !terms->pairs)
    sph_sim_warning_found(f, "no pressure force");
  if ((terms->bits & SPH_FOURTAKAS) && g[0] == 0 && g[1] == 0 && g[2] == 0)
    sph_sim_warning_found(f, "delta fourtakas without gravity is molteni");
  if ((terms->bits & SPH_XSPH) && terms->epsilon == 0)
    sph_sim_warning_found(f, "xsph with epsilon = 0 does nothing");
  if ((terms->bits & SPH_SHIFTING) && terms->shift.strength == 0)
    sph_sim_warning_found(f, "shifting with strength = 0 does nothing");
  if ((terms->bits & SPH_STRESS) && terms->stress_alpha == 0 && terms->stress_beta == 0)
    sph_sim_warning_found(f, "stress-artificial with alpha = beta = 0 does nothing");
  if ((terms->bits & SPH_DRAG) && terms->drag_K == 0 && terms->drag_rate == 0)
    sph_sim_warning_found(f, "drag with K = 0 does nothing");
}

static void find_in_wall(sph_finder *f, const sph_sim *sim, const sph_group *wall)
{
  const unsigned bits = sim->terms.bits;
  if (sph_group_data_isothermal(wall) && !(bits & SPH_CONDUCTION))
    sph_sim_warning_found(f, "wall %s has a temperature, but there is no conduction", wall->name);
  if (wall->boundary.no_slip && !(bits & SPH_VISCOUS) && !sim->terms.pairs)
    sph_sim_warning_found(f, "wall %s is no-slip, but there is no viscous term to feel it",
                          wall->name);
  if (wall->viscosity > 0)
    sph_sim_warning_found(f, "wall %s has a viscosity, which is not used: fluids take their own",
                          wall->name);
}

static void find_in_dust(sph_finder *f, const sph_sim *sim, const sph_group *dust)
{
  int walls = 0;
  for (int g = 0; g < sim->groups; g++) walls += sim->group[g]->wall;
  if (!(sim->terms.bits & SPH_DRAG))
    sph_sim_warning_found(f, "%s is dust, but there is no drag: nothing acts on it", dust->name);
  if (walls) sph_sim_warning_found(f, "%s is dust: walls do not hold it", dust->name);
  if (dust->viscosity > 0 || dust->conductivity > 0)
    sph_sim_warning_found(f, "%s is dust: its viscosity and conductivity are not used", dust->name);
}

static void find_in_fluid(sph_finder *f, const sph_sim *sim, const sph_group *fluid)
{
  const unsigned bits = sim->terms.bits, laminar = SPH_MORRIS | SPH_MCG;
  if (fluid->viscosity > 0 && !(bits & laminar))
    sph_sim_warning_found(f, "%s has a viscosity, but there is no viscosity-laminar", fluid->name);
  if (fluid->viscosity == 0 && (bits & laminar))
    sph_sim_warning_found(f, "%s has no viscosity beside viscosity-laminar", fluid->name);
  if (fluid->conductivity > 0 && !(bits & SPH_CONDUCTION))
    sph_sim_warning_found(f, "%s has a conductivity, but there is no conduction", fluid->name);
  if (fluid->conductivity == 0 && (bits & SPH_CONDUCTION))
    sph_sim_warning_found(f, "%s has no conductivity beside conduction", fluid->name);
}

static void find_in_surface(sph_finder *f, const sph_sim *sim)
{
  if (sim->prepared && sim->surface > 0 && !sim->terms.shift.surface)
    sph_sim_warning_found(
        f,
        "%ld particles are at a free surface, which shifting with surface = 0 (in a case: "
        "surface: false) does not know: it would spread",
        sim->surface);
}

int sph_sim_warning(const sph_sim *sim, int k, char *text, size_t size)
{
  sph_finder f = {k, 0, text, text ? size : 0};
  if (!sim || k < 0) return 0;
  find_in_terms(&f, &sim->terms);
  for (int g = 0; g < sim->groups; g++)
    if (sim->group[g]->wall)
      find_in_wall(&f, sim, sim->group[g]);
    else if (sim->group[g]->eos.dust)
      find_in_dust(&f, sim, sim->group[g]);
    else
      find_in_fluid(&f, sim, sim->group[g]);
  if (sim->prepared) sph_sim_warning_steps(&f, sim);
  find_in_surface(&f, sim);
  if (sim->prepared) sph_sim_warning_speeds(&f, sim);
  if (sim->prepared) sph_sim_warning_resolution(&f, sim);
  if (sim->prepared) sph_sim_warning_events(&f, sim);
  if (sim->prepared) sph_sim_warning_overlap(&f, sim);
  if (sim->prepared) sph_sim_warning_places(&f, sim);
  return f.found > k;
}
