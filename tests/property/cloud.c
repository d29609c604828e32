#include "cloud.h"

#include <stdio.h>
#include <stdlib.h>

double *cloud_array(long n)
{
  double *a = calloc((size_t)n + 1, sizeof *a);
  if (!a) fprintf(stderr, "out of memory\n"), exit(99);
  return a;
}

double cloud_noise(cloud *c)
{
  c->state = c->state * 6364136223846793005u + 1442695040888963407u;
  return (double)(c->state >> 11) / 4503599627370496.0 - 1;
}

cloud cloud_make(int dim, int across, double jitter, int periodic, int uneven)
{
  cloud c = {.dim = dim, .periodic = periodic, .n = 1, .dx = 1.0 / across, .state = 1};
  double volume = 1;
  for (int d = 0; d < dim; d++) c.n *= across, volume *= c.dx;
  c.volume = cloud_array(c.n), c.density = cloud_array(c.n);
  for (int d = 0; d < 3; d++) c.x[d] = cloud_array(c.n);
  for (long i = 0; i < c.n; i++) {
    for (long d = 0, rest = i; d < dim; d++, rest /= across)
      c.x[d][i] = ((double)(rest % across) + 0.5 + jitter * cloud_noise(&c)) * c.dx;
    c.volume[i] = volume * (uneven ? 1 + 0.3 * cloud_noise(&c) : 1);
    c.density[i] = uneven ? 1 + 0.5 * cloud_noise(&c) : 1;
  }
  return c;
}

void cloud_free(cloud *c)
{
  for (int d = 0; d < 3; d++) free(c->x[d]);
  free(c->volume), free(c->density);
}

sph_operator *cloud_operator(const cloud *c, sph_operator_def def)
{
  sph_error error = {0};
  const double *const x[] = {c->x[0], c->x[1], c->x[2]};
  def.dim = c->dim;
  for (int d = 0; d < c->dim && c->periodic; d++) def.periodic[d] = 1, def.length[d] = 1;
  sph_operator *op = sph_operator_create(&def, &error);
  sph_operator_set_points(op, c->n, x, c->volume, c->density, &error);
  if (error.status) fprintf(stderr, "%s\n", error.text), exit(99);
  return op;
}
