/* 06_own_scalar -- an equation of your own, beside those of the fluid: a dye that diffuses.
 *
 * Equations  dC_i/dt = 2 D sum_j V_j (C_i - C_j) F_ij  ->  D lap C;   the flow carries C along
 * Reference  a wave of dye 1 + cos kx keeps its shape and decays as exp(-D k^2 t) (Brookshaw 1985)
 * Run        ./06_own_scalar
 * See        own_scalar/snapshot.hdf.series in ParaView, coloured by "dye"; dye_mean, dye_min,
 *            dye_max in own_scalar/series.csv; sphode plot --field dye own_scalar
 * Check      after the wave has fallen to 1/e: decay within 1 %, amount of dye to rounding */
#include <sphode.h>
#include <stdio.h>

static const double D = 0.01, h = 0.03; /* diffusivity [m^2/s], smoothing length [m] */

/* The whole term.  A tile is some pairs i <- j with what all terms share worked out already. */
static void diffuse(const sph_term *term, const sph_tile *tile)
{
  (void)term;
  for (long k = 0; k < tile->n; k++)
    tile->ds[k] += 2 * D * tile->V[k] * (tile->s_i[k] - tile->s_j[k]) * tile->F[k];
}

static double diffuse_dt_max(const sph_term *term, const sph_particles *s)
{
  (void)term, (void)s;
  return 0.125 * h * h / D;
}

static const sph_term diffusion = {
    .name = "diffusion of dye",
    .pair = diffuse,
    .adds = "ds",
    .dt_max = diffuse_dt_max,
    .scalar = {.name = "dye", .unit = "kg/m^3", .scale = 1},
};

/* Amplitude of cos kx in the dye, and its mean. */
static double amplitude(const sph_group *water, double k, double *mean)
{
  const double *x = sph_group_read(water, "position", 0), *C = sph_group_read(water, "dye", 0);
  double sum = 0, all = 0, n = (double)sph_group_count(water);
  for (long i = 0; x && C && i < sph_group_count(water); i++) {
    sum += 2 * C[i] * cos(k * x[i]) / n;
    all += C[i] / n;
  }
  *mean = all;
  return sum;
}

int main(void)
{
  double L = 1, dx = L / 50, k = 2 * acos(-1) / L, end = 1 / (D * k * k), mean = 0;

  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2,
                                               .dx = dx,
                                               .h_over_dx = h / dx,
                                               .periodic = {1, 1},
                                               .length = {L, 10 * dx},
                                               .speed = 0.1});
  sph_group *water = sph_group_box(sim, "water", (double[]){0, 0}, (double[]){L, 10 * dx}, 1000);
  sph_group_set_eos(water, sph_eos_tait(1000, 1, 7));
  sph_sim_add_term(sim, sph_term_continuity());
  sph_sim_add_term(sim, sph_term_pressure());
  sph_sim_add_term(sim, diffusion);
  const double *x = sph_group_read(water, "position", 0);
  double *C = sph_group_write(water, "dye", 0);
  for (long i = 0; x && C && i < sph_group_count(water); i++) C[i] = 1 + cos(k * x[i]);

  sph_sim_add_output(sim, sph_output_hdf5("own_scalar", end / 4));
  sph_sim_add_output(sim, sph_output_series("own_scalar", end / 100, NULL, 0));
  double error = INFINITY;
  if (sph_sim_run(sim, end) == SPH_OK) {
    error = fabs(amplitude(water, k, &mean) * exp(1) - 1);
    printf("t = %.3f s: the wave of dye fell to 1/e, error %.1e; mean %.15g\n", end, error, mean);
  } else
    fprintf(stderr, "own_scalar: %s\n", sph_sim_error(sim));
  sph_sim_free(sim);
  return !(error < 0.01 && fabs(mean - 1) < 1e-12);
}
