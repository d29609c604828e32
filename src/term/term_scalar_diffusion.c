/* A scalar per mass that diffuses (Brookshaw 1985; Cleary & Monaghan 1999, eq. 26), k = rho D:
 *
 *   ds_i/dt = sum_j m_j/(rho_i rho_j) 4 k_i k_j/(k_i + k_j) (s_i - s_j) F_ij
 *
 * Symmetric times m_i, so sum m s is kept; the harmonic mean keeps the flux continuous where k
 * jumps.  A wall with an s of its own is seen as s_j = 2 s_w - s_i, of k_i: over the layers of a
 * lattice the flux of a linear profile comes out exactly, and nothing of the wall has to be summed
 * before. */
#include "term_scalar_diffusion.h"

#include <math.h>
#include <string.h>

double sph_term_scalar_diffusion_of(const sph_term *term, const char *group, double none)
{
  for (int k = 0; k < term->by_groups; k++)
    if (!strcmp(term->by_group[k].group, group)) return term->by_group[k].value;
  return none;
}

/* From the surface of a wall. */
static void from_wall(const sph_tile *tile, double D, double s_wall)
{
  for (long k = 0; k < tile->n; k++)
    tile->ds[k] += 4 * D * tile->V[k] * (tile->s_i[k] - s_wall) * tile->F[k];
}

static void pair(const sph_term *term, const sph_tile *tile)
{
  const double D_i = sph_term_scalar_diffusion_of(term, tile->target, term->diffusivity);
  const double D_j =
      sph_term_scalar_diffusion_of(term, tile->source, tile->wall ? NAN : term->diffusivity);
  const double *rho_i = tile->i[0], *rho_j = tile->j[0];
  if (tile->wall && !isnan(D_j)) from_wall(tile, D_i, D_j);
  if (tile->wall || !(D_i > 0 && D_j > 0)) return;
  for (long k = 0; k < tile->n; k++) {
    const double mean = 4 * D_i * D_j * rho_j[k] / (rho_i[k] * D_i + rho_j[k] * D_j);
    tile->ds[k] += mean * tile->V[k] * (tile->s_i[k] - tile->s_j[k]) * tile->F[k];
  }
}

void sph_term_scalar_diffusion_settle(sph_term *term)
{
  if (term->pair == pair && term->diffusivity == 0 && term->by_groups == 0) term->pair = NULL;
}

sph_term sph_term_scalar_diffusion(sph_scalar scalar, double diffusivity)
{
  return (sph_term){.name = scalar.name,
                    .diffusivity = diffusivity,
                    .pair = pair,
                    .reads = "density V F",
                    .adds = "ds",
                    .scalar = scalar};
}
