/* What a run of a sweep left: the numbers of its summary, and how it goes on. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "prog_sweep.h"

/* What stands behind "NAME": in a line of a summary, which has a member a line; NULL: another. */
static const char *member(const char *line, const char *name)
{
  char key[40];
  const int n = snprintf(key, sizeof key, "\"%s\": ", name);
  line += strspn(line, " {");
  return strncmp(line, key, (size_t)n) ? NULL : line + n;
}

static double number(const char *text)
{
  char *end;
  const double x = strtod(text, &end);
  return end == text ? NAN : x; /* null */
}

/* A string of JSON, without its quotes. */
static void string(const char *text, char *to, size_t size)
{
  size_t n = 0;
  for (text += *text == '"'; *text && *text != '"' && n + 1 < size; text++) {
    if (*text == '\\' && text[1]) text++;
    to[n++] = *text;
  }
  to[n] = 0;
}

/* A line of the list of comparisons, each of which begins with its name. */
static void take_comparison(sweep_run *r, const char *line)
{
  const char *text = member(line, "name");
  if (text && r->compared < SWEEP_COMPARED)
    string(text, r->of[r->compared++].name, sizeof r->of->name);
  const int c = r->compared - 1;
  if (c < 0) return;
  if ((text = member(line, "norm"))) string(text, r->of[c].norm, sizeof r->of->norm);
  if ((text = member(line, "value"))) r->of[c].value = number(text);
  if ((text = member(line, "pass"))) r->missed += !strncmp(text, "false", 5);
}

int sph_prog_sweep_left_read(const sweep *s, sweep_run *r)
{
  double status = -1, particles = 0, steps = 0;
  const struct {
    const char *name;
    double *to;
  } of[] = {{"status", &status},
            {"spacing_m", &r->spacing},
            {"fluid_particles", &particles},
            {"steps", &steps},
            {"wall_seconds", &r->seconds}};
  char line[4100];
  int comparisons = 0;
  snprintf(line, sizeof line, "%s/%s/summary.json", s->directory, r->name);
  FILE *file = fopen(line, "r");
  r->compared = r->missed = 0;
  while (file && fgets(line, sizeof line, file)) {
    const char *text = NULL;
    for (size_t k = 0; k < sizeof of / sizeof *of; k++)
      if ((text = member(line, of[k].name))) *of[k].to = number(text);
    comparisons |= member(line, "comparisons") != NULL;
    if (comparisons) take_comparison(r, line);
  }
  if (file) fclose(file);
  r->particles = (long)particles, r->steps = (long)steps;
  return (int)status;
}

/* Is the text all of the file?  -1: there is no file. */
static int holds(const char *path, const char *text)
{
  FILE *file = fopen(path, "rb");
  int c;
  if (!file) return -1;
  while ((c = fgetc(file)) != EOF && *text && c == (unsigned char)*text) text++;
  fclose(file);
  return c == EOF && !*text;
}

int sph_prog_sweep_left(const sweep *s, sweep_run *r, const char *text)
{
  char directory[4000], path[4100];
  snprintf(directory, sizeof directory, "%s/%s", s->directory, r->name);
  snprintf(path, sizeof path, "%s/case.yml", directory);
  const int same = holds(path, text);
  if (same < 0) return PROG_OK;
  if (!same)
    return sph_prog_error(PROG_FAILED,
                          "%s is not the case of this sweep; --output DIR goes elsewhere, --force "
                          "writes over it",
                          path);
  const int compares = strstr(text, "\ncompare:") != NULL; /* which may have failed */
  const int status = sph_prog_sweep_left_read(s, r);
  r->done = status == SPH_OK && (r->compared > 0 || !compares);
  r->status = r->missed ? PROG_BAR : PROG_OK;
  r->goes_on = status != SPH_OK && sph_checkpoint_find(directory, 0, NULL, 0);
  return PROG_OK;
}
