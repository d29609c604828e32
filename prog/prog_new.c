/* sphode new: a case to begin with; sphode schema: what editors know cases by. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "prog.h"

/* hill.stl: of the case before it. */
static int is_surface(const prog_template *t) { return t->name && strchr(t->name, '.') != NULL; }

static const prog_template *find(const char *name)
{
  for (const prog_template *t = sph_prog_templates; t->name; t++)
    if (!strcmp(t->name, name) && !is_surface(t)) return t;
  return NULL;
}

/* "# A column of water ...": the first sentence tells what it is. */
static void list(FILE *to)
{
  for (const prog_template *t = sph_prog_templates; t->name; t++)
    if (!is_surface(t))
      fprintf(to, "  %-14s %.*s\n", t->name, (int)strcspn(t->text + 2, ".\n"), t->text + 2);
}

static int write_file(const char *path, const char *text, int force)
{
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (force ? O_TRUNC : O_EXCL);
  const int at = open(path, flags, 0666);
  if (at < 0 && errno == EEXIST)
    return sph_prog_error(
        PROG_FAILED, "%s is there already; another name goes elsewhere, --force writes over it",
        path);
  FILE *file = at < 0 ? NULL : fdopen(at, "wb");
  int bad = !file || fwrite(text, 1, strlen(text), file) != strlen(text);
  bad = (file && fclose(file)) || bad;
  return bad ? sph_prog_error(PROG_FAILED, "cannot write %s: %s", path, strerror(errno)) : PROG_OK;
}

/* The surfaces of a case, beside the file that it goes to. */
static int write_surfaces(const prog_template *t, const char *name, int force)
{
  char path[4096];
  const char *slash = strrchr(name, '/');
  const int folder = slash ? (int)(slash + 1 - name) : 0;
  int status = PROG_OK;
  for (t++; is_surface(t) && !status; t++) {
    const int n = snprintf(path, sizeof path, "%.*s%s", folder, name, t->name);
    if (n < 0 || (size_t)n >= sizeof path)
      return sph_prog_error(PROG_FAILED, "the name of a folder with %d characters", folder);
    status = write_file(path, t->text, force);
  }
  return status;
}

int sph_prog_new(const prog_options *o)
{
  char path[80];
  const prog_template *t = find(o->what ? o->what : "tank");
  if (!t) {
    sph_prog_error(PROG_USAGE, "new: no template '%s'; known are", o->what);
    list(stderr);
    return PROG_USAGE;
  }
  if (o->output && !strcmp(o->output, "-"))
    return fputs(t->text, stdout) < 0 ? PROG_FAILED : PROG_OK;
  snprintf(path, sizeof path, "%s.yml", t->name);
  const char *name = o->output ? o->output : path;
  int status = write_surfaces(t, name, o->force);
  if (!status) status = write_file(name, t->text, o->force);
  if (status || o->quiet) return status;
  printf("%s is written%s%s; now\n  sphode check %s\n  sphode run %s\nOther templates:\n", name,
         is_surface(t + 1) ? ", beside it " : "", is_surface(t + 1) ? t[1].name : "", name, name);
  list(stdout);
  return PROG_OK;
}

int sph_prog_schema(const prog_options *o)
{
  const int n = sph_case_schema_json(NULL, 0);
  char *text = n > 0 ? malloc((size_t)n + 1) : NULL;
  if (!text) return sph_prog_error(PROG_FAILED, "out of memory");
  sph_case_schema_json(text, (size_t)n + 1);
  int status = PROG_OK;
  if (o->what)
    status = write_file(o->what, text, o->force);
  else
    fputs(text, stdout);
  free(text);
  return status;
}
