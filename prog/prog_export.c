/* Snapshots as files that other tools read. */
#include <stdio.h>
#include <string.h>

#include "prog.h"

/* A directory DIR/csv; beside a file. */
static int directory_of(const char *path, const char *format, char to[4096])
{
  const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
  const int file = dot && dot > slash && (!strcmp(dot, ".hdf") || !strcmp(dot, ".hdf5"));
  const int length = !file ? (int)strlen(path) : slash ? (int)(slash - path) : 0;
  int n = snprintf(to, 4096, "%.*s%s%s", length, path, file && !slash ? "" : "/", format);
  return n < 4096 ? PROG_OK : sph_prog_error(PROG_FAILED, "%.60s...: path too long", path);
}

int sph_prog_export(const prog_options *o)
{
  char directory[4096];
  sph_error error = {0};
  if (o->csv + o->vtu + o->gadget + o->splash != 1)
    return sph_prog_error(PROG_USAGE, "export wants one of --csv, --vtu, --gadget, --splash");
  const char *format = o->csv ? "csv" : o->vtu ? "vtu" : o->gadget ? "gadget" : "splash";
  if (!o->output && directory_of(o->what, format, directory)) return PROG_FAILED;
  const sph_export_def def = {.path = o->what,
                              .format = format,
                              .directory = o->output ? o->output : directory,
                              .fields = o->fields,
                              .single = o->single};
  int count = sph_export(&def, &error);
  if (count < 0) return sph_prog_error(PROG_FAILED, "%s", error.text);
  if (!o->quiet) printf("%d snapshot%s to %s\n", count, count == 1 ? "" : "s", def.directory);
  return PROG_OK;
}
