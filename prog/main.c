/* sphode -- the program. */
#include <stdio.h>

#include "sphode.h"

int main(void) { return printf("sphode %s\n", sph_version()) < 0; }
