/* si_unit.h -- units of measurement: a factor to SI and the exponents of kg, m, s, K, mol. */
#ifndef SPH_SI_UNIT_H
#define SPH_SI_UNIT_H
#include <stddef.h>

enum { SPH_SI_BASES = 5 }; /* kg, m, s, K, mol */

typedef struct sph_si_unit {
  double factor; /* value in SI = value in this unit * factor */
  double power[SPH_SI_BASES];
} sph_si_unit;

/* Reads a unit as long as one stands there: "m/s^2", "kPa", "N m", "/s"; returns the characters
 * taken, 0: none. Behind * or / stands a unit only if is_name(ctx, word, length) says that the
 * word is no name of the user's. */
size_t sph_si_unit_parse(const char *text, int (*is_name)(void *ctx, const char *word, size_t),
                         void *ctx, sph_si_unit *unit);
/* Are the exponents the same? */
int sph_si_unit_same(const double a[SPH_SI_BASES], const double b[SPH_SI_BASES]);
/* Whether a word is a unit, by itself. */
int sph_si_unit_known(const char *word, size_t length);
/* "did you mean m^3? " of a word that is no unit, or "", in text[size]. */
const char *sph_si_unit_nearest(const char *word, char *text, size_t size);
/* "m/s^2", "kg/m^3", "1" of the exponents. */
void sph_si_unit_write(const double power[SPH_SI_BASES], char *text, size_t size);

#endif
