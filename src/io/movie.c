/* movie.c -- frames drawn by gnuplot, one after the other, then a movie of them by ffmpeg. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "file.h"
#include "frames.h"
#include "memory.h"
#include "picture.h"
#include "process.h"
#include "sphode/output.h"

enum { WIDTH = 1200, PIXELS_MIN = 64, PIXELS_MAX = 16384 };
static const double rate_default = 25, rate_most = 1000;

typedef struct movie {
  const sph_movie_def *def;
  const char *field, *base; /* the name of the file in its directory */
  int mp4;
  char folder[SPH_PATH]; /* of the frames, beside the movie */
  long *number;
  int frames;
  sph_picture picture;
  sph_error *error;
} movie;

/* ---- frames ---- */

static int stopped(const movie *m)
{
  if (!m->def->stop || !m->def->stop(m->def->stop_ctx)) return SPH_OK;
  return sph_error_set(m->error, SPH_ERR_STOPPED, "the movie was stopped on request");
}

static int visit_all(movie *m, int (*visit)(movie *m, const sph_snapshot *frame, int k))
{
  char path[SPH_PATH];
  int status = SPH_OK, kept = 0;
  for (int k = 0; k < m->frames && !status; k++) {
    sph_snapshot frame;
    sph_error why = {0};
    status = stopped(m);
    if (!status) status = sph_frames_path(path, m->def->directory, m->number[k], m->error);
    if (status) break;
    if (sph_snapshot_read(path, m->field, &frame, &why)) {
      status = sph_frames_leave(&m->def->left_out, &why, m->error);
      continue;
    }
    m->number[kept] = m->number[k];
    status = visit(m, &frame, kept++);
    sph_snapshot_read_free(&frame);
  }
  if (!status && kept == 0)
    return sph_error_set(m->error, SPH_ERR_FILE, "%s: none of its snapshots can be read",
                         m->def->directory);
  if (!status) m->frames = kept; /* of what was drawn before a failure, all is removed */
  return status;
}

/* That of the first snapshot that can be read, where none is named. */
static const char *choose_field(movie *m)
{
  char path[SPH_PATH];
  double time;
  for (int k = 0; k < m->frames; k++)
    if (!sph_frames_path(path, m->def->directory, m->number[k], NULL) &&
        !sph_snapshot_read_time(path, &time, NULL))
      return sph_snapshot_read_default(path);
  return "velocity";
}

static int bound(movie *m, const sph_snapshot *frame, int k)
{
  sph_picture *p = &m->picture;
  (void)k;
  if (p->dim && p->dim != frame->dim)
    return sph_error_set(m->error, SPH_ERR_FILE, "snapshots of %dD and %dD in one movie", p->dim,
                         frame->dim);
  sph_picture_bound(p, frame);
  /* Four digits of the last time, so that no digit comes and goes. */
  const double digits = frame->time > 0 ? 3 - floor(log10(frame->time)) : 1;
  p->decimals = (int)fmin(fmax(digits, 1), 12);
  return SPH_OK;
}

static int take(movie *m, const sph_snapshot *frame, int k)
{
  (void)k;
  return sph_picture_take(&m->picture, frame, m->error);
}

static int name_frame(const movie *m, int k, const char *ending, char path[SPH_PATH])
{
  char name[40];
  snprintf(name, sizeof name, "frame_%05d.%s", k, ending);
  return sph_file_path(path, m->folder, name, m->error);
}

static int draw(movie *m, const sph_snapshot *frame, int k)
{
  char path[SPH_PATH];
  int status = name_frame(m, k, "png", path);
  return status ? status : sph_picture_draw(&m->picture, frame, 1, path, m->error);
}

static void remove_frames(const movie *m)
{
  static const char *const endings[] = {"png", "gp", "dat"};
  char path[SPH_PATH];
  for (int k = 0; k < m->frames; k++)
    for (int e = 0; e < 3; e++)
      if (!name_frame(m, k, endings[e], path)) unlink(path);
  rmdir(m->folder);
}

/* ---- ffmpeg ---- */

static int run_ffmpeg(const movie *m, const char *directory, const char *const argv[])
{
  char said[600];
  const sph_process_stop stop = {m->def->stop, m->def->stop_ctx};
  int code = sph_process_run_until(directory, argv, said, sizeof said, &stop);
  if (code == 0 || stopped(m)) return stopped(m);
  if (code == SPH_PROCESS_MISSING)
    return sph_error_set(m->error, SPH_ERR_UNBUILT,
                         "no ffmpeg found, which makes movies of frames: install ffmpeg (Debian, "
                         "Ubuntu, Homebrew) or ffmpeg-free (Fedora)");
  return sph_error_set(m->error, SPH_ERR_FILE, "ffmpeg could not make %.300s: %s", m->def->path,
                       said);
}

/* mp4: even numbers of pixels, and the colours that every player takes. */
static int encode(const movie *m)
{
  char rate[40], pad[120], to[SPH_PATH], made[SPH_PATH + 8];
  const sph_movie_def *def = m->def;
  snprintf(rate, sizeof rate, "%.6g", def->rate > 0 ? def->rate : rate_default);
  if (def->width)
    snprintf(pad, sizeof pad, "pad=%d:%d:(ow-iw)/2:(oh-ih)/2:white", def->width, def->height);
  else
    snprintf(pad, sizeof pad, "pad=ceil(iw/2)*2:ceil(ih/2)*2:0:0:white");
  if (snprintf(to, sizeof to, "file:../%s.tmp", m->base) >= (int)sizeof to)
    return sph_error_set(m->error, SPH_ERR_ARGUMENT, "movie: its name is too long");
  const char *const argv[] = {"ffmpeg",
                              "-nostdin",
                              "-v",
                              "error",
                              "-y",
                              "-framerate",
                              rate,
                              "-i",
                              "frame_%05d.png",
                              "-vf",
                              pad,
                              "-pix_fmt",
                              m->mp4 ? "yuv420p" : "rgb24",
                              m->mp4 ? "-movflags" : "-plays",
                              m->mp4 ? "+faststart" : "0",
                              "-f",
                              m->mp4 ? "mp4" : "apng",
                              to,
                              NULL};
  int status = run_ffmpeg(m, m->folder, argv);
  snprintf(made, sizeof made, "%s.tmp", def->path);
  if (!status && rename(made, def->path) != 0)
    status =
        sph_error_set(m->error, SPH_ERR_FILE, "cannot write %s: %s", def->path, strerror(errno));
  if (status) unlink(made);
  return status;
}

/* ---- all of it ---- */

static int check(movie *m)
{
  const sph_movie_def *def = m->def;
  const char *slash = strrchr(def->path, '/'), *dot;
  m->base = slash ? slash + 1 : def->path;
  dot = strrchr(m->base, '.');
  m->mp4 = dot && !strcmp(dot, ".mp4");
  if (!dot || dot == m->base || (!m->mp4 && strcmp(dot, ".png") != 0 && strcmp(dot, ".apng") != 0))
    return sph_error_set(m->error, SPH_ERR_ARGUMENT,
                         "movie \"%.200s\": a name like x.mp4, x.png or x.apng is right",
                         def->path);
  if (!(def->rate >= 0 && def->rate <= rate_most))
    return sph_error_set(m->error, SPH_ERR_ARGUMENT,
                         "movie: %g frames a second; right is above 0, at most %g", def->rate,
                         rate_most);
  const int least = def->width < def->height ? def->width : def->height;
  const int most = def->width > def->height ? def->width : def->height;
  if ((most || least) && (least < PIXELS_MIN || most > PIXELS_MAX))
    return sph_error_set(m->error, SPH_ERR_ARGUMENT,
                         "movie: %d x %d pixels; %d to %d each are right", def->width, def->height,
                         PIXELS_MIN, PIXELS_MAX);
  if (m->mp4 && (def->width % 2 || def->height % 2))
    return sph_error_set(m->error, SPH_ERR_ARGUMENT,
                         "movie: %d x %d pixels; an mp4 wants even numbers", def->width,
                         def->height);
  if (snprintf(m->folder, sizeof m->folder, "%s.frames", def->path) >= (int)sizeof m->folder)
    return sph_error_set(m->error, SPH_ERR_ARGUMENT, "movie: its path is too long");
  return SPH_OK;
}

static int draw_all(movie *m)
{
  int status = SPH_OK;
  sph_picture_view(&m->picture);
  if (m->def->from == m->def->to) {
    status = visit_all(m, take);
    sph_picture_range(&m->picture);
  }
  return status ? status : visit_all(m, draw);
}

static int make(movie *m)
{
  const sph_movie_def *def = m->def;
  m->frames = sph_frames_list(def->directory, &m->number, m->error);
  if (m->frames < 0) return m->frames;
  if (m->frames == 0)
    return sph_error_set(m->error, SPH_ERR_FILE, "%s holds no snapshots", def->directory);
  int status = run_ffmpeg(m, ".", (const char *const[]){"ffmpeg", "-version", NULL});
  if (!status)
    status = sph_frames_missing(def->directory, m->number, m->frames, &def->left_out, m->error);
  if (!m->field) m->field = choose_field(m);
  m->picture = (sph_picture){.field = m->field,
                             .width = def->width ? def->width : WIDTH,
                             .height = def->width ? def->height : WIDTH,
                             .from = def->from,
                             .to = def->to};
  /* A picture has bounds, and a view, once all frames could be read. */
  if (!status) status = visit_all(m, bound);
  if (!status) status = draw_all(m);
  if (!status) status = encode(m);
  remove_frames(m);
  return status;
}

int sph_movie_write(const sph_movie_def *def, sph_error *error)
{
  if (!def || !def->directory || !def->path)
    return sph_error_set(error, SPH_ERR_ARGUMENT, "a movie of no %s (NULL)",
                         !def              ? "definition"
                         : !def->directory ? "directory"
                                           : "path");
  movie m = {.def = def, .field = def->field, .error = error};
  sph_error own = {0};
  if (!error) m.error = &own;
  int status = check(&m);
  if (!status) status = make(&m);
  if (status && def->stop && def->stop(def->stop_ctx)) { /* Ctrl-C ends gnuplot, too */
    *m.error = (sph_error){0};
    status = stopped(&m);
  }
  sph_memory_free(m.number);
  return status ? status : m.frames;
}
