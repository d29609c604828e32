/* sphode/base.h -- status codes, the error that sticks, version.
 *
 * The library never prints, exits or aborts: every failure is a status and a text. */
#ifndef SPHODE_BASE_H
#define SPHODE_BASE_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SPH_API __attribute__((visibility("default")))
#define SPH_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define SPH_API
#define SPH_PRINTF(text, first)
#endif

/* Every status: name, value, text.  0 done, > 0 try again with a smaller step, < 0 failed. */
#define SPH_STATUS_LIST(X)                                         \
  X(SPH_OK, 0, "done")                                             \
  X(SPH_RETRY, 1, "not admissible: try again with a smaller step") \
  X(SPH_ERR_ARGUMENT, -1, "bad argument")                          \
  X(SPH_ERR_MEMORY, -2, "out of memory")                           \
  X(SPH_ERR_STATE, -3, "called in the wrong order")                \
  X(SPH_ERR_UNBUILT, -4, "not built into this library")            \
  X(SPH_ERR_FILE, -5, "file error")                                \
  X(SPH_ERR_PARSE, -6, "error in an input file")                   \
  X(SPH_ERR_STEP, -7, "the time step failed")                      \
  X(SPH_ERR_STOPPED, -8, "stopped on request")

enum sph_status {
#define SPH_STATUS_ENUM(name, value, text) name = value,
  SPH_STATUS_LIST(SPH_STATUS_ENUM)
#undef SPH_STATUS_ENUM
};

/* The text of a status; for an unknown one "unknown status".  Never NULL, never to be freed. */
SPH_API const char *sph_status_text(int status);

/* An error: the first one sticks.  All zero is "no error"; owned by whoever declares it. */
typedef struct sph_error {
  int status;      /* SPH_OK or the first failure */
  char text[1000]; /* what was wrong, with which value, what would be right; "" without a failure */
} sph_error;

/* Records a failure unless one is recorded already; returns the status that is recorded.
 * error == NULL is allowed: then only status is returned. */
SPH_API int sph_error_set(sph_error *error, int status, const char *format, ...) SPH_PRINTF(3, 4);

/* What is told of each file that cannot be read and is left out: its name and the reason.  tell
 * NULL: nothing is left out, the first such file is an error. */
typedef struct sph_left_out {
  void (*tell)(void *ctx, const char *why);
  void *ctx;
} sph_left_out;

/* "0.8.0" */
SPH_API const char *sph_version(void);

#ifdef __cplusplus
}
#endif
#endif
