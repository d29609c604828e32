#include "sphode/term.h"

sph_term sph_term_xsph(double epsilon) { return (sph_term){.name = "xsph", .epsilon = epsilon}; }
