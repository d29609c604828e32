/* layout.h -- what the entries of the ODE vector are: one segment per group, field and
 * component. */
#ifndef SPH_LAYOUT_H
#define SPH_LAYOUT_H

/* How a second-order scheme treats a segment. */
enum sph_role { SPH_ROLE_POSITION, SPH_ROLE_VELOCITY, SPH_ROLE_OTHER };

typedef struct sph_segment {
  long offset;   /* first entry, a multiple of 8 */
  long n;        /* entries that count; the rest up to capacity is padding */
  long capacity; /* a multiple of 8 */
  int role;      /* enum sph_role; the segment behind a POSITION one of component c is matched by
                    `partner` */
  int partner;   /* POSITION: index of the segment that holds its velocity; others: -1 */
} sph_segment;

typedef struct sph_layout {
  long length;  /* doubles in the block, padding included; a multiple of 8 */
  long entries; /* sum of n */
  int segments;
  sph_segment *segment; /* [segments], offsets rising */
} sph_layout;

#endif
