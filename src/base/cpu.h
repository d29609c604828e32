/* cpu.h -- which instances of the pair loops this processor can run. */
#ifndef SPH_CPU_H
#define SPH_CPU_H
#include "config.h"
#include "sphode/base.h"

/* Suffix of the exported tables, name for people, lanes; slow to fast, then those of mixed
 * precision. */
#define SPH_ISA_LIST(X)                      \
  X(reference, "reference", 1)               \
  X(generic, "generic", 2)                   \
  X(x86_64_v2, "x86-64-v2", 2)               \
  X(x86_64_v3, "x86-64-v3", 4)               \
  X(x86_64_v4_newton, "x86-64-v4-newton", 8) \
  X(x86_64_v4, "x86-64-v4", 8)               \
  X(x86_64_v3_mixed, "x86-64-v3, mixed", 8)  \
  X(x86_64_v4_mixed, "x86-64-v4, mixed", 8)

enum sph_isa {
#define SPH_ISA_ENUM(suffix, name, lanes) SPH_ISA_##suffix,
  SPH_ISA_LIST(SPH_ISA_ENUM)
#undef SPH_ISA_ENUM
      SPH_ISA_COUNT
};

/* Those built into this library: X(suffix, suffix of the tables that it takes).  Two lanes once:
 * processors without x86-64-v2, which are from before 2009, take the reference.
 *
 *   SPH_ISA_BUILT        loops of doubles, for all that is simulated
 *   SPH_ISA_BUILT_LISTS  those that look at positions alone: of mixed precision, too
 *   SPH_ISA_BUILT_FUSED  those that most time goes to: roots by Newton's steps (simd.h) have their
 *                        own, mixed precision has floats (single_loop.h);
 *   SPH_ISA_BUILT_WALLS  floats, too, but no roots of their own */
#ifdef SPH_HAVE_X86_64_V2
#define SPH_ISA_TWO_LANES "x86-64-v2"
#define SPH_ISA_BUILT_TWO(X) X(x86_64_v2, x86_64_v2)
#else
#define SPH_ISA_TWO_LANES "generic"
#define SPH_ISA_BUILT_TWO(X) X(generic, generic)
#endif
#ifdef SPH_HAVE_X86_64_V3
#define SPH_ISA_BUILT_V3(X) X(x86_64_v3, x86_64_v3)
#define SPH_ISA_BUILT_V3_MIXED(X, loops) X(x86_64_v3_mixed, loops)
#else
#define SPH_ISA_BUILT_V3(X)
#define SPH_ISA_BUILT_V3_MIXED(X, loops)
#endif
#ifdef SPH_HAVE_X86_64_V4
#define SPH_ISA_BUILT_V4(X, newton) X(x86_64_v4, x86_64_v4) X(x86_64_v4_newton, newton)
#define SPH_ISA_BUILT_V4_MIXED(X, loops) X(x86_64_v4_mixed, loops)
#else
#define SPH_ISA_BUILT_V4(X, newton)
#define SPH_ISA_BUILT_V4_MIXED(X, loops)
#endif
#define SPH_ISA_BUILT_DOUBLE(X, newton) \
  X(reference, reference) SPH_ISA_BUILT_TWO(X) SPH_ISA_BUILT_V3(X) SPH_ISA_BUILT_V4(X, newton)
#define SPH_ISA_BUILT(X) SPH_ISA_BUILT_DOUBLE(X, x86_64_v4) SPH_ISA_BUILT_V4_MIXED(X, x86_64_v4)
#define SPH_ISA_BUILT_LISTS(X) SPH_ISA_BUILT(X) SPH_ISA_BUILT_V3_MIXED(X, x86_64_v3_mixed)
#define SPH_ISA_BUILT_HOT(X, newton)          \
  SPH_ISA_BUILT_DOUBLE(X, newton)             \
  SPH_ISA_BUILT_V4_MIXED(X, x86_64_v4_single) \
  SPH_ISA_BUILT_V3_MIXED(X, x86_64_v3_single)
#define SPH_ISA_BUILT_FUSED(X) SPH_ISA_BUILT_HOT(X, x86_64_v4_newton)
#define SPH_ISA_BUILT_WALLS(X) SPH_ISA_BUILT_HOT(X, x86_64_v4)

/* In a *_loops.c, compiled once per instruction set with SPH_ISA its suffix: the name of its
 * table. */
#define SPH_ISA_JOIN_(name, isa) name##_##isa
#define SPH_ISA_JOIN(name, isa) SPH_ISA_JOIN_(name, isa)
#define SPH_ISA_NAME(name) SPH_ISA_JOIN(name, SPH_ISA)

/* Instruction set number by name; name == NULL: SPHODE_ISA of the environment, else the best of
 * this processor.  Unknown, not built or not run by this processor: -1, recorded with the names
 * that work. */
int sph_cpu_isa(const char *name, sph_error *error);
/* That of mixed precision beside isa; -1, recorded, where it has none. */
int sph_cpu_isa_mixed(int isa, sph_error *error);
const char *sph_cpu_isa_name(int isa);
int sph_cpu_lanes(int isa);

#endif
