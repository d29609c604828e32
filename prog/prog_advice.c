/* sphode info kernels --spacing DX: what each kernel means at that spacing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog.h"

/* One kernel at one h. */
typedef struct advice {
  double h_over_dx, h, support; /* [1], [m], [m] */
  double neighbors, error;      /* on the lattice; sum V W - 1 */
  int fits;                     /* h/dx lies in the kernel's range */
} advice;

static advice advise(const sph_kernel *kernel, int dim, double dx, double h_over_dx)
{
  double low = 0, high = 0;
  sph_kernel_range(kernel, dim, &low, &high);
  return (advice){h_over_dx,
                  h_over_dx * dx,
                  sph_kernel_support(kernel) * h_over_dx * dx,
                  sph_kernel_neighbors(kernel, dim, h_over_dx),
                  sph_kernel_lattice_error(kernel, dim, h_over_dx),
                  h_over_dx >= low * (1 - 1e-9) && h_over_dx <= high * (1 + 1e-9)};
}

/* The h/dx at which a kernel resolves as the first one does where that is recommended. */
static double alike(const sph_kernel *kernel, int dim)
{
  const sph_kernel *usual = sph_kernel_get(0);
  return sph_kernel_h_over_dx(usual) * sph_kernel_deviation(usual, dim) /
         sph_kernel_deviation(kernel, dim);
}

static void print_advice(const advice *a)
{
  printf(" %5.3g%c %8.3g %8.3g %5.0f %+8.1e", a->h_over_dx, a->fits ? ' ' : '*', a->h, a->support,
         a->neighbors, a->error);
}

static void print_table(int dim, double dx)
{
  const sph_kernel *kernel;
  printf("dx = %g m, %dD, h as recommended\n\n", dx, dim);
  printf("%-16s %8s %6s %8s %8s %5s %8s %9s %8s\n", "name", "range", "h/dx", "h [m]", "kh [m]",
         "nb", "sum-1", "sigma [m]", "pairing");
  for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
    double low = 0, high = 0, least = sph_kernel_least_transform(kernel, dim);
    const advice a = advise(kernel, dim, dx, sph_kernel_h_over_dx(kernel));
    char range[40], pairing[40] = "no";
    sph_kernel_range(kernel, dim, &low, &high);
    snprintf(range, sizeof range, "%g-%g", low, high);
    if (least < 0) snprintf(pairing, sizeof pairing, "%.0e", least);
    printf("%-16s %8s", sph_kernel_name(kernel), range);
    print_advice(&a);
    printf(" %9.3g %8s\n", sph_kernel_deviation(kernel, dim) * a.h, pairing);
  }
  printf("\nh at which all resolve as %s does at %g dx: sigma = %.3g m\n\n",
         sph_kernel_name(sph_kernel_get(0)), sph_kernel_h_over_dx(sph_kernel_get(0)),
         sph_kernel_deviation(sph_kernel_get(0), dim) * sph_kernel_h_over_dx(sph_kernel_get(0)) *
             dx);
  printf("%-16s %6s %8s %8s %5s %8s\n", "name", "h/dx", "h [m]", "kh [m]", "nb", "sum-1");
  for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
    const advice a = advise(kernel, dim, dx, alike(kernel, dim));
    printf("%-16s", sph_kernel_name(kernel));
    print_advice(&a);
    putchar('\n');
  }
  putchar('\n');
}

static void json_advice(const char *name, const advice *a)
{
  printf("\"%s\": {\"h/dx\": %.9g, \"h\": %.9g, \"support\": %.9g, \"neighbors\": %.9g, "
         "\"lattice-error\": %.9g, \"fits\": %s}",
         name, a->h_over_dx, a->h, a->support, a->neighbors, a->error, a->fits ? "true" : "false");
}

static void print_json(int from, int to, double dx)
{
  const sph_kernel *kernel;
  const char *between = "[";
  for (int dim = from; dim <= to; dim++)
    for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
      double low = 0, high = 0;
      const advice own = advise(kernel, dim, dx, sph_kernel_h_over_dx(kernel));
      const advice equal = advise(kernel, dim, dx, alike(kernel, dim));
      sph_kernel_range(kernel, dim, &low, &high);
      printf("%s\n  {\"name\": \"%s\", \"dim\": %d, \"dx\": %.9g, \"least-h/dx\": %g, "
             "\"most-h/dx\": %g, \"sigma-k\": %.9g, \"least-transform\": %.9g, ",
             between, sph_kernel_name(kernel), dim, dx, low, high,
             sph_kernel_deviation(kernel, dim), sph_kernel_least_transform(kernel, dim));
      json_advice("recommended", &own);
      printf(", ");
      json_advice("equal-resolution", &equal);
      putchar('}');
      between = ",";
    }
  puts("\n]");
}

/* "0.01", "1cm", "1 cm"; 0: no length. */
static double metres(const char *text)
{
  static const struct {
    const char *name;
    double metres;
  } unit[] = {{"", 1},      {"m", 1},     {"dm", 0.1},  {"cm", 0.01},
              {"mm", 1e-3}, {"um", 1e-6}, {"km", 1000}, {"in", 0.0254}};
  char *end;
  const double n = strtod(text, &end);
  if (end == text || !(n > 0) || isinf(n)) return 0;
  end += strspn(end, " ");
  for (size_t k = 0; k < sizeof unit / sizeof *unit; k++)
    if (!strcmp(end, unit[k].name)) return n * unit[k].metres;
  return 0;
}

int sph_prog_advice(const prog_options *o)
{
  if (!o->spacing) return sph_prog_error(PROG_USAGE, "--dim wants --spacing, as in --spacing 1cm");
  const double dx = metres(o->spacing);
  if (!(dx > 0))
    return sph_prog_error(PROG_USAGE,
                          "--spacing %s: wanted a length > 0, as 0.01 (in metres), 1cm, 10mm",
                          o->spacing);
  const int from = o->dim ? o->dim : 2, to = o->dim ? o->dim : 3;
  if (o->json) return print_json(from, to, dx), PROG_OK;
  for (int dim = from; dim <= to; dim++) print_table(dim, dx);
  puts("range: of h/dx that suit the kernel; * outside of it.  kh: radius of the support.\n"
       "nb, sum-1: neighbours of a particle of the lattice, and sum V W - 1 there.\n"
       "sigma: sigma_k h, the standard deviation of W.  pairing: no, or how far below zero the\n"
       "Fourier transform of W falls: with many neighbours such particles pair.");
  return PROG_OK;
}
