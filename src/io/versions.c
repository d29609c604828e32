#include "versions.h"

#include <hdf5.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "sundials.h"

const char *sph_versions_compiler(void)
{
#ifdef __clang__
  return __VERSION__;
#else
  return "gcc " __VERSION__;
#endif
}

const char *sph_versions_sundials(void) { return SUNDIALS_VERSION; }

/* That of the header: H5get_libversion would need the lock that snapshots hold. */
const char *sph_versions_hdf5(char *text, size_t size)
{
  snprintf(text, size, "%d.%d.%d", H5_VERS_MAJOR, H5_VERS_MINOR, H5_VERS_RELEASE);
  return text;
}

/* Linux tells the processor's name in /proc; elsewhere it stays unsaid. */
static void processor(char name[100])
{
  char line[300];
  FILE *file = fopen("/proc/cpuinfo", "r");
  snprintf(name, 100, "processor");
  while (file && fgets(line, sizeof line, file)) {
    const char *colon = strchr(line, ':');
    if (strncmp(line, "model name", 10) != 0 || !colon) continue;
    snprintf(name, 100, "%.*s", (int)strcspn(colon + 2, "\n"), colon + 2);
    break;
  }
  if (file) fclose(file);
}

const char *sph_versions_machine(char *text, size_t size)
{
  struct utsname system;
  char name[100];
  processor(name);
  if (uname(&system) != 0) memset(&system, 0, sizeof system);
  snprintf(text, size, "%s %s, %ld x %s", system.sysname, system.machine,
           sysconf(_SC_NPROCESSORS_ONLN), name);
  return text;
}
