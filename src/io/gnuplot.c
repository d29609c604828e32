#include "gnuplot.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "file.h"
#include "process.h"

int sph_gnuplot_names(sph_gnuplot *names, const char *png, sph_error *error)
{
  const char *slash = png ? strrchr(png, '/') : NULL, *base = slash ? slash + 1 : png;
  size_t length = base ? strlen(base) : 0;
  if (length < 5 || length > 200 || strcmp(base + length - 4, ".png") != 0)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "picture \"%.200s\": a name like x.png is right",
                         png ? png : "");
  for (const char *c = base; *c; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f)
      return sph_error_set(error, SPH_ERR_ARGUMENT, "picture: a control character (%d) in its name",
                           *c);
  int before = slash ? (int)(slash - png) : 0;
  int written = snprintf(names->directory, sizeof names->directory, "%.*s%s", before, png,
                         !slash        ? "."
                         : before == 0 ? "/"
                                       : "");
  if (written >= (int)sizeof names->directory)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "picture: a path of %d bytes is too long",
                         before);
  int stem = (int)length - 4;
  snprintf(names->png, sizeof names->png, "./%s", base);
  snprintf(names->script, sizeof names->script, "./%.*s.gp", stem, base);
  snprintf(names->data, sizeof names->data, "./%.*s.dat", stem, base);
  return SPH_OK;
}

void sph_gnuplot_begin(const sph_gnuplot *names, sph_text *script, int width, int height)
{
  sph_text_add(script, "# gnuplot %s makes %s\n", names->script + 2, names->png + 2);
  sph_text_add(script, "set terminal pngcairo size %d, %d font 'Sans,11' background '#ffffff'\n",
               width, height);
  sph_text_add(script, "set output ");
  sph_text_gnuplot_string(script, names->png);
  sph_text_add(script, "\ndata = ");
  sph_text_gnuplot_string(script, names->data);
  sph_text_add(script, "\n"
                       "set encoding utf8\n"
                       "set border 31 lc rgb '#666666'\n"
                       "set tics nomirror out scale 0.6 textcolor rgb '#333333'\n\n");
}

/* gnuplot does not tell that a disk was full: the end of a picture is there, or it is not one. */
static int is_whole(const char *path)
{
  static const unsigned char end[] = {'I', 'E', 'N', 'D', 0xae, 0x42, 0x60, 0x82};
  unsigned char last[sizeof end] = {0};
  FILE *file = fopen(path, "rb");
  const int whole = file && fseek(file, -(long)sizeof end, SEEK_END) == 0 &&
                    fread(last, 1, sizeof end, file) == sizeof end &&
                    !memcmp(last, end, sizeof end);
  if (file) fclose(file);
  return whole;
}

/* The picture that was there comes back where there is no new one. */
static int draw(const sph_gnuplot *names, sph_error *error)
{
  char said[600], path[SPH_PATH], old[SPH_PATH + 8];
  int status = sph_file_path(path, names->directory, names->png + 2, error);
  if (status != SPH_OK) return status;
  snprintf(old, sizeof old, "%s.old", path);
  const int kept = rename(path, old) == 0;
  const char *const argv[] = {"gnuplot", "-d", names->script,
                              NULL}; /* -d: not the user's settings */
  int code = sph_process_run(names->directory, argv, said, sizeof said);
  const int whole = code == 0 && is_whole(path);
  if (!whole) unlink(path);
  if (kept && whole) unlink(old);
  if (kept && !whole && rename(old, path) != 0)
    return sph_error_set(error, SPH_ERR_FILE, "cannot rename %s: %s", old, strerror(errno));
  if (whole) return SPH_OK;
  if (code == SPH_PROCESS_MISSING)
    return sph_error_set(error, SPH_ERR_UNBUILT,
                         "no gnuplot found: install gnuplot-nox (Debian, Ubuntu) or gnuplot "
                         "(Fedora, Homebrew), then run: gnuplot %s in %.300s",
                         names->script + 2, names->directory);
  return sph_error_set(error, SPH_ERR_FILE, "gnuplot could not draw %.300s: %s", path,
                       said[0] ? said : "it was cut short; is there space left?");
}

int sph_gnuplot_run(const sph_gnuplot *names, sph_text *script, sph_text *data, sph_error *error)
{
  char path[SPH_PATH];
  sph_text *text[] = {data, script};
  const char *name[] = {names->data, names->script};
  int status = sph_file_make_directory(names->directory, error);
  for (int k = 0; k < 2; k++) {
    if (status == SPH_OK)
      status = sph_error_set(error, text[k]->error.status, "%s", text[k]->error.text);
    if (status == SPH_OK) status = sph_file_path(path, names->directory, name[k] + 2, error);
    if (status == SPH_OK) status = sph_file_replace(path, text[k]->data, text[k]->length, error);
    sph_text_free(text[k]);
  }
  return status == SPH_OK ? draw(names, error) : status;
}
