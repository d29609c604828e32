/* sphode run --live: a page on 127.0.0.1, behind an address that nobody can guess. */
#include "prog_live.h"
#include "config.h"
#include "prog.h"

#ifdef SPH_HAVE_MICROHTTPD
#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "prog_live_page.h" /* live_page, of prog_live.html */

enum { LIVE_CONNECTIONS = 8, LIVE_TOKEN = 32, LIVE_FIELD = 64 };
static const double live_interval = 0.04; /* between frames [s] */

/* The run's thread fills `frame` where one is wanted; the server's hands out copies. */
struct prog_live {
  struct MHD_Daemon *daemon;
  pthread_mutex_t lock; /* of all below */
  pthread_cond_t told;  /* something was asked for */
  int paused, stopped, wanted, failed;
  char field[LIVE_FIELD];
  prog_live_frame frame;
  double filled;             /* wall time [s] */
  prog_live_history history; /* the run's alone */
  char token[LIVE_TOKEN + 1];
  char series[4096]; /* the table of the run */
};

static enum MHD_Result answer(struct MHD_Connection *connection, unsigned status, const char *type,
                              size_t size, const void *bytes, enum MHD_ResponseMemoryMode mode)
{
  struct MHD_Response *response = MHD_create_response_from_buffer(size, (void *)bytes, mode);
  if (!response) return MHD_NO;
  MHD_add_response_header(response, "Content-Type", type);
  MHD_add_response_header(response, "Cache-Control", "no-store");
  MHD_add_response_header(response, "X-Content-Type-Options", "nosniff");
  MHD_add_response_header(response, "Referrer-Policy", "no-referrer");
  MHD_add_response_header(response, "Content-Security-Policy",
                          "default-src 'none'; script-src 'unsafe-inline'; style-src "
                          "'unsafe-inline'; connect-src 'self'");
  enum MHD_Result result = MHD_queue_response(connection, status, response);
  MHD_destroy_response(response);
  return result;
}

static enum MHD_Result refuse(struct MHD_Connection *connection, unsigned status, const char *why)
{
  return answer(connection, status, "text/plain", strlen(why), why, MHD_RESPMEM_PERSISTENT);
}

/* Names of fields are words; what else comes is no field. */
static int is_word(const char *text)
{
  const char *letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.-";
  const size_t n = strlen(text);
  return n > 0 && n < LIVE_FIELD && strspn(text, letters) == n;
}

static enum MHD_Result send_frame(prog_live *live, struct MHD_Connection *connection)
{
  const char *field = MHD_lookup_connection_value(connection, MHD_GET_ARGUMENT_KIND, "field");
  pthread_mutex_lock(&live->lock);
  if (field && is_word(field)) snprintf(live->field, sizeof live->field, "%s", field);
  live->wanted = 1;
  pthread_cond_signal(&live->told);
  const size_t size = live->frame.size;
  enum MHD_Result result = size
                               ? answer(connection, MHD_HTTP_OK, "application/octet-stream", size,
                                        live->frame.bytes, MHD_RESPMEM_MUST_COPY)
                               : refuse(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "no frame yet\n");
  pthread_mutex_unlock(&live->lock);
  return result;
}

static enum MHD_Result send_series(const prog_live *live, struct MHD_Connection *connection)
{
  size_t size = 0;
  char *text = sph_prog_live_series_read(live->series, &size);
  if (!text) return refuse(connection, MHD_HTTP_NOT_FOUND, "no series\n");
  return answer(connection, MHD_HTTP_OK, "text/csv; charset=utf-8", size, text,
                MHD_RESPMEM_MUST_FREE);
}

static enum MHD_Result command(prog_live *live, struct MHD_Connection *connection, const char *what)
{
  int known = 1;
  pthread_mutex_lock(&live->lock);
  if (!strcmp(what, "pause"))
    live->paused = 1;
  else if (!strcmp(what, "resume"))
    live->paused = 0;
  else if (!strcmp(what, "stop"))
    live->stopped = 1;
  else
    known = 0;
  pthread_cond_signal(&live->told);
  pthread_mutex_unlock(&live->lock);
  return known ? refuse(connection, MHD_HTTP_OK, "done\n")
               : refuse(connection, MHD_HTTP_NOT_FOUND, "pause, resume or stop\n");
}

static enum MHD_Result serve(void *ctx, struct MHD_Connection *connection, const char *url,
                             const char *method, const char *version, const char *upload,
                             size_t *upload_size, void **request)
{
  prog_live *live = ctx;
  static int seen;
  (void)version, (void)upload;
  if (!*request) { /* the head of a request; what comes with it is not read */
    *request = &seen;
    return MHD_YES;
  }
  if (*upload_size) {
    *upload_size = 0;
    return MHD_YES;
  }
  const size_t n = strlen(live->token);
  if (url[0] != '/' || strncmp(url + 1, live->token, n) || url[n + 1] != '/')
    return refuse(connection, MHD_HTTP_NOT_FOUND, "not here\n");
  const char *what = url + n + 2;
  if (!strcmp(method, "POST")) return command(live, connection, what);
  if (strcmp(method, "GET"))
    return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "GET or POST\n");
  if (!strcmp(what, "frame")) return send_frame(live, connection);
  if (!strcmp(what, "series")) return send_series(live, connection);
  if (*what) return refuse(connection, MHD_HTTP_NOT_FOUND, "not here\n");
  return answer(connection, MHD_HTTP_OK, "text/html; charset=utf-8", strlen(live_page), live_page,
                MHD_RESPMEM_PERSISTENT);
}

static int make_token(char *token)
{
  unsigned char bytes[LIVE_TOKEN / 2];
  int file = open("/dev/urandom", O_RDONLY | O_CLOEXEC);
  const int good = file >= 0 && read(file, bytes, sizeof bytes) == (ssize_t)sizeof bytes;
  if (file >= 0) close(file);
  for (size_t k = 0; good && k < sizeof bytes; k++) snprintf(token + 2 * k, 3, "%02x", bytes[k]);
  return good;
}

static struct MHD_Daemon *listen_on(prog_live *live, int port)
{
  struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)port)};
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return MHD_start_daemon(MHD_USE_INTERNAL_POLLING_THREAD, (uint16_t)port, NULL, NULL, serve, live,
                          MHD_OPTION_SOCK_ADDR, &address, MHD_OPTION_CONNECTION_LIMIT,
                          (unsigned)LIVE_CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT, 20u,
                          MHD_OPTION_END);
}

prog_live *sph_prog_live_start(int port, const char *directory)
{
  prog_live *live = calloc(1, sizeof *live);
  if (!live) {
    sph_prog_error(PROG_FAILED, "--live: out of memory");
    return NULL;
  }
  snprintf(live->field, sizeof live->field, "velocity");
  snprintf(live->series, sizeof live->series, "%s/series.csv", directory);
  pthread_mutex_init(&live->lock, NULL);
  pthread_cond_init(&live->told, NULL);
  if (make_token(live->token)) live->daemon = listen_on(live, port);
  if (!live->daemon) {
    sph_prog_error(PROG_FAILED, "--live: cannot listen on 127.0.0.1, port %d: %s", port,
                   strerror(errno));
    sph_prog_live_end(live);
    return NULL;
  }
  const union MHD_DaemonInfo *info = MHD_get_daemon_info(live->daemon, MHD_DAEMON_INFO_BIND_PORT);
  fprintf(stderr, "live         http://127.0.0.1:%d/%s/\n", info ? info->port : port, live->token);
  return live;
}

static void fill(prog_live *live, sph_sim *sim, double end)
{
  live->failed =
      sph_prog_live_frame_fill(&live->frame, sim, live->field, end, live->paused, &live->history);
  if (live->failed) live->frame.size = 0;
  live->wanted = 0;
  live->filled = sph_prog_progress_now();
}

int sph_prog_live_step(prog_live *live, sph_sim *sim, double end, int (*is_stopped)(void *ctx),
                       void *ctx)
{
  sph_prog_live_frame_note(&live->history, sim);
  pthread_mutex_lock(&live->lock);
  const double now = sph_prog_progress_now();
  if (!live->frame.size || (live->wanted && now - live->filled >= live_interval))
    fill(live, sim, end);
  while (live->paused && !live->stopped && !is_stopped(ctx)) {
    fill(live, sim, end);
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    until.tv_nsec += 100000000; /* a signal may have come */
    if (until.tv_nsec >= 1000000000) until.tv_sec++, until.tv_nsec -= 1000000000;
    pthread_cond_timedwait(&live->told, &live->lock, &until);
  }
  const int stopped = live->stopped;
  pthread_mutex_unlock(&live->lock);
  return stopped;
}

void sph_prog_live_end(prog_live *live)
{
  if (!live) return;
  if (live->daemon) MHD_stop_daemon(live->daemon);
  pthread_cond_destroy(&live->told);
  pthread_mutex_destroy(&live->lock);
  free(live->frame.bytes);
  free(live);
}

#else

prog_live *sph_prog_live_start(int port, const char *directory)
{
  (void)port, (void)directory;
  sph_prog_error(PROG_FAILED, "--live: this sphode was built without libmicrohttpd; install it "
                              "(Debian: libmicrohttpd-dev), then configure and make again");
  return NULL;
}
int sph_prog_live_step(prog_live *live, sph_sim *sim, double end, int (*is_stopped)(void *ctx),
                       void *ctx)
{
  (void)live, (void)sim, (void)end, (void)is_stopped, (void)ctx;
  return 0;
}
void sph_prog_live_end(prog_live *live) { (void)live; }
#endif
