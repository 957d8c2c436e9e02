#include "downwash/dynamics/space_slipstreams.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "downwash/dynamics/slipstream_shape.hpp"

namespace downwash {
namespace {

using dynamics::LaneVector;

LaneVector<double> direction_of(const Vector3& v) {
    const double inverse = 1 / std::sqrt(dot(v, v));
    return {inverse * v[0], inverse * v[1], inverse * v[2]};
}

/// The whole length of the arm from its first joint on.
double reach_of(const SpacePlant& plant) {
    double reach_m = std::sqrt(dot(plant.end_effector_m, plant.end_effector_m));
    for (std::size_t i = 1; i < plant.links.size(); ++i) {
        reach_m += std::sqrt(dot(plant.links[i].joint_m, plant.links[i].joint_m));
    }
    return reach_m;
}

/// Whether all links turn about the body's y axis and lie in one plane across it.
bool turns_in_one_plane(const SpacePlant& plant) {
    bool does = plant.end_effector_m[1] == 0;
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        const SpaceLink& link = plant.links[i];
        does = does && link.axis[0] == 0 && link.axis[2] == 0 && (i == 0 || link.joint_m[1] == 0);
    }
    return does;
}

/// False where no link comes below an upright rotor as deep as where its slipstream has become wide enough to meet the
/// plane in which the arm turns.
bool can_meet(const SpacePlant& plant, const SpaceRotor& rotor, double radius_m) {
    if (!turns_in_one_plane(plant) || rotor.axis[0] != 0 || rotor.axis[1] != 0 || rotor.axis[2] < 0) {
        return true;
    }
    const Vector3& joint_m = plant.links.front().joint_m;
    const double depth_m = std::max(rotor.position_m[2] - joint_m[2] + reach_of(plant), 0.0);
    return std::abs(rotor.position_m[1] - joint_m[1]) <
           dynamics::edge_radii * radius_m + dynamics::edge_spread * depth_m;
}

bool mirror_each_other(const SpaceRotor& a, const SpaceRotor& b) {
    const auto are_mirrored = [](const Vector3& v, const Vector3& w) {
        return v[0] == w[0] && v[1] == -w[1] && v[2] == w[2];
    };
    return are_mirrored(a.position_m, b.position_m) && are_mirrored(a.axis, b.axis);
}

}  // namespace

SpaceSlipstreams space_slipstreams_of(const SpacePlant& plant, double rotor_radius_m) {
    SpaceSlipstreams all;
    if (!plant.wash || plant.wash->scale == 0 || plant.links.empty()) {
        return all;
    }
    all.radius_m = rotor_radius_m;
    const double disc_m2 = std::numbers::pi * rotor_radius_m * rotor_radius_m;
    constexpr double air_density_kg_m3 = 1.225;  // at sea level, 15 degrees
    all.speed_squared_per_n = plant.wash->scale * plant.wash->scale / (2 * air_density_kg_m3 * disc_m2);
    const int rotors = static_cast<int>(plant.rotors.size());
    const auto rotor = [&](int number) -> const SpaceRotor& { return plant.rotors[static_cast<std::size_t>(number)]; };
    for (int i = 0; i < rotors; ++i) {
        const LaneVector<double> axis = direction_of(rotor(i).axis);
        // The axis that is farther from the rotor's: x for one that is upright.
        const LaneVector<double> some =
            std::abs(axis.x) < 0.9 ? LaneVector<double>{1, 0, 0} : LaneVector<double>{0, 1, 0};
        LaneVector<double> first = some - dot(some, axis) * axis;
        first = 1 / std::sqrt(dot(first, first)) * first;
        all.first_across[i] = first;
        all.second_across[i] = cross(axis, first);
        if (!can_meet(plant, rotor(i), rotor_radius_m)) {
            continue;
        }
        int slipstream = 0;
        while (slipstream < all.count && !(all.mirror[slipstream] < 0 && rotor(i).position_m[1] != 0 &&
                                           mirror_each_other(rotor(all.rotor[slipstream]), rotor(i)))) {
            ++slipstream;
        }
        if (slipstream < all.count) {
            all.mirror[slipstream] = i;
        } else {
            all.rotor[all.count] = i;
            all.mirror[all.count++] = -1;
        }
    }
    return all;
}

}  // namespace downwash
