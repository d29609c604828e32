/* Where in the file that stands which a message of the simulation names. */
#include <stdio.h>
#include <string.h>

#include "case_schema.h"
#include "sphode/case.h"

#define child_of sph_case_reader_find

/* The child whose name stands behind `word` in the message; NULL: none does. */
static const sph_case_node *named(const sph_case_node *map, const char *message, const char *word)
{
  const char *at = map ? strstr(message, word) : NULL;
  if (!at) return NULL;
  at += strlen(word);
  for (const sph_case_node *child = map->first; child; child = child->next) {
    const size_t n = strlen(child->key);
    if (!strncmp(at, child->key, n) && (at[n] == ':' || at[n] == ' ' || at[n] == ',')) return child;
  }
  return NULL;
}

int sph_case_place(const sph_case *c, const char *message, char *place, size_t size)
{
  if (!c || !message || !place) return 0;
  const sph_case_node *output = child_of(c->root, "output"), *groups = child_of(c->root, "groups"),
                      *terms = child_of(c->root, "terms");
  const struct {
    const char *word;
    const sph_case_node *map;
  } table[] = {{"probe ", child_of(output, "probes")},
               {"monitor ", child_of(output, "monitors")},
               {"a force on ", child_of(output, "forces")},
               {"event ", child_of(c->root, "events")},
               {"the first of ", groups},
               {"group ", groups},
               {"wall ", groups},
               {"term ", child_of(c->root, "scalars")},
               {"term ", terms},
               {"right-hand side with ", terms},
               {"", terms}}; /* it begins with one */
  const sph_case_node *node = NULL;
  for (size_t k = 0; k < sizeof table / sizeof *table && !node; k++)
    node = named(table[k].map, message, table[k].word);
  if (!node || node->key_line == 0) return 0;
  snprintf(place, size, "%s:%d:%d", node->file ? node->file : c->path, node->key_line,
           node->key_column);
  return 1;
}
