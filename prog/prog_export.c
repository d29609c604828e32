/* Snapshots as files that other tools read. */
#include <stdio.h>
#include <string.h>

#include "prog.h"

enum { FORMATS = 4 };

/* A directory DIR/csv; beside a file. */
static int directory_of(const char *path, const char *format, char to[4096])
{
  const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
  const int file = dot && dot > slash && (!strcmp(dot, ".hdf") || !strcmp(dot, ".hdf5"));
  const int length = !file ? (int)strlen(path) : slash ? (int)(slash - path) : 0;
  int n = snprintf(to, 4096, "%.*s%s%s", length, path, file && !slash ? "" : "/", format);
  return n < 4096 ? PROG_OK : sph_prog_error(PROG_FAILED, "%.60s...: path too long", path);
}

static int is_listed(const char *list, const char *word)
{
  const size_t n = strlen(word);
  for (const char *at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
    if (strcspn(at, ",") == n && !strncmp(at, word, n)) return 1;
  return 0;
}

/* Which formats are wanted, by --format or by their own options; returns how many; 0: told. */
static int take_formats(const prog_options *o, const char *format[FORMATS])
{
  const char *name;
  int n = 0, words = o->format ? 1 : 0, known = 0;
  for (int k = 0; (name = sph_export_format(k)) && k < FORMATS; k++) {
    const int own = (o->csv && !strcmp(name, "csv")) || (o->vtu && !strcmp(name, "vtu")) ||
                    (o->gadget && !strcmp(name, "gadget")) ||
                    (o->splash && !strcmp(name, "splash"));
    const int listed = is_listed(o->format, name);
    known += listed;
    if (own || listed) format[n++] = name;
  }
  for (const char *at = o->format; at && (at = strchr(at, ',')); at++) words++;
  if (n > 0 && words == known) return n;
  sph_prog_error(PROG_USAGE,
                 "export%s%s wants some of csv, vtu, gadget, splash, with commas between",
                 o->format ? " --format " : ": --format", o->format ? o->format : "");
  return 0;
}

/* Of several formats only the first one tells what is left out. */
static void tell_nothing(void *ctx, const char *why) { (void)ctx, (void)why; }

static int export_one(const prog_options *o, const char *format, int first, int several)
{
  char directory[4096];
  sph_error error = {0};
  int left = 0;
  if (!o->output && directory_of(o->what, format, directory)) return PROG_FAILED;
  if (o->output && snprintf(directory, sizeof directory, several ? "%s/%s" : "%s", o->output,
                            format) >= (int)sizeof directory)
    return sph_prog_error(PROG_FAILED, "%.60s...: path too long", o->output);
  const sph_export_def def = {.path = o->what,
                              .format = format,
                              .directory = directory,
                              .fields = o->fields,
                              .single = o->single,
                              .left_out = first ? sph_prog_left_out(&left)
                                                : (sph_left_out){tell_nothing, NULL}};
  int count = sph_export(&def, &error);
  if (count < 0) return sph_prog_error(PROG_FAILED, "%s", error.text);
  if (!o->quiet) printf("%d snapshot%s to %s\n", count, count == 1 ? "" : "s", def.directory);
  return sph_prog_left_out_end(left, count + left, PROG_OK);
}

int sph_prog_export(const prog_options *o)
{
  const char *format[FORMATS];
  const int n = take_formats(o, format);
  int status = n ? PROG_OK : PROG_USAGE;
  for (int k = 0; k < n && status != PROG_USAGE; k++)
    if (export_one(o, format[k], k == 0, n > 1)) status = PROG_FAILED;
  return status;
}
