#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/problems/problem.hpp"
#include "downwash/problems/space_problem.hpp"
#include "downwash/scene/space_pose.hpp"

namespace downwash {

/// A planned flight at a control tick. Places are in the problem's world; those of a problem in a plane are in its
/// plane: x, to the left of it, z.
struct PlannedRow {
    double t_s = 0;  ///< since the plan's beginning
    Vector3 reference_m{}, reference_velocity_m_s{};
    double reference_yaw_rad = 0;
    std::array<double, max_joints> reference_joints_rad{};
    Vector3 position_m{};
    double clearance_m = 0;  ///< infinity without obstacles
    double thrust_n = 0;     ///< sum of the rotors' commands, as in free air
};

/// A plan flown in simulation, from its start to the end of its last hover, or to where the flight ended early.
struct PlannedFlight {
    double tick_s = 0;
    std::string outcome;  ///< as in files: "ok"
    std::vector<PlannedRow> rows;
};

/// Where a vehicle was, in the axes of PlannedRow.
struct FlownPose {
    Vector3 position_m{};
    std::array<double, 4> attitude{1, 0, 0, 0};  ///< quaternion (w, x, y, z) from body to world
    std::array<double, max_joints> joints_rad{};
};

/// What a log is compared with: a plan that can be flown, of a problem in a plane or in space. Safe to share between
/// threads.
class DOWNWASH_EXPORT ComparedPlan {
 public:
    ComparedPlan() = default;
    virtual ~ComparedPlan() = default;
    ComparedPlan(const ComparedPlan&) = delete;
    ComparedPlan& operator=(const ComparedPlan&) = delete;

    /// Whether the problem is one in a plane, beside which nothing is planned.
    [[nodiscard]] virtual bool is_in_plane() const noexcept = 0;
    /// The number of joints of the arm.
    [[nodiscard]] virtual std::size_t joints() const noexcept = 0;
    [[nodiscard]] virtual bool has_uncertainty() const noexcept = 0;
    /// Clearance that the planner kept [m].
    [[nodiscard]] virtual double safety_margin_m() const noexcept = 0;

    /// The plan in the nominal world, surface effects evaluated directly. @param aero false: in free air
    [[nodiscard]] virtual PlannedFlight fly(bool aero) const = 0;
    /// Where the vehicle is at each tick in a world of the problem's uncertainty, up to where that flight ends; empty
    /// if it cannot hover at its start. @pre has_uncertainty()
    [[nodiscard]] virtual std::vector<Vector3> fly_in_world(std::uint64_t seed, std::uint64_t world) const = 0;

    /// Smallest distance to an obstacle [m]; <= 0 on contact, infinity without obstacles. In a plane, roll and yaw of
    /// the vehicle do not count.
    [[nodiscard]] virtual double clearance_m(const FlownPose& pose) const = 0;
    /// The obstacle that is nearest, by its name in the problem; empty without one.
    [[nodiscard]] virtual std::string nearest_obstacle(const FlownPose& pose) const = 0;
};

/// @param problem with the order in which the plan visits its targets: in_order()
/// @pre the problem has no errors, and the plan a knot
[[nodiscard]] DOWNWASH_EXPORT std::unique_ptr<const ComparedPlan> compared_plan(const Problem& problem,
                                                                                const Plan& plan);
[[nodiscard]] DOWNWASH_EXPORT std::unique_ptr<const ComparedPlan> compared_plan(const SpaceProblem& problem,
                                                                                const SpacePlan& plan);

}  // namespace downwash
