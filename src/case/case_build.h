/* case_build.h -- what the builder shares with the files that build parts. */
#ifndef SPH_CASE_BUILD_H
#define SPH_CASE_BUILD_H
#include "case_motion.h"
#include "case_schema.h"
#include "sphode/neighbors.h"
#include "sphode/output.h"
#include "sphode/sim.h"

/* Walls with a motion. */
typedef struct sph_case_motions {
  int n;
  struct {
    const char *group; /* of the case */
    sph_case_motion *motion;
  } of[SPH_SETS_MAX];
} sph_case_motions;

/* The term of a checked node of `terms`; its form is borrowed from the node. */
sph_term sph_case_build_term(const sph_case_node *map);
/* Its snapshots; texts are borrowed. */
sph_hdf5_def sph_case_build_output_hdf5(const sph_case *c, const char *directory,
                                        const char *command);
/* Are the names of output: fields those of fields of the simulation? */
int sph_case_build_output_fields(const sph_case *c, const sph_sim *sim, sph_error *error);
/* Time between frames of a probe; NULL: of the series [s]. */
double sph_case_build_output_interval(const sph_case *c, const sph_case_node *probe);

#endif
