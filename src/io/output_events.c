/* directory/events.csv: a row for each moment of an event. */
#include <math.h>

#include "memory.h"
#include "rows.h"
#include "sphode/event.h"
#include "sphode/output.h"
#include "sphode/sim.h"

typedef struct context {
  sph_error error; /* of the constructor; told by open */
  char *directory;
  sph_rows rows;
} context;

static const char header[] = "time [s],step,event,value\n";

static int open_events(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  sph_text row = {0};
  (void)sim;
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: an output of events");
  int status = sph_error_set(error, c->error.status, "%s", c->error.text);
  if (status == SPH_OK) status = sph_rows_open(&c->rows, c->directory, "events.csv", error);
  if (status != SPH_OK) return status;
  sph_text_add(&row, "%s", header);
  return sph_rows_append(&c->rows, &row, error);
}

static int frame_events(void *ctx, sph_sim *sim, sph_error *error)
{
  (void)ctx, (void)sim, (void)error; /* events have their own times */
  return SPH_OK;
}

static int add_event(void *ctx, sph_sim *sim, const sph_event_record *record, sph_error *error)
{
  context *c = ctx;
  sph_text row = {0};
  (void)sim;
  sph_text_add(&row, "%.17g,%ld,%s,%.17g\n", record->t, record->step, record->name, record->value);
  return sph_rows_append(&c->rows, &row, error);
}

static int keep_events(void *ctx, sph_sim *sim, sph_keep *keep, sph_error *error)
{
  context *c = ctx;
  (void)sim;
  if (!c) return sph_error_set(error, SPH_ERR_MEMORY, "out of memory: an output of events");
  int status = sph_error_set(error, c->error.status, "%s", c->error.text);
  return status ? status : sph_rows_keep(&c->rows, c->directory, "events.csv", header, keep);
}

static int close_events(void *ctx, sph_sim *sim, sph_error *error)
{
  context *c = ctx;
  (void)sim;
  return c ? sph_rows_close(&c->rows, error) : SPH_OK;
}

static void free_events(void *ctx)
{
  context *c = ctx;
  sph_error none = {0};
  if (!c) return;
  sph_rows_close(&c->rows, &none);
  sph_memory_free(c->directory);
  sph_memory_free(c);
}

sph_output sph_output_events(const char *directory)
{
  context *c = sph_memory_take(1, sizeof *c);
  if (c) {
    c->rows.fd = -1;
    c->directory = directory ? sph_memory_string(directory, &c->error) : NULL;
  }
  return (sph_output){.name = "events",
                      .interval = INFINITY,
                      .open = open_events,
                      .frame = frame_events,
                      .event = add_event,
                      .close = close_events,
                      .keep = keep_events,
                      .ctx = c,
                      .free = free_events};
}
