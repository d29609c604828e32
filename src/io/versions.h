/* versions.h -- what the library was made of and runs on, for files that must tell. */
#ifndef SPH_VERSIONS_H
#define SPH_VERSIONS_H
#include <stddef.h>

const char *sph_versions_compiler(void);
const char *sph_versions_sundials(void); /* "6.4.1" */
/* Each fills text (at most size bytes) and returns it. */
const char *sph_versions_hdf5(char *text, size_t size);    /* "1.10.8" */
const char *sph_versions_machine(char *text, size_t size); /* "Linux x86_64, 2 x <processor>" */

#endif
