/* case_include.h -- cases made of several files. */
#ifndef SPH_CASE_INCLUDE_H
#define SPH_CASE_INCLUDE_H
#include "case_schema.h"
#include "text.h"

/* Joins the files that `include` names into the tree of c, and takes the key away; 1: there were
 * some, 0: none, < 0: a status, the reason in c->error. */
int sph_case_include(sph_case *c);
/* The tree as lines that are read as the same tree. */
void sph_case_include_write(const sph_case *c, sph_text *text);

#endif
