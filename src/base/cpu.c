#include "cpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config.h"

static const struct {
  const char *name;
  int lanes;
} isas[SPH_ISA_COUNT] = {
#define ROW(suffix, name, lanes) {name, lanes},
    SPH_ISA_LIST(ROW)
#undef ROW
};

/* Built into this library and run by this processor. */
static int usable(int isa)
{
  switch (isa) {
  case SPH_ISA_reference: return 1;
#ifndef SPH_HAVE_X86_64_V2
  case SPH_ISA_generic: return 1;
#else
  case SPH_ISA_x86_64_v2:
    return __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt");
#endif
#ifdef SPH_HAVE_X86_64_V3
  case SPH_ISA_x86_64_v3:
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
#endif
#ifdef SPH_HAVE_X86_64_V4
  case SPH_ISA_x86_64_v4:
  case SPH_ISA_x86_64_v4_newton:
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma");
#endif
  default: return 0;
  }
}

/* Intel's divider takes 24 cycles for a root of eight lanes and 16 for a division, one after the
 * other: longer than the rest of a pair.  AMD's takes less than the rest. */
static int slow_roots(void)
{
#ifdef SPH_HAVE_X86_64_V4
  return __builtin_cpu_is("intel");
#else
  return 0;
#endif
}

int sph_cpu_isa(const char *name, sph_error *error)
{
  if (!name) name = getenv("SPHODE_ISA");
  if (name && !*name) name = NULL;
  char known[200] = "";
  for (int isa = SPH_ISA_COUNT - 1; isa >= 0; isa--) {
    if (!usable(isa)) continue;
    if (name ? !strcmp(name, isas[isa].name) : isa != SPH_ISA_x86_64_v4 || !slow_roots())
      return isa;
    size_t used = strlen(known);
    snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", isas[isa].name);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "isa \"%s\": this processor and build run %s", name,
                known);
  return -1;
}

int sph_cpu_isa_mixed(int isa, sph_error *error)
{
  if (isa == SPH_ISA_x86_64_v3) return SPH_ISA_x86_64_v3_mixed;
  if (isa == SPH_ISA_x86_64_v4 || isa == SPH_ISA_x86_64_v4_newton) return SPH_ISA_x86_64_v4_mixed;
  sph_error_set(
      error, SPH_ERR_ARGUMENT,
      "mixed precision needs a processor and a build with AVX2 (x86-64-v3), these loops are "
      "%s: leave precision at double",
      sph_cpu_isa_name(isa));
  return -1;
}

const char *sph_cpu_isa_name(int isa)
{
  return isa >= 0 && isa < SPH_ISA_COUNT ? isas[isa].name : "";
}

int sph_cpu_lanes(int isa) { return isa >= 0 && isa < SPH_ISA_COUNT ? isas[isa].lanes : 0; }
