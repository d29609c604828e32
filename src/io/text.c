#include "text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "memory.h"

static int reserve(sph_text *text, size_t more)
{
  size_t needed = text->length + more + 1;
  if (text->error.status != SPH_OK) return 0;
  if (needed <= text->capacity) return 1;
  size_t capacity = 2 * needed + 200;
  void *data = text->data;
  if (sph_memory_grow(&data, text->data ? text->length + 1 : 0, capacity, 1, "a text",
                      &text->error) != SPH_OK)
    return 0;
  text->data = data;
  text->capacity = capacity;
  return 1;
}

/* Adds if there is room; returns how many bytes are needed besides those there, 0: done. */
static size_t print(sph_text *text, const char *format, va_list arguments)
{
  size_t room = text->capacity - text->length;
  int length = vsnprintf(room ? text->data + text->length : NULL, room, format, arguments);
  if (length >= 0 && (size_t)length < room) {
    text->length += (size_t)length;
    return 0;
  }
  if (room) text->data[text->length] = '\0';
  return length < 0 ? 0 : (size_t)length;
}

void sph_text_add(sph_text *text, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  size_t more = print(text, format, arguments);
  va_end(arguments);
  if (more == 0 || !reserve(text, more)) return;
  va_start(arguments, format);
  print(text, format, arguments);
  va_end(arguments);
}

void sph_text_append(sph_text *text, const void *data, size_t bytes)
{
  if (!reserve(text, bytes)) return;
  memcpy(text->data + text->length, data, bytes);
  text->length += bytes;
  text->data[text->length] = '\0';
}

void sph_text_free(sph_text *text)
{
  sph_memory_free(text->data);
  *text = (sph_text){0};
}

void sph_text_json_string(sph_text *text, const char *value)
{
  if (!value) {
    sph_text_add(text, "null");
    return;
  }
  sph_text_add(text, "\"");
  for (const char *c = value; *c; c++) {
    if (*c == '"' || *c == '\\')
      sph_text_add(text, "\\%c", *c);
    else if ((unsigned char)*c < 0x20)
      sph_text_add(text, "\\u%04x", (unsigned)(unsigned char)*c);
    else
      sph_text_add(text, "%c", *c);
  }
  sph_text_add(text, "\"");
}

/* The shorter of 15 and 17 digits that reads back to the same number. */
void sph_text_json_number(sph_text *text, double value)
{
  char digits[40];
  snprintf(digits, sizeof digits, "%.15g", value);
  if (strtod(digits, NULL) != value) snprintf(digits, sizeof digits, "%.17g", value);
  sph_text_add(text, "%s", isfinite(value) ? digits : "null");
}

void sph_text_gnuplot_string(sph_text *text, const char *value)
{
  sph_text_add(text, "'");
  for (const char *c = value; *c; c++) {
    if (*c == '\'') sph_text_add(text, "'");
    if ((unsigned char)*c >= 0x20 && *c != 0x7f) sph_text_add(text, "%c", *c);
  }
  sph_text_add(text, "'");
}
