#include <string.h>

#include "sphode/boundary.h"

sph_boundary sph_boundary_mirror(void) { return (sph_boundary){.name = "mirror"}; }

/* One too many is counted, and told where the boundary is set. */
void sph_boundary_mirror_plane(sph_boundary *boundary, const double *point, const double *normal,
                               int dim)
{
  if (!boundary || boundary->planes > SPH_PLANES_MAX || dim < 1 || dim > 3) return;
  sph_plane plane = {{0}, {0}};
  for (int d = 0; d < dim && point && normal; d++) {
    plane.point[d] = point[d];
    plane.normal[d] = normal[d];
  }
  if (boundary->planes < SPH_PLANES_MAX) boundary->plane[boundary->planes] = plane;
  boundary->planes++;
}

/* A word of `open` that names no side leaves a plane without a normal, which is told later. */
static int all_known(const char *open, int dim)
{
  for (const char *s = open ? open : ""; *s; s++) {
    if (*s == ' ' || *s == ',') continue;
    if (!(*s >= 'x' && *s < 'x' + dim && (s[1] == '+' || s[1] == '-'))) return 0;
    s++;
  }
  return 1;
}

static int is_open(const char *open, int d, char sign)
{
  const char side[] = {"xyz"[d], sign, 0};
  return open && strstr(open, side) != NULL;
}

void sph_boundary_mirror_box(sph_boundary *boundary, const double *lo, const double *hi,
                             const char *open, int dim)
{
  if (!lo || !hi || !all_known(open, dim)) sph_boundary_mirror_plane(boundary, NULL, NULL, dim);
  for (int d = 0; lo && hi && d < dim && d < 3; d++) {
    double normal[3] = {0};
    normal[d] = 1;
    if (!is_open(open, d, '-')) sph_boundary_mirror_plane(boundary, lo, normal, dim);
    normal[d] = -1;
    if (!is_open(open, d, '+')) sph_boundary_mirror_plane(boundary, hi, normal, dim);
  }
}
