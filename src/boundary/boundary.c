#include "sphode/boundary.h"

#include <string.h>

static const struct {
  const char *name, *formula;
} boundaries[] = {
    {"adami", "p_w = [sum p_f W + (g - a_w).sum rho_f r_wf W]/sum W, v_w = 2 v - <v_f> (no slip)"},
    {"dbc", "d rho_w/dt = rho_w sum V_f v_wf.grad W, p_w = p(rho_w), rho_w >= rho0 (Crespo)"},
    {"mirror", "r_g = r - 2 (r - x_b).n n, p_g = p + rho (g - a_w).(r_g - r), T_g = 2 T_b - T"},
};
enum { BOUNDARIES = sizeof boundaries / sizeof *boundaries };

const char *sph_boundary_name(int k)
{
  return k >= 0 && k < BOUNDARIES ? boundaries[k].name : NULL;
}

const char *sph_boundary_formula(const char *name)
{
  for (int k = 0; name && k < BOUNDARIES; k++)
    if (!strcmp(boundaries[k].name, name)) return boundaries[k].formula;
  return NULL;
}
