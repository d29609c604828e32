/* libFuzzer: any bytes are a file of VTK with particles, or refused by a message that names it. */
#include "fuzz_file.h"

#include <string.h>

#include "sphode.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  const char *path = fuzz_file("a.vtu", data, size);
  sph_sim *sim = sph_sim_create(&(sph_sim_def){.dim = 2, .dx = 0.1});
  sph_group *water = sph_group_create(sim, "water", "fluid");
  sph_import(sim, water, &(sph_import_def){.path = path, .rho0 = 1000});
  if (sph_sim_status(sim) ? !strstr(sph_sim_error(sim), path) : sph_group_count(water) < 1) abort();
  sph_sim_free(sim);
  return 0;
}
