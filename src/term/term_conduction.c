#include "sphode/term.h"

sph_term sph_term_conduction(void) { return (sph_term){.name = "conduction"}; }
