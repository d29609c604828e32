/* name.h -- names that a user may have mistyped. */
#ifndef SPH_NAME_H
#define SPH_NAME_H

/* Letters to insert, delete or replace to make b of a (Levenshtein 1966), small and capital ones
 * being the same; both are cut at 64. */
int sph_name_distance(const char *a, const char *b);

#endif
