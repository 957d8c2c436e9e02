#pragma once

#include <memory>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/judge/plan_judge.hpp"

namespace downwash::judge {

/// What a vehicle can tell about itself at a control tick; plane coordinates, SI units.
struct SensorReadings {
    /// What its controller sees in this tick: late, with bias and noise, as world and robot have it.
    PlanarPose pose;
    double vx_m_s = 0, vz_m_s = 0, pitch_rate_rad_s = 0, arm_rate_rad_s = 0;
    std::vector<double> rotor_thrust_n;  ///< free-air thrust that the rotors' lag has reached, of each
};

/// A vehicle in the judge's closed loop that is told its reference tick by tick, for programs that command a vehicle
/// while it flies. With the reference of a plan it flies as PlanJudge::fly() does, to the last bit.
class DOWNWASH_EXPORT SimulatedVehicle {
 public:
    /// At the problem's start. In a world, one at rest has hovered there.
    /// @pre problem_errors(problem) is empty
    SimulatedVehicle(const Problem& problem, const FlightConditions& conditions);
    ~SimulatedVehicle();
    SimulatedVehicle(const SimulatedVehicle&) = delete;
    SimulatedVehicle& operator=(const SimulatedVehicle&) = delete;

    /// Flies one control tick towards a reference.
    /// @param now of this tick   @param next of the one after, which the row of the flight shows
    /// @return whether the flight goes on: it ends on contact, off the flyable area, or unstable
    bool follow(const ReferencePoint& now, const ReferencePoint& next);

    /// What the vehicle says at this tick.
    [[nodiscard]] SensorReadings readings() const;

    /// How it truly flew, up to now. The outcome is `ok` while it flies; goals are not judged.
    [[nodiscard]] const JudgedFlight& flight() const noexcept;

    /// How far a pose is from a goal, over its tolerance: met up to 1. Among alternatives from the nearest.
    [[nodiscard]] double used_share(const Goal& goal, const PlanarPose& pose) const;

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace downwash::judge
