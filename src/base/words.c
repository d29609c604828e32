#include "words.h"

#include <stdio.h>
#include <string.h>

#include "name.h"

void sph_words_add(sph_words *w, const char *word)
{
  size_t n = strlen(w->known);
  snprintf(w->known + n, sizeof w->known - n, "%s%s", n ? ", " : "", word);
  int d = sph_name_distance(w->wanted, word);
  if (3 * d > (int)strlen(word) + 2 || (w->nearest[0] && d >= w->best)) return;
  w->best = d;
  snprintf(w->nearest, sizeof w->nearest, "did you mean '%.40s'? ", word);
}
