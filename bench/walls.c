/* The wall models side by side: the tables of docs/walls.md.
 *
 *   bench/walls          all of them
 *   bench/walls TABLE    rest, channel, cylinders, heat, manufactured or impact */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../tests/accuracy/wall_scene.h"

enum { MODELS = 3 };
static const char *const model[MODELS] = {"adami", "dbc", "mirror"};

static void rest(void)
{
  puts("| model | diffusion | L1(p)/ρgH at t√(g/H) = 40 | at 120 | kinetic/potential at 120 |\n"
       "|---|---|---|---|---|");
  static const char *const diffusion[] = {"antuono", "fourtakas"};
  for (int k = 0; k < MODELS; k++)
    for (int d = 0; d < 2; d++) {
      const wall_rest early = wall_scene_rest(model[k], diffusion[d], 40);
      const wall_rest late = wall_scene_rest(model[k], diffusion[d], 120);
      printf("| `%s` | %s | %.2f %% | %.2f %% | %.1e |\n", model[k], diffusion[d],
             100 * early.error, 100 * late.error, late.motion);
      fflush(stdout);
    }
}

static void channel(void)
{
  puts("| model | flow | rms/V at tν/L² = 0.0225 | 0.045 | 0.1125 | 0.225 | 0.5 "
       "| order at 0.0225 | 0.045 | most, h/Δx = 2 |\n"
       "|---|---|---|---|---|---|---|---|---|---|");
  for (int k = 0; k < MODELS; k++)
    for (int couette = 1; couette >= 0; couette--) {
      double coarse[WALL_TIMES], fine[WALL_TIMES], wide[WALL_TIMES], most = 0;
      wall_scene_channel(model[k], couette, 25, 1.5, 2, coarse);
      wall_scene_channel(model[k], couette, 50, 1.5, WALL_TIMES, fine);
      wall_scene_channel(model[k], couette, 50, 2, WALL_TIMES, wide);
      printf("| `%s` | %s |", model[k], couette ? "Couette" : "Poiseuille");
      for (int t = 0; t < WALL_TIMES; t++) {
        printf(" %.3f %% |", 100 * fine[t]);
        most = fmax(most, wide[t]);
      }
      printf(" %.2f | %.2f | %.3f %% |\n", log2(coarse[0] / fine[0]), log2(coarse[1] / fine[1]),
             100 * most);
      fflush(stdout);
    }
}

static void cylinder(const char *name, double h_over_dx, int steps)
{
  double last = NAN;
  printf("| `%s` | %.1f |", name, h_over_dx);
  for (int k = 0; k < 3; k++) {
    const double error = k < steps ? wall_scene_cylinders(name, 12 << k, h_over_dx) : NAN;
    if (k < steps) printf(" %.2f %% |", 100 * error);
    if (k >= steps) printf(" |");
    if (k > 0 && k < steps) printf(" %.2f |", log2(last / error));
    if (k > 0 && k >= steps) printf(" |");
    last = error;
    fflush(stdout);
  }
  puts("");
}

static void cylinders(void)
{
  puts("| model | h/Δx | rms/V at 12 across | 24 | order | 48 | order "
       "|\n|---|---|---|---|---|---|---|");
  cylinder("adami", 1.5, 3);
  cylinder("adami", 2, 2);
  cylinder("dbc", 1.5, 2);
  puts("| `mirror` | has planes alone | | | | | |");
}

static void heat(void)
{
  puts("| model | wall | rms/ΔT at 20 across | 40 | 80 | order |\n|---|---|---|---|---|---|");
  static const char *const kind[] = {"dirichlet", "neumann", "flux"};
  static const char *const name[] = {"temperature", "adiabatic", "flux"};
  for (int k = 0; k < MODELS; k++)
    for (int q = 0; q < (k == 2 ? 3 : 2); q++) {
      double error[3];
      for (int n = 0; n < 3; n++) error[n] = wall_scene_slab(model[k], kind[q], 20 << n);
      printf("| `%s` | %s | %.2e | %.2e | %.2e | %.2f |\n", model[k], name[q], error[0], error[1],
             error[2], log2(error[0] / error[2]) / 2);
      fflush(stdout);
    }
}

/* h_over_dx 0: it grows. */
static void manufactured_row(const char *name, int no_slip, double h_over_dx)
{
  double dx[3], v[3], p[3];
  char wide[20] = "grows";
  for (int n = 0; n < 3; n++) {
    dx[n] = 1.0 / (16 << n);
    wall_scene_manufactured(name, no_slip, 16 << n, h_over_dx, &v[n], &p[n]);
  }
  if (h_over_dx > 0) snprintf(wide, sizeof wide, "%g", h_over_dx);
  printf("| `%s` | %s | %s | %.1e | %.1e | %.1e | %.2f | %.1e | %.2f |\n", name,
         no_slip ? "no slip" : "free slip", wide, v[0], v[1], v[2],
         sph_manufactured_order(3, dx, v), p[2], sph_manufactured_order(3, dx, p));
  fflush(stdout);
}

static void manufactured(void)
{
  puts("| model | wall | h/Δx | L1(v)/U at 16 across | 32 | 64 | order "
       "| L1(p)/ρU² at 64 | order |\n"
       "|---|---|---|---|---|---|---|---|---|");
  for (int k = 0; k < MODELS; k++)
    for (int no_slip = 0; no_slip < 2; no_slip++) manufactured_row(model[k], no_slip, 0);
  for (int k = 0; k < MODELS; k++) manufactured_row(model[k], 1, 2);
}

static void impact(void)
{
  puts("| model | particles | lost | least distance to a wall | energy left |\n"
       "|---|---|---|---|---|");
  for (int k = 0; k < MODELS; k++) {
    const wall_impact r = wall_scene_impact(model[k], 20, 10);
    if (r.status)
      printf("| `%s` | %ld | %s |\n", model[k], r.particles, r.error);
    else
      printf("| `%s` | %ld | %ld | %.2f Δx | %.3f |\n", model[k], r.particles, r.lost, r.least,
             r.energy);
    fflush(stdout);
  }
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name;
    void (*print)(void);
  } table[] = {{"rest", rest}, {"channel", channel},           {"cylinders", cylinders},
               {"heat", heat}, {"manufactured", manufactured}, {"impact", impact}};
  int found = 0;
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    if (argc > 1 && strcmp(argv[1], table[k].name)) continue;
    if (argc < 2) printf("\n## %s\n\n", table[k].name);
    table[k].print();
    found = 1;
  }
  if (!found) fprintf(stderr, "walls: what is %s?\n", argv[1]);
  return found ? 0 : 2;
}
