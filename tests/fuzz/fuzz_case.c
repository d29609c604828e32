/* libFuzzer: any bytes are a case file that is read and checked, or refused with a message. */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sphode.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  sph_error error = {0};
  char *text = malloc(size + 1); /* as a file is read: with a NUL behind it */
  if (!text) return 0;
  memcpy(text, data, size);
  text[size] = 0;
  sph_case *c = sph_case_read_text("fuzz.yml", text, size, 0, NULL, &error);
  if (!c && (!error.status || !strstr(error.text, "fuzz.yml"))) abort(); /* told, and where */
  sph_case_free(c);
  free(text);
  return 0;
}
