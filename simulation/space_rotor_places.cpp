#include "downwash/simulation/space_rotor_places.hpp"

#include <algorithm>
#include <cmath>

namespace downwash::simulation {
namespace {

/// The other rotors in the order of a list of neighbours.
std::vector<std::size_t> in_order_of(const RotorNeighbours& neighbours, const std::vector<Vector3>& hubs_m,
                                     std::size_t rotor, double radius_m) {
    constexpr double rounding = 1e-9;
    std::vector<bool> is_used(hubs_m.size(), false);
    is_used[rotor] = true;
    std::vector<std::size_t> others;
    for (const auto& [x, y] : neighbours.offsets_radii) {
        for (std::size_t i = 0; i < hubs_m.size(); ++i) {
            const Vector3 offset_m = hubs_m[i] - hubs_m[rotor];
            if (!is_used[i] && std::abs(offset_m[0] / radius_m - x) < rounding &&
                std::abs(offset_m[1] / radius_m - y) < rounding) {
                is_used[i] = true;
                others.push_back(i);
                break;
            }
        }
    }
    return others;
}

}  // namespace

SpaceRotorPlaces::SpaceRotorPlaces(const SpaceRobot& robot) : radius_m(robot.rotor_radius_m) {
    const auto count = static_cast<double>(robot.plant.rotors.size());
    Vector3 center_m{};
    for (const SpaceRotor& rotor : robot.plant.rotors) {
        hubs_m.push_back(rotor.position_m);
        center_m = center_m + 1 / count * rotor.position_m;
    }
    for (std::size_t i = 0; i < hubs_m.size(); ++i) {
        neighbour.push_back(in_order_of(neighbours(i), hubs_m, i, radius_m));
        std::vector<Vector3>& offsets_m = neighbours_m.emplace_back();
        for (const std::size_t other : neighbour.back()) {
            offsets_m.push_back(hubs_m[other] - hubs_m[i]);
        }
        from_center_m.push_back(hubs_m[i] - center_m);
        const Vector3& from_m = from_center_m.back();
        reach_m = std::max(reach_m, std::sqrt(from_m[0] * from_m[0] + from_m[1] * from_m[1]));
    }
}

RotorNeighbours SpaceRotorPlaces::neighbours(std::size_t rotor) const {
    return neighbours_of(hubs_m, rotor, radius_m);
}

void place_at(const dynamics::LaneVector<double>& from_m, const dynamics::LaneRotation<double>& attitude,
              const std::vector<Vector3>& offsets_m, std::vector<Vector3>& at_m) {
    at_m.resize(offsets_m.size());
    for (std::size_t i = 0; i < offsets_m.size(); ++i) {
        const Vector3& offset_m = offsets_m[i];
        const dynamics::LaneVector<double> at =
            from_m + attitude * dynamics::LaneVector<double>{offset_m[0], offset_m[1], offset_m[2]};
        at_m[i] = {at.x, at.y, at.z};
    }
}

}  // namespace downwash::simulation
