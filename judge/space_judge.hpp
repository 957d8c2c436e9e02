#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/judge/space_judged_flight.hpp"
#include "downwash/scene/shapes.hpp"
#include "downwash/simulation/space_goal.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/space_world_description.hpp"

namespace downwash::judge {

/// How to fly.
struct SpaceFlightConditions {
    SpaceJudgedMotion start;
    std::vector<double> rotor_thrust_n, controller_memory;  ///< of a vehicle in flight: see SpaceCarry
    std::int64_t hold_ticks = 0;  ///< hover after the last knot, >= 0; with goals these say it
    bool aero = true;             ///< false: surfaces have no effect on the rotors
    /// Empty: everything is nominal. In a world a vehicle that starts level and at rest has hovered there for 20 s
    /// before, in calm air and with quiet sensors.
    std::optional<SpaceWorld> world;
    std::optional<double> energy_budget_j;
    std::vector<SpaceGoal> goals;  ///< that the flight has to meet, one after the other; none: it is `ok` at its end
    bool in_any_order = false;     ///< in the order in which the plan comes to them
    bool records = false;          ///< whether the flight has what the vehicle itself could record
};

/// Flies plans of a robot in space and says how they end. It shares parameters, shapes and the formulas of surface
/// effects with the planner, and nothing that computes a flight (judge/README.md). Safe to share between threads.
class DOWNWASH_EXPORT SpaceJudge {
 public:
    /// @throws InputError if a setting of the air is out of range
    /// @pre space_robot_errors(robot) is empty, Scene would take the obstacles
    SpaceJudge(const SpaceRobot& robot, const std::vector<Obstacle>& obstacles, const AeroSettings& aero);
    ~SpaceJudge();
    SpaceJudge(const SpaceJudge&) = delete;
    SpaceJudge& operator=(const SpaceJudge&) = delete;

    /// @pre the plan has a knot, the first at tick 0, the robot's joints and its tick
    [[nodiscard]] SpaceJudgedFlight fly(const SpacePlan& plan, const SpaceFlightConditions& conditions = {}) const;

 private:
    struct Shared;
    std::unique_ptr<const Shared> shared_;
};

}  // namespace downwash::judge
