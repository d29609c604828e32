/* fuzz_file.h -- the bytes of one try as a file, in a folder of the process. */
#ifndef SPH_FUZZ_FILE_H
#define SPH_FUZZ_FILE_H
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In TMPDIR, which the script makes and removes. */
static inline const char *fuzz_file(const char *name, const uint8_t *data, size_t size)
{
  static char folder[200], path[300];
  if (!folder[0]) {
    const char *in = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/sphode-fuzz-XXXXXX", in ? in : ".");
    if (!mkdtemp(folder)) abort();
  }
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "wb");
  if (!file || fwrite(data, 1, size, file) != size || fclose(file)) abort();
  return path;
}

#endif
