/* case_schema.h -- the table of keys, and the check of a tree against it. */
#ifndef SPH_CASE_SCHEMA_H
#define SPH_CASE_SCHEMA_H
#include "case_reader.h"
#include "case_value.h"
#include "sphode/case.h"

enum sph_case_type {
  SPH_CASE_MAP_T,        /* a mapping of the schema */
  SPH_CASE_LIST_T,       /* a list of them */
  SPH_CASE_NAMED_T,      /* a mapping of the user's names to them */
  SPH_CASE_PARAMETERS_T, /* a mapping of the user's names to numbers */
  SPH_CASE_TEXT_T,
  SPH_CASE_WORD_T,
  SPH_CASE_WORDS_T, /* a list of words */
  SPH_CASE_FLAG_T,
  SPH_CASE_COUNT_T,
  SPH_CASE_NUMBER_T,
  SPH_CASE_LARGEST_T,  /* a number that may use `largest` */
  SPH_CASE_VECTOR_T,   /* dim numbers */
  SPH_CASE_PAIR_T,     /* two numbers */
  SPH_CASE_NUMBERS_T,  /* any number of them */
  SPH_CASE_POINTS_T,   /* any number of pairs */
  SPH_CASE_FIELD_T,    /* an expression in x, y, z */
  SPH_CASE_FIELDS_T,   /* dim of them */
  SPH_CASE_FORMULA_T,  /* an expression in x, y, z, t and the tables */
  SPH_CASE_FORMULAS_T, /* dim of them */
  SPH_CASE_MOMENTS_T,  /* dim expressions in t and the tables */
  SPH_CASE_MOMENT_T,   /* one of these */
  SPH_CASE_TEXTS_T,    /* a text or a list of them */
  SPH_CASE_SOURCE_T    /* an expression in x, y, z, t, the tables and fields: case_source.h */
};

typedef struct sph_case_mapping {
  const char *name;
  int one; /* exactly one key is given */
  const char *about;
} sph_case_mapping;

typedef struct sph_case_key {
  const char *mapping, *name;
  enum sph_case_type type;
  const char *unit, *standard; /* default: see case_schema.def */
  double low, high;
  const char *more, *about;
} sph_case_key;

enum { SPH_CASE_NAMES = 100, SPH_CASE_SETS = 64, SPH_CASE_INCLUDES = 32 };

struct sph_case {
  char *path, *source; /* owned; source: what was read */
  char *text;          /* the same with what was set, owned; NULL: nothing was */
  sph_case_node *root;
  int dim;
  int n;                               /* of names */
  sph_case_name names[SPH_CASE_NAMES]; /* parameters; names borrowed from the tree */
  int timed_n;
  sph_case_name timed[SPH_CASE_NAMES]; /* the same, and behind them the tables, owned */
  int includes;
  char *include[SPH_CASE_INCLUDES]; /* paths of included files, owned */
  char *set[SPH_CASE_SETS];         /* copies of the --set texts, owned */
  sph_error *error;                 /* while reading; borrowed */
};

const sph_case_mapping *sph_case_schema_mapping(int k); /* NULL behind the last */
const sph_case_key *sph_case_schema_key(int k);         /* NULL behind the last */
/* Choice k of a WORD or WORDS, written to word[80]; NULL behind the last. */
const char *sph_case_schema_choice(const sph_case_key *key, int k, char word[80]);

/* Checks the tree of c, evaluates its numbers, adds the defaults; a status, the reason in
 * c->error. */
int sph_case_check(sph_case *c); /* case_check.c */
/* Can the key be a name in expressions? */
int sph_case_check_name(sph_case *c, const sph_case_node *node);
/* Records "path:line:column: ..."; the key's place or the value's (value == 1), `column`
 * characters into it. */
int sph_case_schema_fail(const sph_case *c, sph_error *error, const sph_case_node *node, int value,
                         int column, const char *format, ...) SPH_PRINTF(6, 7);

#endif
