#include <stdarg.h>
#include <stdio.h>

#include "sphode/base.h"

int sph_error_set(sph_error *error, int status, const char *format, ...)
{
  if (!error) return status;
  if (error->status != SPH_OK) return error->status;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error->text, sizeof error->text, format, arguments);
  va_end(arguments);
  error->status = status;
  return status;
}
