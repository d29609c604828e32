/* prog_live.h -- a run, seen in a browser while it goes. */
#ifndef SPH_PROG_LIVE_H
#define SPH_PROG_LIVE_H
#include <sphode.h>
#include <stddef.h>

/* ---- what the page gets (prog_live_frame.c): a line of JSON, filled up with spaces to a multiple
 * of 4 bytes, then floats, dim coordinates and the value for each particle: fluids, then walls
 * (value NaN).  At most about 20 000 fluid particles, every k-th of them, and as many walls. */

enum { LIVE_PARTICLES = 20000, LIVE_HISTORY = 400 };

typedef struct prog_live_history { /* the whole run; where it is full every second row goes */
  int n, every, skipped;
  double last, pairs;          /* at the last row: wall time [s], pairs so far */
  double row[LIVE_HISTORY][3]; /* t, dt, million pairs a second */
} prog_live_history;

typedef struct prog_live_frame {
  char *bytes;
  size_t size, capacity;
} prog_live_frame;

/* After a step: may add a row to the history. */
void sph_prog_live_frame_note(prog_live_history *history, sph_sim *sim);
/* Fills the frame; field: a name, "velocity" where it is none; 0, or -1 without memory. */
int sph_prog_live_frame_fill(prog_live_frame *frame, sph_sim *sim, const char *field, double end,
                             int paused, const prog_live_history *history);

/* The head and some 400 whole rows of a table, evenly from the first to the last (malloc), of any
 * length that it has grown to; NULL: there is none, or no memory. */
char *sph_prog_live_series_read(const char *path, size_t *size);

/* ---- the server (prog_live.c) */

typedef struct prog_live prog_live;

/* Serves http://127.0.0.1:PORT/TOKEN/, port 0: a free one, and tells the address; NULL, told: it
 * cannot, or there is no libmicrohttpd in this build.  directory: of the run, whose series.csv the
 * page draws columns of. */
prog_live *sph_prog_live_start(int port, const char *directory);
/* After a step, in the thread of the run to time `end`: shows it where somebody looks, and waits
 * while the run is paused; 1: the page wants it stopped.  is_stopped ends the waiting. */
int sph_prog_live_step(prog_live *live, sph_sim *sim, double end, int (*is_stopped)(void *ctx),
                       void *ctx);
void sph_prog_live_end(prog_live *live); /* NULL is fine */

#endif
