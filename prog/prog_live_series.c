/* What the live page gets of a table that grows. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog_live.h"

enum { LIVE_ROWS = 400 };

/* All of a file, with a NUL behind it (malloc). */
static char *read_file(const char *path)
{
  FILE *file = fopen(path, "rb");
  const long size = file && !fseek(file, 0, SEEK_END) ? ftell(file) : -1;
  char *text = size > 0 ? malloc((size_t)size + 1) : NULL;
  if (text) {
    rewind(file);
    text[fread(text, 1, (size_t)size, file)] = '\0';
  }
  if (file) fclose(file);
  return text;
}

static long count_lines(const char *text)
{
  long n = 0;
  for (const char *at = text; (at = strchr(at, '\n')); at++) n++;
  return n;
}

char *sph_prog_live_series_read(const char *path, size_t *size)
{
  char *text = read_file(path);
  const long rows = text ? count_lines(text) - 1 : -1;
  if (rows < 0) return free(text), NULL;
  const long every = rows > LIVE_ROWS ? (rows - 1) / LIVE_ROWS + 1 : 1;
  char *from = text, *to = text, *end;
  /* In place: what is kept lies before where it came from. */
  for (long k = -1; (end = strchr(from, '\n')); k++, from = end + 1) {
    if (k >= 0 && k % every && k != rows - 1) continue;
    const size_t length = (size_t)(end - from) + 1;
    memmove(to, from, length);
    to += length;
  }
  *size = (size_t)(to - text);
  return text;
}
