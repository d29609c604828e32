/* frames.h -- the snapshots of a directory, in order. */
#ifndef SPH_FRAMES_H
#define SPH_FRAMES_H
#include "sphode/base.h"

/* Their numbers in rising order, *number[count] (sph_memory_free); returns count, < 0: a status. */
int sph_frames_list(const char *directory, long **number, sph_error *error);
/* 12 of ".../snapshot_0012.hdf"; -1: another name. */
long sph_frames_number(const char *path);
/* path = directory/snapshot_0012.hdf */
int sph_frames_path(char path[4096], const char *directory, long number, sph_error *error);

/* A snapshot could not be read, `why`: tells it and goes on (SPH_OK), or returns the failure.  What
 * is wrong with a file is left out, what is wrong with the question or memory is not. */
int sph_frames_leave(const sph_left_out *left_out, const sph_error *why, sph_error *error);
/* Tells the numbers that are missing between those of a list; SPH_OK where that is not wanted. */
int sph_frames_missing(const char *directory, const long *number, int count,
                       const sph_left_out *left_out, sph_error *error);
/* sph_plot_nearest */
int sph_frames_nearest(const char *directory, const double *time, int n, long *nearest,
                       const sph_left_out *left_out, sph_error *error);

#endif
