/* Movies. */
#include <stdio.h>
#include <stdlib.h>

#include "prog.h"

/* A word of the command line that is two numbers with a letter between them. */
static int two(const char *text, char between, double value[2])
{
  char *end;
  value[0] = strtod(text, &end);
  if (end == text || *end != between) return 0;
  const char *second = end + 1;
  value[1] = strtod(second, &end);
  return end != second && !*end;
}

static void tell(void *count, const char *why)
{
  ++*(int *)count;
  sph_prog_error(PROG_FAILED, "left out: %s", why);
}

sph_left_out sph_prog_left_out(int *count) { return (sph_left_out){tell, count}; }

int sph_prog_left_out_end(int count, int all, int status)
{
  if (!count) return status;
  return sph_prog_error(PROG_FAILED, "%d of %d snapshots %s left out", count, all,
                        count == 1 ? "was" : "were");
}

static int is_stopped(void *ctx)
{
  (void)ctx;
  return sph_prog_progress_signal() != 0;
}

static int take_options(const prog_options *o, sph_movie_def *def)
{
  double range[2] = {0}, size[2] = {0};
  if (o->range && (!two(o->range, ':', range) || !(range[0] < range[1])))
    return sph_prog_error(PROG_USAGE, "--range %s: wanted FROM:TO in SI units, as 0:2000",
                          o->range);
  if (o->size && (!two(o->size, 'x', size) || !(size[0] >= 1 && size[1] >= 1) ||
                  !(size[0] < 1e5 && size[1] < 1e5)))
    return sph_prog_error(PROG_USAGE, "--size %s: wanted WIDTHxHEIGHT in pixels, as 1280x720",
                          o->size);
  def->from = range[0], def->to = range[1];
  def->width = (int)size[0], def->height = (int)size[1];
  def->rate = o->rate;
  return PROG_OK;
}

int sph_prog_movie(const prog_options *o)
{
  char path[4096];
  sph_error error = {0};
  sph_movie_def def = {.directory = o->what, .path = o->output ? o->output : path};
  int status = take_options(o, &def), left = 0;
  if (status) return status;
  snprintf(path, sizeof path, "%s/movie.mp4", o->what);
  sph_case *c = sph_prog_plot_of(o->what);
  def.field = o->field ? o->field : c ? sph_case_plot_field(c) : NULL;
  def.left_out = sph_prog_left_out(&left);
  def.stop = is_stopped;
  sph_prog_progress_catch(1);
  int frames = sph_movie_write(&def, &error);
  sph_case_free(c);
  if (frames == SPH_ERR_STOPPED)
    return sph_prog_error(128 + sph_prog_progress_signal(), "stopped; no movie was written");
  if (frames < 0) return sph_prog_error(PROG_FAILED, "no movie: %s", error.text);
  if (!o->quiet) printf("movie        %s (%d frames)\n", def.path, frames);
  return sph_prog_left_out_end(left, frames + left, PROG_OK);
}
