/* words.h -- a word that is unknown, the known ones, and which of them is nearest to it. */
#ifndef SPH_WORDS_H
#define SPH_WORDS_H

typedef struct sph_words {
  const char *wanted; /* set by the caller, the rest zero */
  char known[800];    /* "a, b, c" */
  char nearest[64];   /* "did you mean 'b'? " or "" */
  int best;
} sph_words;

/* One more known word. */
void sph_words_add(sph_words *words, const char *word);

#endif
