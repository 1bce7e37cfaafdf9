#pragma once

#include "core/scene/navigation_sensor_desc.h"

namespace uw {

/// The density of sea water [kg/m^3] at a salinity [PSU], a temperature [degrees Celsius] and a
/// pressure above that of the air [Pa]: the International Equation of State of 1980, EOS-80
/// (Fofonoff and Millard 1983, "Algorithms for computation of fundamental properties of seawater",
/// UNESCO Technical Papers in Marine Science 44). It holds from 0 to 42 PSU, -2 to 40 degrees and
/// up to 1e8 Pa.
double sea_water_density(double salinity, double temperature, double pressure);

/// The pressure of water of one salinity and temperature by depth, exact for its compressibility:
/// dp/dz = density(p) g.
class WaterColumn {
  public:
    WaterColumn(double salinity, double temperature, double gravity);

    /// The pressure at a depth [Pa], above that of the air; 0 above the water.
    double pressure_at(double depth) const;
    /// The depth at a pressure [m].
    double depth_at(double pressure) const;

  private:
    double salinity_, temperature_, gravity_;
};

/// The tide's height at a time [m]; 0 without one.
double tide_at(const PressureDesc& desc, double time);

}  // namespace uw
