#pragma once

#include <cstdint>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/effects/surface_effect.hpp"
#include "downwash/studies/planar_flight.hpp"

// A quadrotor that can only pitch, and a plate that comes under its front rotor: the test bench of thesis 3.5. The laws
// of controllers/ hold a position too, and would take the axle's force for a disturbance of it: the bench has the pitch
// loops of the cascade and an observer of the pitch torque alone.

namespace downwash::studies {

/// What the cascade of pitch and pitch rate has beside itself.
enum class BenchAid : std::uint8_t { none, feed_forward, observer };

struct BenchExperiment {
    PlanarVehicle vehicle;
    PlanarControl control;  ///< gains of pitch and pitch rate alone count
    double rate_ki = 0;     ///< integral of the pitch rate error [1/s2]
    double observer_gain_1_s = 10;
    SurfaceEffect ground;
    double z_over_r = 2;               ///< height of the level vehicle over the plate, over R
    double friction_nm_s_rad = 0.002;  ///< friction of the bearings
    double plate_from_s = 5, plate_to_s = 20, end_s = 30;
    BenchAid aid = BenchAid::none;
};

/// Pitch at 100 Hz; positive is nose down, and the plate lifts the nose.
struct BenchFlight {
    std::vector<double> time_s, pitch_deg;

    [[nodiscard]] DOWNWASH_EXPORT double pitch_at(double at_s) const;
    /// Greatest size of the pitch between two times.
    [[nodiscard]] DOWNWASH_EXPORT double peak_deg(double from_s, double to_s) const;
};

[[nodiscard]] DOWNWASH_EXPORT BenchFlight fly(const BenchExperiment& experiment);

}  // namespace downwash::studies
