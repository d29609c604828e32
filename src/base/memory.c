#include "memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#if (defined(__unix__) || defined(__APPLE__)) && !defined(__SANITIZE_ADDRESS__)
#include <sys/mman.h>
#endif

enum { LINE = 64, PIECE = 4096, LARGE = 1 << 20 };

/* Stands in the line before what was taken. */
typedef struct origin {
  void *start;
  size_t mapped; /* bytes; 0: of calloc */
} origin;

/* Large blocks are pages of their own, which cost nothing before they are touched (SUNDIALS clones
 * vectors that it never uses, and there is room for growth) and are given back at once: calloc
 * takes blocks that were freed, writes zeros over all of them, and keeps holes. */
static origin begin(size_t bytes)
{
#ifdef MAP_ANONYMOUS
  if (bytes >= LARGE) {
    void *pages = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return pages == MAP_FAILED ? (origin){NULL, 0} : (origin){pages, bytes};
  }
#endif
  return (origin){calloc(1, bytes), 0};
}

void *sph_memory_take(size_t count, size_t size)
{
  if (size && count > (SIZE_MAX - 2 * LINE) / size) return NULL;
  size_t bytes = (count * size + LINE - 1) / LINE * LINE;
  if (bytes == 0) bytes = LINE;
  const origin from = begin(bytes + LINE);
  if (!from.start) return NULL;
  char *line = (char *)from.start + LINE - (uintptr_t)from.start % LINE;
  memcpy(line - sizeof from, &from, sizeof from);
  return line;
}

void sph_memory_free(void *pointer)
{
  origin from;
  if (!pointer) return;
  memcpy(&from, (char *)pointer - sizeof from, sizeof from);
#ifdef MAP_ANONYMOUS
  if (from.mapped) {
    munmap(from.start, from.mapped);
    return;
  }
#endif
  free(from.start);
}

void *sph_memory_new(size_t count, size_t size, const char *what, sph_error *error)
{
  void *pointer = sph_memory_take(count, size);
  if (!pointer)
    sph_error_set(error, SPH_ERR_MEMORY, "out of memory: %s, %.0f bytes", what,
                  (double)count * (double)size);
  return pointer;
}

/* Into zeros: pieces without anything else are left as they are, pages that nobody touched. */
static void copy(char *to, const char *from, size_t bytes)
{
  for (size_t k = 0; k < bytes; k += PIECE) {
    const size_t n = bytes - k < PIECE ? bytes - k : PIECE;
    if (from[k] || memcmp(from + k, from + k + 1, n - 1)) memcpy(to + k, from + k, n);
  }
}

int sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                    const char *what, sph_error *error)
{
  void *grown = sph_memory_new(new_count, size, what, error);
  if (!grown) return SPH_ERR_MEMORY;
  if (*pointer && old_count) copy(grown, *pointer, old_count * size);
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
