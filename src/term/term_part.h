/* term_part.h -- which part of f each term belongs to. */
#ifndef SPH_TERM_PART_H
#define SPH_TERM_PART_H
#include "term_set.h"

enum sph_term_part_number {
  SPH_TERM_EXPLICIT, /* or slow; all terms at first */
  SPH_TERM_IMPLICIT,
  SPH_TERM_FAST
};

/* The term of that name, added before, belongs to that part: "explicit" or "slow", "implicit",
 * "fast".  Else recorded. */
int sph_term_part_set(sph_term_set *set, const char *term, const char *part, sph_error *error);
/* Where no part was set: the terms that an implicit scheme is for are implicit.  0 or, where there
 * is none, a failure (recorded). */
int sph_term_part_default(sph_term_set *set, sph_error *error);
/* What a term changes that may be implicit, enum sph_term_changes; else recorded. */
int sph_term_part_changes(const sph_term *term, unsigned *changes, sph_error *error);
/* Name of a built-in term that has one of these bits; NULL: none has. */
const char *sph_term_part_named(unsigned bits);
/* Name of the first term of that part; NULL: none. */
const char *sph_term_part_first(const sph_term_set *set, int part);

#endif
