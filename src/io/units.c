#include "units.h"

const char *sph_units_get(enum sph_unit unit, int dim)
{
  static const char *const units[SPH_UNIT_COUNT][3] = {
      [SPH_UNIT_MASS] = {"kg/m^2", "kg/m", "kg"},
      [SPH_UNIT_MOMENTUM] = {"kg/(m s)", "kg/s", "kg m/s"},
      [SPH_UNIT_ANGULAR_MOMENTUM] = {"kg/s", "kg m/s", "kg m^2/s"},
      [SPH_UNIT_ENERGY] = {"J/m^2", "J/m", "J"},
      [SPH_UNIT_FORCE] = {"N/m^2", "N/m", "N"},
      [SPH_UNIT_TORQUE] = {"N/m", "N", "N m"},
      [SPH_UNIT_POWER] = {"W/m^2", "W/m", "W"},
  };
  return units[unit][dim - 1];
}
