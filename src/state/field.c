#include "sphode/field.h"

#include <string.h>

static const sph_field_info fields[] = {
#define X(id, name, symbol, unit, vector, integrated, saved) \
  {name, symbol, unit, vector, integrated, saved},
#include "fields.def"
#undef X
};
enum { FIELDS = sizeof fields / sizeof *fields };

const sph_field_info *sph_field_get(int k) { return k >= 0 && k < FIELDS ? &fields[k] : NULL; }

int sph_field_find(const char *name)
{
  for (int k = 0; name && k < FIELDS; k++)
    if (!strcmp(fields[k].name, name)) return k;
  return -1;
}
