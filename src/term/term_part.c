#include "term_part.h"

#include <string.h>

#include "words.h"

/* May it be implicit? */
enum { NEVER, MAY, DEFAULT }; /* DEFAULT: so it is where no part was set */

static const struct {
  const char *name;
  unsigned bits;
  int implicit;
} built_in[] = {
    {"continuity", SPH_CONTINUITY, NEVER},
    {"pressure", SPH_PRESSURE_FORCE, NEVER},
    {"viscosity-artificial", SPH_ARTIFICIAL, MAY},
    {"viscosity-signal", SPH_SIGNAL, NEVER},
    {"viscosity-laminar", SPH_MORRIS | SPH_MCG, DEFAULT},
    {"conductivity-artificial", SPH_CONDUCTIVITY, NEVER},
    {"conduction", SPH_CONDUCTION, DEFAULT},
    {"xsph", SPH_XSPH, NEVER},
    {"delta", SPH_DIFFUSION, MAY},
    {"drag", SPH_DRAG, DEFAULT},
    {"gravity", SPH_UNIFORM, NEVER},
    {"shifting", SPH_SHIFTING, NEVER},
    {"transport-velocity", SPH_TRANSPORT, NEVER},
    {"stress-artificial", SPH_STRESS, NEVER},
};
enum { BUILT_IN = sizeof built_in / sizeof *built_in };

static const char *const parts[] = {[SPH_TERM_EXPLICIT] = "explicit",
                                    [SPH_TERM_IMPLICIT] = "implicit",
                                    [SPH_TERM_FAST] = "fast",
                                    "slow"};
enum { PARTS = sizeof parts / sizeof *parts };

/* Bits of a set's terms, the uniform force among them. */
static unsigned bits_of(const sph_term_set *set)
{
  return set->bits | (set->uniform ? SPH_UNIFORM : 0);
}

static int part_number(const char *part, sph_error *error)
{
  sph_words words = {.wanted = part ? part : ""};
  for (int k = 0; k < PARTS; k++) {
    if (!strcmp(words.wanted, parts[k])) return k == PARTS - 1 ? SPH_TERM_EXPLICIT : k;
    sph_words_add(&words, parts[k]);
  }
  sph_error_set(error, SPH_ERR_ARGUMENT, "part \"%.60s\"; %sknown: %s", words.wanted, words.nearest,
                words.known);
  return -1;
}

static int unknown(const sph_term_set *set, const char *term, sph_error *error)
{
  sph_words words = {.wanted = term};
  for (int k = 0; k < BUILT_IN; k++)
    if (bits_of(set) & built_in[k].bits) sph_words_add(&words, built_in[k].name);
  for (int k = 0; k < set->called; k++) sph_words_add(&words, set->call[k].name);
  return sph_error_set(error, SPH_ERR_ARGUMENT,
                       "part of term \"%.60s\", which the simulation has not; %sit has: %s", term,
                       words.nearest, words.known[0] ? words.known : "none yet");
}

static int not_implicit(const char *term, sph_error *error)
{
  sph_words words = {.wanted = term};
  for (int k = 0; k < BUILT_IN; k++)
    if (built_in[k].implicit != NEVER) sph_words_add(&words, built_in[k].name);
  return sph_error_set(error, SPH_ERR_ARGUMENT, "%s%s; these can be: %s", term,
                       *term ? " cannot be implicit" : "no term is implicit", words.known);
}

static void assign(sph_term_set *set, unsigned bits, int part)
{
  set->implicit &= ~bits;
  set->fast &= ~bits;
  if (part == SPH_TERM_IMPLICIT) set->implicit |= bits;
  if (part == SPH_TERM_FAST) set->fast |= bits;
}

/* Are its gradients corrected? */
static int corrected(const sph_term_set *set, int k)
{
  return (built_in[k].bits & (SPH_MORRIS | SPH_MCG)) && (set->bits & SPH_LAMINAR_CORRECTED);
}

/* As if no part had been set. */
static int forget(sph_term_set *set)
{
  set->implicit = set->fast = 0;
  for (int k = 0; k < set->called; k++) set->call[k].part = SPH_TERM_EXPLICIT;
  set->parted = 0;
  return SPH_OK;
}

int sph_term_part_changes(const sph_term *term, unsigned *changes, sph_error *error)
{
  static const char *const names[] = {"velocity", "energy", "scalar"};
  const char *at = term->implicit ? term->implicit : "";
  unsigned found = 0;
  for (size_t n; *(at += strspn(at, " ,")); at += n) {
    unsigned k = 0;
    n = strcspn(at, " ,");
    while (k < 3 && (strlen(names[k]) != n || strncmp(at, names[k], n) != 0)) k++;
    if (k == 3)
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "term %s: implicit \"%.60s\"; known: velocity, energy, scalar",
                           term->name, at);
    found |= 1u << k;
  }
  if (found && !term->jacobian_body && !term->jacobian_pair)
    return sph_error_set(error, SPH_ERR_ARGUMENT,
                         "term %s: implicit, but without jacobian_body and jacobian_pair",
                         term->name);
  if ((found & SPH_CHANGES_SCALAR) && !term->scalar.name)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "term %s: implicit scalar, but it has none",
                         term->name);
  if (changes) *changes = found;
  return SPH_OK;
}

int sph_term_part_set(sph_term_set *set, const char *term, const char *part, sph_error *error)
{
  int number = part_number(part, error), found = 0;
  if (number < 0) return SPH_ERR_ARGUMENT;
  if (!term && number == SPH_TERM_EXPLICIT) return forget(set);
  if (!term) term = "";
  for (int k = 0; k < BUILT_IN; k++) {
    if (strcmp(term, built_in[k].name) || !(bits_of(set) & built_in[k].bits)) continue;
    if (number == SPH_TERM_IMPLICIT && built_in[k].implicit == NEVER)
      return not_implicit(term, error);
    if (number == SPH_TERM_IMPLICIT && corrected(set, k))
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "%s of a correction cannot be implicit: its matrix knows no gradient "
                           "matrices; right is correction none, or explicit",
                           term);
    assign(set, built_in[k].bits, number);
    found = 1;
  }
  for (int k = 0; k < set->called; k++) {
    if (strcmp(term, set->call[k].name)) continue;
    if (number == SPH_TERM_IMPLICIT && !set->call[k].changes)
      return sph_error_set(error, SPH_ERR_ARGUMENT,
                           "%s cannot be implicit: it says neither what it changes (implicit) nor "
                           "how (jacobian_body, jacobian_pair)",
                           term);
    set->call[k].part = number;
    found = 1;
  }
  set->parted |= found;
  return found ? SPH_OK : unknown(set, term, error);
}

int sph_term_part_default(sph_term_set *set, sph_error *error)
{
  for (int k = 0; !set->parted && k < BUILT_IN; k++)
    if (built_in[k].implicit == DEFAULT && !corrected(set, k))
      assign(set, bits_of(set) & built_in[k].bits, SPH_TERM_IMPLICIT);
  return sph_term_part_first(set, SPH_TERM_IMPLICIT) ? SPH_OK : not_implicit("", error);
}

const char *sph_term_part_named(unsigned bits)
{
  for (int k = 0; k < BUILT_IN; k++)
    if (bits & built_in[k].bits) return built_in[k].name;
  return NULL;
}

const char *sph_term_part_first(const sph_term_set *set, int part)
{
  unsigned bits = bits_of(set);
  if (part == SPH_TERM_EXPLICIT) bits &= ~(set->implicit | set->fast);
  if (part == SPH_TERM_IMPLICIT) bits &= set->implicit;
  if (part == SPH_TERM_FAST) bits &= set->fast;
  if (sph_term_part_named(bits)) return sph_term_part_named(bits);
  for (int k = 0; k < set->called; k++)
    if (set->call[k].part == part) return set->call[k].name;
  return NULL;
}
