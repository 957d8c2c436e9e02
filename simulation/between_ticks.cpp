#include "downwash/simulation/between_ticks.hpp"

#include <algorithm>
#include <cmath>

#include "downwash/simulation/flight_rules.hpp"

namespace downwash::simulation {
namespace {

PlanarPose between(const PlanarPose& from, const PlanarPose& to, double share) {
    return {from.x_m + share * (to.x_m - from.x_m), from.z_m + share * (to.z_m - from.z_m),
            from.pitch_rad + share * (to.pitch_rad - from.pitch_rad),
            from.arm_rad + share * (to.arm_rad - from.arm_rad), to.lateral_m};
}

using Clearance = double (*)(const FlightModel&, const PlanarPose&);

/// @param unseen_m the motion between both poses
double min_clearance_m(const FlightModel& model, Clearance clearance_m, const PlanarPose& from, double from_m,
                       const PlanarPose& to, double to_m, double unseen_m) {
    constexpr double least_motion_m = 0.001;
    if (from_m + to_m >= unseen_m || unseen_m <= least_motion_m) {
        return std::min(from_m, to_m);
    }
    const PlanarPose middle = between(from, to, 0.5);
    const double middle_m = clearance_m(model, middle);
    if (middle_m <= 0) {
        return middle_m;
    }
    const double first_m = min_clearance_m(model, clearance_m, from, from_m, middle, middle_m, 0.5 * unseen_m);
    return first_m <= 0 ? first_m : min_clearance_m(model, clearance_m, middle, middle_m, to, to_m, 0.5 * unseen_m);
}

}  // namespace

MotionReach motion_reach(const FlightModel& model) noexcept {
    const PlantModel& plant = model.tick().plant;
    return {model.collisions().body_reach_m(),
            std::sqrt(plant.joint_x_m * plant.joint_x_m + plant.joint_z_m * plant.joint_z_m), plant.arm_length_m};
}

double motion_m(const FlightModel& model, const PlanarPose& from, const PlanarPose& to) noexcept {
    const double a[4] = {from.x_m, from.z_m, from.pitch_rad, from.arm_rad};
    const double b[4] = {to.x_m, to.z_m, to.pitch_rad, to.arm_rad};
    return motion_m(motion_reach(model), a, b);
}

bool comes_nearer_between(const FlightModel& model, const PlanarPose& from, const PlanarPose& to, double margin_m) {
    const double pieces = std::ceil(motion_m(model, from, to) / max_unseen_motion_m(margin_m));
    for (double i = 1; i < pieces; ++i) {
        if (model.collisions().is_nearer_than(between(from, to, i / pieces), margin_m)) {
            return true;
        }
    }
    return false;
}

double least_clearance_between_m(const FlightModel& model, const PlanarPose& from, double from_m, const PlanarPose& to,
                                 double to_m, Clearance clearance_m) {
    return min_clearance_m(model, clearance_m, from, from_m, to, to_m, motion_m(model, from, to));
}

}  // namespace downwash::simulation
