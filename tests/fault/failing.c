/* All doors of memory.c, wrapped by the linker; it does not see the calls inside memory.c, so each
 * door is wrapped by itself. */
#include "failing.h"

#include <stdint.h>

#include "memory.h"

long fail_at, calls;

static int fails(void) { return ++calls == fail_at; }

void *__real_sph_memory_take(size_t count, size_t size);
void *__wrap_sph_memory_take(size_t count, size_t size);
void *__wrap_sph_memory_take(size_t count, size_t size)
{
  return fails() ? NULL : __real_sph_memory_take(count, size);
}

void *__real_sph_memory_new(size_t count, size_t size, const char *what, sph_error *error);
void *__wrap_sph_memory_new(size_t count, size_t size, const char *what, sph_error *error);
void *__wrap_sph_memory_new(size_t count, size_t size, const char *what, sph_error *error)
{
  return __real_sph_memory_new(fails() ? SIZE_MAX : count, size, what, error);
}

int __real_sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                           const char *what, sph_error *error);
int __wrap_sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                           const char *what, sph_error *error);
int __wrap_sph_memory_grow(void **pointer, size_t old_count, size_t new_count, size_t size,
                           const char *what, sph_error *error)
{
  if (fails()) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: %s", what);
  return __real_sph_memory_grow(pointer, old_count, new_count, size, what, error);
}

char *__real_sph_memory_string(const char *text, sph_error *error);
char *__wrap_sph_memory_string(const char *text, sph_error *error);
char *__wrap_sph_memory_string(const char *text, sph_error *error)
{
  if (!fails()) return __real_sph_memory_string(text, error);
  sph_error_set(error, SPH_ERR_MEMORY, "out of memory: a string");
  return NULL;
}
