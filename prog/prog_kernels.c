/* sphode info kernels: what there is to choose from, and values of W. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "prog.h"

/* "no", or how far below zero the transform falls. */
static void print_pairing(const sph_kernel *kernel, int dim)
{
  double least = sph_kernel_least_transform(kernel, dim);
  if (least < 0)
    printf(" %7.0e", least);
  else
    printf(" %7s", "no");
}

void sph_prog_kernels_table(void)
{
  const sph_kernel *kernel;
  printf("%36s %9s %17s %11s %15s\n", "", "neighbors", "sum V W - 1", "sigma_k/h", "pairing");
  printf("%-16s %-7s %6s %4s %4s %4s %8s %8s %5s %5s %7s %7s %5s\n", "name", "support", "smooth",
         "h/dx", "2D", "3D", "2D", "3D", "2D", "3D", "2D", "3D", "rate");
  for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
    double h_over_dx = sph_kernel_h_over_dx(kernel);
    printf("%-16s %g h %10s %4.3g", sph_kernel_name(kernel), sph_kernel_support(kernel),
           sph_kernel_smoothness(kernel), h_over_dx);
    for (int dim = 2; dim <= 3; dim++)
      printf(" %4.0f", sph_kernel_neighbors(kernel, dim, h_over_dx));
    for (int dim = 2; dim <= 3; dim++)
      printf(" %+8.1e", sph_kernel_lattice_error(kernel, dim, h_over_dx));
    for (int dim = 2; dim <= 3; dim++) printf(" %5.3f", sph_kernel_deviation(kernel, dim));
    for (int dim = 2; dim <= 3; dim++) print_pairing(kernel, dim);
    printf(" %5.2f\n", sph_kernel_rate(kernel));
  }
  puts("\nneighbors, sum V W - 1: of a particle of a square or cubic lattice, at that h/dx\n"
       "sigma_k: standard deviation of W; kernels of equal sigma_k resolve alike\n"
       "pairing: no, or how far below zero the Fourier transform of W falls: such particles can "
       "pair\n"
       "         where they have many neighbors\n"
       "rate: pairs per second in 3D over those of wendland-c2, as once measured\n");
  for (int k = 0; (kernel = sph_kernel_get(k)); k++) {
    puts(sph_kernel_name(kernel));
    for (int dim = 1; dim <= 3; dim++) printf("  %dD  %s\n", dim, sph_kernel_formula(kernel, dim));
  }
}

int sph_prog_kernels_values(const prog_options *o)
{
  if (!o->q) return sph_prog_error(PROG_USAGE, "--csv wants --q, as in --q 0,0.25,1.3");
  for (const char *at = o->q; *at;) { /* all right before anything is printed */
    char *end;
    double q = strtod(at, &end);
    if (end == at || !(q >= 0) || isinf(q) || (*end && (*end != ',' || !end[1])))
      return sph_prog_error(PROG_USAGE, "--q %s: found '%s'; wanted numbers >= 0 with commas", o->q,
                            at);
    at = *end ? end + 1 : end;
  }
  puts("kernel,dim,q,W,dWdr,laplacian");
  const sph_kernel *kernel;
  for (int k = 0; (kernel = sph_kernel_get(k)); k++)
    for (int dim = 1; dim <= 3; dim++)
      for (const char *at = o->q; *at; at += *at == ',') {
        char *end;
        double q = strtod(at, &end);
        printf("%s,%d,%.17g,%.17g,%.17g,%.17g\n", sph_kernel_name(kernel), dim, q,
               sph_kernel_w(kernel, dim, q, 1), sph_kernel_dwdr(kernel, dim, q, 1) + 0.0,
               sph_kernel_laplacian(kernel, dim, q, 1) + 0.0); /* no -0 */
        at = end;
      }
  return PROG_OK;
}
