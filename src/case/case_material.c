#include "case_material.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sphode/material.h"
#include "sphode/sim.h"

#define get_text sph_case_reader_text
#define get_number sph_case_reader_number
#define child_of sph_case_reader_find
#define FAIL(node, ...) sph_case_schema_fail(c, c->error, node, 0, 0, __VA_ARGS__)
#define FAIL_VALUE(node, ...) sph_case_schema_fail(c, c->error, node, 1, 0, __VA_ARGS__)

/* ---- checks */

/* The group that is matched stands above and can be matched. */
static int check_match(const sph_case *c, const sph_case_node *map, const sph_case_node *match)
{
  const sph_case_node *groups = child_of(c->root, "groups"), *one = groups->first;
  char above[300] = "";
  for (; one != map && strcmp(one->key, match->text); one = one->next) {
    size_t n = strlen(above);
    snprintf(above + n, sizeof above - n, "%s%s", n ? ", " : "", one->key);
  }
  if (one == map)
    return FAIL_VALUE(match, "match: group '%.60s' %s; groups above: %s", match->text,
                      child_of(groups, match->text) ? "must stand above this one" : "is unknown",
                      above[0] ? above : "none");
  const sph_case_node *eos = child_of(one, "eos"), *kind = eos ? eos->first : NULL;
  static const char *const stiff[] = {"tait", "linear", "murnaghan"};
  for (int k = 0; kind && k < 3; k++)
    if (!strcmp(kind->key, stiff[k])) return SPH_OK;
  const char *preset = get_text(child_of(one, "material"), "preset", NULL);
  if (preset) {
    sph_material material = sph_material_preset(preset, 1);
    if (material.eos.name && !strcmp(material.eos.name, "tait")) return SPH_OK;
  }
  return FAIL_VALUE(match,
                    "match: group '%.60s' has no equation of state tait, linear or murnaghan",
                    match->text);
}

static int check_tait(const sph_case *c, const sph_case_node *map, const sph_case_node *tait)
{
  const sph_case_node *speed = child_of(tait, "sound_speed"), *match = child_of(tait, "match");
  const sph_case_node *background = child_of(tait, "background");
  if (!speed && !match) return FAIL(tait, "missing key 'sound_speed' or 'match' in tait");
  if (speed && match) return FAIL(match, "tait: found both sound_speed and match; one is right");
  if (match && background && !(background->origin && !strcmp(background->origin, "default")))
    return FAIL(background, "tait: found both match and background; match brings its own");
  return match ? check_match(c, map, match) : SPH_OK;
}

static int check_group(const sph_case *c, const sph_case_node *map)
{
  const sph_case_node *eos = child_of(map, "eos"), *material = child_of(map, "material");
  const sph_case_node *heat = child_of(map, "specific_heat"), *kind = eos ? eos->first : NULL;
  if (eos && material) return FAIL(material, "found both eos and material; one is right");
  if (!eos && !material && strcmp(get_text(map, "kind", ""), "wall") != 0)
    return FAIL(map, "missing key 'eos' or 'material' in %s: a fluid needs an equation of state",
                map->key);
  if (!material && !child_of(map, "density"))
    return FAIL(map, "missing key 'density' in %s: density at the start", map->key);
  if (heat && !eos && !material)
    return FAIL(heat, "specific_heat: belongs to an eos or a material, and here is none");
  if (heat && kind && child_of(kind, "molar_mass"))
    return FAIL(heat, "found both specific_heat and molar_mass; one is right");
  return kind && !strcmp(kind->key, "tait") ? check_tait(c, map, kind) : SPH_OK;
}

int sph_case_material_check(const sph_case *c)
{
  for (const sph_case_node *map = child_of(c->root, "groups")->first; map; map = map->next)
    if (check_group(c, map)) return c->error->status;
  return SPH_OK;
}

/* ---- from nodes to materials */

static sph_material preset_of(const sph_case_node *map)
{
  const sph_case_node *material = child_of(map, "material");
  return sph_material_preset(get_text(material, "preset", NULL),
                             get_number(material, "sound_speed", 0));
}

double sph_case_material_density(const sph_case_node *map)
{
  double own = child_of(map, "material") ? preset_of(map).eos.rho0 : 0;
  return get_number(map, "density", own);
}

static sph_eos tait_of(sph_sim *sim, const sph_case_node *kind, double density)
{
  const char *match = get_text(kind, "match", NULL);
  double gamma = get_number(kind, "gamma", 0);
  if (match) return sph_eos_tait_matched(sph_group_eos(sph_sim_group(sim, match)), density, gamma);
  sph_eos eos = sph_eos_tait(density, get_number(kind, "sound_speed", 0), gamma);
  eos.p_background = get_number(kind, "background", 0);
  return eos;
}

/* Of barotropic liquids: with the background. */
static sph_eos liquid_of(const sph_case_node *kind, double density)
{
  sph_eos eos = !strcmp(kind->key, "linear")
                    ? sph_eos_linear(density, get_number(kind, "sound_speed", 0),
                                     get_number(kind, "p_min", -INFINITY))
                    : sph_eos_murnaghan(density, get_number(kind, "bulk_modulus", 0),
                                        get_number(kind, "n", 0));
  eos.p_background = get_number(kind, "background", 0);
  return eos;
}

static sph_eos eos_of(sph_sim *sim, const sph_case_node *kind, double density)
{
  const char *name = kind->key;
  double c0 = get_number(kind, "sound_speed", 0), gamma = get_number(kind, "gamma", 0);
  if (!strcmp(name, "tait")) return tait_of(sim, kind, density);
  if (!strcmp(name, "linear") || !strcmp(name, "murnaghan")) return liquid_of(kind, density);
  if (!strcmp(name, "isothermal")) return sph_eos_isothermal(density, c0);
  if (!strcmp(name, "polytropic"))
    return sph_eos_polytropic(density, get_number(kind, "pressure", 0) / pow(density, gamma),
                              gamma);
  if (!strcmp(name, "stiffened-gas"))
    return sph_eos_stiffened_gas(density, gamma, get_number(kind, "p_inf", 0),
                                 get_number(kind, "q", 0));
  if (!strcmp(name, "mie-grueneisen"))
    return sph_eos_mie_grueneisen(density, c0, get_number(kind, "slope", 0),
                                  get_number(kind, "grueneisen", 0));
  if (!strcmp(name, "dust")) return sph_eos_dust();
  if (!child_of(kind, "molar_mass")) return sph_eos_ideal_gas(gamma);
  return sph_eos_ideal_gas_molar(gamma, get_number(kind, "molar_mass", 0));
}

/* A density of the group's own is the material's reference density, too. */
static sph_material with_density(sph_material material, double density)
{
  if (!material.eos.name || material.eos.rho0 == density) return material;
  if (!strcmp(material.eos.name, "stiffened-gas"))
    material.eos.c0 = sqrt(material.eos.gamma * material.eos.p_inf / density);
  material.eos.rho0 = density;
  return material;
}

void sph_case_material_set(sph_sim *sim, sph_group *group, const sph_case_node *map)
{
  const sph_case_node *eos = child_of(map, "eos");
  double density = sph_case_material_density(map);
  sph_material material = {0};
  if (child_of(map, "material")) material = with_density(preset_of(map), density);
  if (eos) material.eos = eos_of(sim, eos->first, density);
  if (material.eos.name) material.eos.c_v = get_number(map, "specific_heat", material.eos.c_v);
  material.viscosity = get_number(map, "viscosity", material.viscosity);
  material.conductivity = get_number(map, "conductivity", material.conductivity);
  if (eos || child_of(map, "material"))
    sph_group_set_material(group, material);
  else {
    sph_group_set_viscosity(group, material.viscosity);
    sph_group_set_conductivity(group, material.conductivity);
  }
}
