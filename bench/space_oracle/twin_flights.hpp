#pragma once

#include <cstdint>
#include <memory>

#include "downwash/controllers/plan.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/simulation/flight_model.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/world.hpp"

// The same flight twice: by the planar closed loop, and by the one in space in the plane of motion. Both see the same
// surfaces, evaluated directly, and the same noise and gusts.

namespace downwash::bench {

/// How far two such flights come apart: the greatest over all ticks, but for the energy.
struct Apart {
    double place_m = 0;       ///< of the multirotor
    double beside_m = 0;      ///< of the flight in space, from the plane
    double attitude_rad = 0;  ///< angle between both attitudes
    double joint_rad = 0;
    double energy_j = 0;             ///< difference at the end
    std::int64_t clipped_ticks = 0;  ///< in which some demand was beyond its limit, in either flight
    double before_clipping_m = 0;    ///< place_m up to the first of them
};

/// The part of a world that a planar vehicle and one in space feel alike: nothing of it is beside the plane, and the
/// rotors of a planar robot that differ only in their distance from the plane share the mean of their scales.
[[nodiscard]] World in_plane(const World& world, const Robot& robot);

/// The plan of a search in the nominal world, the same on every run.
/// @throws InputError where the problem cannot be planned; std::runtime_error where the search finds no plan
[[nodiscard]] Plan nominal_plan(Problem problem, std::uint32_t seed, std::uint64_t iterations);

/// A planar problem flown twice.
class TwinFlights {
 public:
    /// @param in_space the problem's robot as one in space, with one joint and a model inversion
    /// @pre problem_errors(problem) and space_robot_errors(in_space) are empty, and both outlive this
    TwinFlights(const Problem& problem, const SpaceRobot& in_space);

    /// Flies a plan from rest at its first knot, and hovers at its end until so many ticks have passed. No rule ends
    /// the flights.
    /// @param world as of in_plane()
    [[nodiscard]] Apart fly(const Plan& plan, const World& world, std::int64_t ticks) const;

 private:
    const Problem& problem_;
    const SpaceRobot& in_space_;
    std::shared_ptr<const FlightModel> planar_;
    std::shared_ptr<const Scene> scene_;
};

}  // namespace downwash::bench
