#include "process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static const char none = '\177'; /* said by the child: there is no such program */

static void child(const char *directory, const char *const argv[], int out)
{
  const int in = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (in >= 0) dup2(in, STDIN_FILENO);
  if (chdir(directory) != 0 || dup2(out, STDERR_FILENO) < 0) _exit(1);
  dup2(out, STDOUT_FILENO);
  execvp(argv[0], (char *const *)argv);
  if (errno == ENOENT && write(out, &none, 1) < 0) _exit(2);
  _exit(1);
}

/* Until there is something to read, or a signal came. */
static void wait_for(int in, pid_t pid, const sph_process_stop *stop)
{
  struct pollfd poll_in = {.fd = in, .events = POLLIN};
  while (stop && stop->is && poll(&poll_in, 1, 100) <= 0)
    if (stop->is(stop->ctx)) kill(pid, SIGTERM);
}

int sph_process_run(const char *directory, const char *const argv[], char *said, size_t size)
{
  return sph_process_run_until(directory, argv, said, size, NULL);
}

int sph_process_run_until(const char *directory, const char *const argv[], char *said, size_t size,
                          const sph_process_stop *stop)
{
  int pipe_ends[2], status = -1;
  size_t used = 0;
  said[0] = '\0';
  if (pipe(pipe_ends) != 0) return -1;
  for (int k = 0; k < 2; k++) fcntl(pipe_ends[k], F_SETFD, FD_CLOEXEC);
  pid_t pid = fork();
  if (pid == 0) child(directory, argv, pipe_ends[1]);
  close(pipe_ends[1]);
  while (pid > 0) {
    char rest[512];
    size_t room = size - 1 - used;
    wait_for(pipe_ends[0], pid, stop);
    ssize_t got = read(pipe_ends[0], room ? said + used : rest, room ? room : sizeof rest);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    used += room ? (size_t)got : 0;
  }
  said[used] = '\0';
  close(pipe_ends[0]);
  while (pid > 0 && waitpid(pid, &status, 0) < 0)
    if (errno != EINTR) return -1;
  if (said[0] == none) return SPH_PROCESS_MISSING;
  return pid > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
