#include "memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };

/* In the line before stands the address that calloc gave.  Large blocks of calloc's are pages that
 * cost nothing before they are touched: SUNDIALS clones vectors that it never uses. */
void *sph_memory_take(size_t count, size_t size)
{
  if (size && count > (SIZE_MAX - 2 * LINE) / size) return NULL;
  size_t bytes = (count * size + LINE - 1) / LINE * LINE;
  if (bytes == 0) bytes = LINE;
  char *start = calloc(1, bytes + LINE);
  if (!start) return NULL;
  char *line = start + LINE - (uintptr_t)start % LINE;
  memcpy(line - sizeof start, &start, sizeof start);
  return line;
}

void sph_memory_free(void *pointer)
{
  char *start;
  if (!pointer) return;
  memcpy(&start, (char *)pointer - sizeof start, sizeof start);
  free(start);
}

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
