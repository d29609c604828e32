/* text.h -- a string that grows; the first failure sticks and is told when it is taken. */
#ifndef SPH_TEXT_H
#define SPH_TEXT_H
#include <stddef.h>

#include "sphode/base.h"

typedef struct sph_text {
  char *data; /* [capacity], NUL terminated; NULL while empty */
  size_t length, capacity;
  sph_error error;
} sph_text; /* all zero: empty */

void sph_text_add(sph_text *text, const char *format, ...) SPH_PRINTF(2, 3);
/* Any bytes, NUL among them. */
void sph_text_append(sph_text *text, const void *data, size_t bytes);
void sph_text_free(sph_text *text);

/* JSON: a string in quotes, escaped (NULL: null); a number with 15 digits, 17 where needed (not
 * finite: null). */
void sph_text_json_string(sph_text *text, const char *value);
void sph_text_json_number(sph_text *text, double value);
/* gnuplot: a string in single quotes, control characters left out. */
void sph_text_gnuplot_string(sph_text *text, const char *value);

#endif
