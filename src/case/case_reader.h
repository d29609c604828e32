/* case_reader.h -- YAML as a small tree that knows where everything stands. */
#ifndef SPH_CASE_READER_H
#define SPH_CASE_READER_H
#include <stddef.h>

#include "sphode/base.h"

enum { SPH_CASE_BYTES = 1 << 20, SPH_CASE_DEPTH = 32 };

enum sph_case_kind { SPH_CASE_SCALAR, SPH_CASE_MAP, SPH_CASE_LIST };

typedef struct sph_case_node sph_case_node;
struct sph_case_node {
  enum sph_case_kind kind;
  int line, column; /* of the value, from 1; 0: given by --set or a default */
  int key_line, key_column;
  const char *origin; /* where line is 0: "--set a=b", "default"; borrowed */
  const char *file;   /* that it stands in, NULL: that of the case; borrowed */
  char *key;          /* in a mapping, owned; NULL in a list */
  char *text;         /* of a scalar, owned */
  int quoted;         /* a scalar in quotes: never empty, never a number */
  double number;      /* of a checked number [SI] */
  sph_case_node *first, *last, *next;
};

/* The tree of one document, NULL with an error "path:line:column: ..."; path only stands in
 * messages. */
sph_case_node *sph_case_reader_parse(const char *path, const char *text, size_t size,
                                     sph_error *error);
/* Bytes of a file, with a NUL behind; at most SPH_CASE_BYTES. */
char *sph_case_reader_load(const char *path, size_t *size, sph_error *error);

sph_case_node *sph_case_reader_new(enum sph_case_kind kind, const char *key, const char *text,
                                   sph_error *error);
void sph_case_reader_append(sph_case_node *parent, sph_case_node *child);
void sph_case_reader_free(sph_case_node *node);
/* NULL parent or no such key: NULL. */
sph_case_node *sph_case_reader_find(const sph_case_node *parent, const char *key);
/* Of a checked mapping (NULL: empty): a number [SI], a text; `standard` where there is none. */
double sph_case_reader_number(const sph_case_node *map, const char *key, double standard);
const char *sph_case_reader_text(const sph_case_node *map, const char *key, const char *standard);
/* values[3]: the numbers of a list, zero behind them; 0 where there is none. */
int sph_case_reader_vector(const sph_case_node *map, const char *key, double values[3]);

#endif
