#include "memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };

void *sph_memory_take(size_t count, size_t size)
{
  if (size && count > (SIZE_MAX - LINE) / size) return NULL;
  size_t bytes = (count * size + LINE - 1) / LINE * LINE;
  if (bytes == 0) bytes = LINE;
  void *pointer = aligned_alloc(LINE, bytes);
  if (pointer) memset(pointer, 0, bytes);
  return pointer;
}

void sph_memory_free(void *pointer) { free(pointer); }

void *sph_memory_new(size_t count, size_t size, const char *what, sph_error *error)
{
  void *pointer = sph_memory_take(count, size);
  if (!pointer)
    sph_error_set(error, SPH_ERR_MEMORY, "out of memory: %s, %.0f bytes", what,
                  (double)count * (double)size);
  return pointer;
}

int sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                    const char *what, sph_error *error)
{
  void *grown = sph_memory_new(new_count, size, what, error);
  if (!grown) return SPH_ERR_MEMORY;
  if (*pointer && old_count) memcpy(grown, *pointer, old_count * size);
  sph_memory_free(*pointer);
  *pointer = grown;
  return SPH_OK;
}

char *sph_memory_string(const char *text, sph_error *error)
{
  size_t bytes = strlen(text) + 1;
  char *copy = sph_memory_new(bytes, 1, "a string", error);
  if (copy) memcpy(copy, text, bytes);
  return copy;
}
