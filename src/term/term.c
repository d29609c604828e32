#include "sphode/term.h"

#include <string.h>

static const struct {
  const char *name, *formula;
} terms[] = {
    {"continuity", "d rho_i/dt = rho_i sum V_j v_ij.grad W (c2), sum m_j v_ij.grad W (c1) or "
                   "phi_i sum m_j/phi_j v_ij.grad W (phi)"},
    {"summation", "rho_i = sum m_j W_ij instead of continuity"},
    {"pressure", "a_i = -sum m_j (p_i + p_j)/(rho_i rho_j) grad W (c2) or "
                 "-sum m_j (p_i/rho_i^2 + p_j/rho_j^2) grad W (s), (phi)"},
    {"viscosity-artificial", "a_i = -sum m_j Pi_ij grad W, Pi = (-alpha c mu + beta mu^2)/rho, "
                             "mu = min(h v_ij.r/(r^2 + 0.01 h^2), 0); switches balsara, "
                             "morris-monaghan, cullen-dehnen"},
    {"viscosity-signal", "the same, also its switches, with Pi = -alpha/2 (c_i + c_j - beta w) "
                         "w/rho, w = v_ij.r/r < 0"},
    {"viscosity-laminar", "a_i = sum m_j (eta_i + eta_j)/(rho_i rho_j) F v_ij (morris) or "
                          "2 (d + 2) sum m_j eta_ij/(rho_i rho_j) v_ij.r/r^2 grad W (mcg), "
                          "eta_ij = 2 eta_i eta_j/(eta_i + eta_j)"},
    {"conductivity-artificial", "du_i = sum m_j/rho_ij alpha v_sig (u_i - u_j) r F"},
    {"conduction", "du_i = sum m_j/(rho_i rho_j) 4 kappa_i kappa_j/(kappa_i + kappa_j) "
                   "(T_i - T_j) F"},
    {"heat-source", "du_i = Q(x_i, t)"},
    {"scalar-diffusion", "ds_i = sum m_j/(rho_i rho_j) 4 k_i k_j/(k_i + k_j) (s_i - s_j) F, "
                         "k = rho D"},
    {"xsph", "d r_i/dt = v_i - epsilon sum m_j/rho_ij v_ij W_ij"},
    {"delta", "d rho_i/dt += delta h c0 sum V_j psi_ij.grad W, psi_ij = "
              "2 (rho_j - rho_i) (r_j - r_i)/r^2 (molteni), "
              "the same less <grad rho>_i + <grad rho>_j (antuono) or with "
              "rho_j - rho_i - rho^H_ij (fourtakas)"},
    {"drag", "a_i = -d sum m_j K/(rho_i rho_j) D_ij (v_ij.e) e between dust and fluids, "
             "D = q^2 W/(d sigma_k^2), e = r_ij/r; K constant or rho_dust/t_s"},
    {"shifting", "d r_i/dt = v_i + dv_i, dv_i = -2 s h U sum V_j grad W (fick) or "
                 "-2 s h U sum V_j (1 + R (W/W(dx))^4) grad W (delta-plus); "
                 "density and velocity gain dv_i . grad"},
    {"transport-velocity", "d r_i/dt = v_i + dv_i, dv_i = -tau p_b/m_i sum (V_i^2 + V_j^2) grad W; "
                           "a_i += 1/m_i sum (V_i^2 + V_j^2)/2 (A_i + A_j).grad W, A = rho v dv"},
    {"stress-artificial", "a_i = -sum m_j R_ij (W/W(dx))^4 grad W, R_ij = alpha (|p_i|/rho_i^2 + "
                          "|p_j|/rho_j^2) of negative p, beta (p_i/rho_i^2 + p_j/rho_j^2) of two "
                          "positive ones"},
    {"gravity", "a_i = g"},
    {"harmonic", "a_i = -omega^2 x_i"},
};
enum { TERMS = sizeof terms / sizeof *terms };

sph_term sph_term_corrected(sph_term term, const char *correction)
{
  term.correction = correction;
  return term;
}

const char *sph_term_name(int k) { return k >= 0 && k < TERMS ? terms[k].name : NULL; }

const char *sph_term_formula(const char *name)
{
  for (int k = 0; name && k < TERMS; k++)
    if (!strcmp(terms[k].name, name)) return terms[k].formula;
  return NULL;
}
