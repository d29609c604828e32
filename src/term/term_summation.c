#include "sphode/term.h"

sph_term sph_term_summation(int calibrate)
{
  return (sph_term){.name = "summation", .calibrate = calibrate};
}
