#include "sphode/base.h"

const char *sph_status_text(int status)
{
  switch (status) {
#define SPH_STATUS_CASE(name, value, text) \
  case value: return text;
    SPH_STATUS_LIST(SPH_STATUS_CASE)
#undef SPH_STATUS_CASE
  default: return "unknown status";
  }
}
