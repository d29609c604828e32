/* export_format.h -- one frame of one kind of particles in the format of another tool. */
#ifndef SPH_EXPORT_FORMAT_H
#define SPH_EXPORT_FORMAT_H
#include "sphode/export.h"
#include "table.h"
#include "text.h"

/* Adds the file to text.  single: numbers of single precision. */
void sph_export_csv(const sph_table *table, int single, sph_text *text);
void sph_export_splash(const sph_table *table, int single, sph_text *text);
void sph_export_vtu(const sph_table *table, int single, sph_text *text);
/* The bytes (sph_memory_free) of a file of both parts; source: the snapshot they come from. */
void *sph_export_gadget(const char *source, const sph_table part[2], int single, size_t *size,
                        sph_error *error);

#endif
