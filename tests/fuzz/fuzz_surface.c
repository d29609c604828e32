/* libFuzzer: any bytes are a surface of triangles, whose distance is a number everywhere, or they
 * are refused with a message that names the file.  The first byte chooses: STL or OBJ, holes or
 * none, a unit. */
#include "fuzz_file.h"

#include <math.h>
#include <string.h>

#include "sphode.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  static const double at[][3] = {{0, 0, 0}, {0.5, 0.2, 0.1}, {1e6, -1e6, 1}, {-3, 1e-9, 20}};
  double lower[3], upper[3];
  sph_error error = {0};
  if (!size) return 0;
  const char *path = fuzz_file(data[0] & 1 ? "a.obj" : "a.stl", data + 1, size - 1);
  sph_shape *s = sph_shape_surface(path, data[0] & 4 ? 1000 : 1, data[0] & 2, &error);
  if (!s && (!error.status || !strstr(error.text, path))) abort();
  if (s) sph_shape_bounds(s, lower, upper);
  for (int k = 0; s && k < 4; k++)
    if (isnan(sph_shape_distance(s, at[k]))) abort();
  sph_shape_free(s);
  return 0;
}
