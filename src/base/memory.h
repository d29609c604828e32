/* memory.h -- all memory of the library comes from here, so that tests can make any allocation fail
 * (the linker's --wrap=sph_memory_take). */
#ifndef SPH_MEMORY_H
#define SPH_MEMORY_H
#include <stddef.h>

#include "sphode/base.h"

/* count * size zeroed bytes at a 64-byte boundary, or NULL (also on overflow).  count == 0 gives a
 * valid pointer. */
void *sph_memory_take(size_t count, size_t size);
void sph_memory_free(void *pointer); /* NULL is fine */

/* As sph_memory_take, but NULL is recorded in error as "out of memory: <what>, <bytes> bytes". */
void *sph_memory_new(size_t count, size_t size, const char *what, sph_error *error);

/* Grows *pointer from old_count to new_count elements (new part zeroed); on failure nothing
 * changes. */
int sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                    const char *what, sph_error *error);

/* A copy of a string, or NULL (recorded). */
char *sph_memory_string(const char *text, sph_error *error);

#define SPH_NEW(type, count, what, error) \
  ((type *)sph_memory_new((size_t)(count), sizeof(type), what, error))

#endif
