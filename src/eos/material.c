/* Presets: constants with their sources.  R in c_v of air: eos_ideal_gas.c. */
#include "sphode/material.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "material_table.h"

enum kind { TAIT, IDEAL, STIFFENED, SOLID };

typedef struct preset {
  const char *name;
  enum kind kind;
  double rho0, c0, gamma;              /* c0 = 0: only numerical */
  double molar_mass;                   /* [kg/mol]; 0: c_v below */
  double p_inf, q, slope, grueneisen;  /* as in sph_eos */
  double c_v, viscosity, conductivity; /* 0: not in the source */
  const char *about, *source;
} preset;

static const preset table[] = {
    {.name = "water",
     .kind = TAIT,
     .rho0 = 998.2,
     .c0 = 1482,
     .gamma = 7,
     .c_v = 4157,
     .viscosity = 1.002e-3,
     .conductivity = 0.5975,
     .about = "water at 20 C, Tait; numerical or physical sound speed",
     .source = "density, sound speed, c_v: Wagner & Pruss 2002; gamma: Cole 1948; viscosity: "
               "Swindells et al. 1952; conductivity: Ramires et al. 1995"},
    {.name = "water-stiffened",
     .kind = STIFFENED,
     .rho0 = 1000,
     .gamma = 2.35,
     .p_inf = 1e9,
     .q = -1.167e6,
     .c_v = 1816,
     .about =
         "liquid water near saturation, 298 to 473 K, stiffened gas: c = 1533 m/s at 1 bar and "
         "1000 kg/m^3, where its T is 408 K",
     .source = "Le Metayer, Massoni & Saurel 2004"},
    {.name = "water-shock",
     .kind = STIFFENED,
     .rho0 = 1000,
     .gamma = 4.4,
     .p_inf = 6e8,
     .about = "water under shocks, stiffened gas: c = 1625 m/s at 1 bar and 1000 kg/m^3",
     .source = "Saurel & Abgrall 1999"},
    {.name = "air",
     .kind = IDEAL,
     .rho0 = 1.225,
     .gamma = 1.4,
     .molar_mass = 0.0289644,
     .viscosity = 1.7894e-5,
     .conductivity = 0.025326,
     .about = "air at 15 C and 1 atm, ideal gas",
     .source = "U.S. Standard Atmosphere 1976"},
    {.name = "air-tait",
     .kind = TAIT,
     .rho0 = 1.225,
     .c0 = 340.3,
     .gamma = 1.4,
     .molar_mass = 0.0289644,
     .viscosity = 1.7894e-5,
     .conductivity = 0.025326,
     .about = "air at 15 C and 1 atm, Tait: its pressure is gauge pressure",
     .source = "U.S. Standard Atmosphere 1976"},
    {.name = "oil",
     .kind = TAIT,
     .rho0 = 860,
     .gamma = 7,
     .viscosity = 0.1,
     .about = "a mineral oil, Tait; numerical sound speed only",
     .source = "typical values, not a measured oil"},
    {.name = "copper",
     .kind = SOLID,
     .rho0 = 8930,
     .c0 = 3940,
     .slope = 1.49,
     .grueneisen = 2,
     .c_v = 383,
     .about = "copper, Mie-Grueneisen, typical; without strength",
     .source = "Steinberg 1996; c_v: c_p of Johnson & Cook 1983, 3 % more"},
    {.name = "aluminium",
     .kind = SOLID,
     .rho0 = 2785,
     .c0 = 5328,
     .slope = 1.338,
     .grueneisen = 2,
     .c_v = 875,
     .about = "aluminium 2024, Mie-Grueneisen, typical; without strength",
     .source = "Steinberg 1996; c_v: c_p of Johnson & Cook 1983, 4 % more"},
    {.name = "steel",
     .kind = SOLID,
     .rho0 = 7900,
     .c0 = 4570,
     .slope = 1.49,
     .grueneisen = 1.93,
     .c_v = 477,
     .about = "stainless steel 304, Mie-Grueneisen, typical; without strength",
     .source = "Steinberg 1996; c_v: c_p of steel 4340, Johnson & Cook 1983"},
};
enum { ROWS = sizeof table / sizeof table[0] };

static const preset *find(const char *name)
{
  for (int k = 0; name && k < ROWS; k++)
    if (!strcmp(name, table[k].name)) return &table[k];
  return NULL;
}

const char *sph_material_name(int k) { return k >= 0 && k < ROWS ? table[k].name : NULL; }

const char *sph_material_about(const char *name)
{
  const preset *p = find(name);
  return p ? p->about : NULL;
}

static sph_eos eos_of(const preset *p, double c0)
{
  sph_eos eos = p->kind == TAIT    ? sph_eos_tait(p->rho0, c0, p->gamma)
                : p->kind == IDEAL ? sph_eos_ideal_gas(p->gamma)
                : p->kind == STIFFENED
                    ? sph_eos_stiffened_gas(p->rho0, p->gamma, p->p_inf, p->q)
                    : sph_eos_mie_grueneisen(p->rho0, p->c0, p->slope, p->grueneisen);
  eos.rho0 = p->rho0;
  eos.c_v = p->molar_mass > 0 ? sph_eos_ideal_gas_molar(p->gamma, p->molar_mass).c_v : p->c_v;
  return eos;
}

sph_material sph_material_preset(const char *name, double c0)
{
  const preset *p = find(name);
  sph_material material = {.name = name, .eos.c0 = c0};
  if (!p) return material;
  material.viscosity = p->viscosity;
  material.conductivity = p->conductivity;
  material.source = p->source;
  double c = c0 == 0 ? p->c0 : c0;
  if (p->kind == TAIT ? c > 0 && isfinite(c) : c0 == 0) material.eos = eos_of(p, c);
  return material;
}

int sph_material_explain(const sph_material *material, sph_error *error)
{
  const preset *p = find(material->name);
  char known[300] = "";
  for (int k = 0; k < ROWS; k++) {
    size_t n = strlen(known);
    snprintf(known + n, sizeof known - n, "%s%s", k ? ", " : "", table[k].name);
  }
  if (!p)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "material \"%.80s\"; known: %s",
                         material->name ? material->name : "", known);
  if (p->kind == TAIT)
    return sph_error_set(
        error, SPH_ERR_ARGUMENT,
        "material %s: numerical sound speed c0 = %g m/s must be positive and finite", p->name,
        material->eos.c0);
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "material %s: c0 = %g m/s; its sound speed follows from its state: leave c0 "
                       "0",
                       p->name, material->eos.c0);
}
