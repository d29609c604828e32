/* units.h -- units that depend on the dimension: in 2D a simulation is a metre deep, in 1D a square
 * metre across, and sums over particles are per metre, per square metre. */
#ifndef SPH_UNITS_H
#define SPH_UNITS_H

enum sph_unit {
  SPH_UNIT_MASS,
  SPH_UNIT_MOMENTUM,
  SPH_UNIT_ANGULAR_MOMENTUM,
  SPH_UNIT_ENERGY,
  SPH_UNIT_FORCE,
  SPH_UNIT_TORQUE,
  SPH_UNIT_POWER,
  SPH_UNIT_COUNT
};

/* dim = 1, 2, 3; "J/m" */
const char *sph_units_get(enum sph_unit unit, int dim);

#endif
