/* folder.h -- a folder of its own for the files of a test, below TMPDIR, and an end of it. */
#ifndef TESTS_FOLDER_H
#define TESTS_FOLDER_H
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { FOLDER_MAX = 160 };

/* Writes its path to path[FOLDER_MAX]; 0: done. */
static inline int folder_make(char *path, const char *name)
{
  const char *temporary = getenv("TMPDIR");
  snprintf(path, FOLDER_MAX, "%s/sphode-%s-XXXXXX", temporary ? temporary : "/tmp", name);
  return mkdtemp(path) ? 0 : -1;
}

/* The folder and the files in it; 0: done. */
static inline int folder_remove(const char *path)
{
  char file[FOLDER_MAX + 256];
  DIR *entries = opendir(path);
  for (struct dirent *e; entries && (e = readdir(entries));) {
    snprintf(file, sizeof file, "%s/%s", path, e->d_name);
    if (strcmp(e->d_name, ".") && strcmp(e->d_name, "..")) unlink(file);
  }
  if (entries) closedir(entries);
  return rmdir(path);
}

#endif
