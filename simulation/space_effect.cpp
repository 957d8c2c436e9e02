#include "downwash/simulation/space_effect.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/scene/collision_checker.hpp"

namespace downwash::simulation {
namespace {

const AeroSettings& of_single_rotors(const AeroSettings& aero) {
    std::vector<KeyError> errors;
    for (const auto& [effect, key] :
         {std::pair(&aero.ground, "aero.ground"), std::pair(&aero.ceiling, "aero.ceiling")}) {
        if (is_multirotor(effect->model)) {
            errors.push_back({key,
                              "is a model of several rotors, which depends on where the vehicle heads: for "
                              "flights in space choose a model of a single rotor"});
        }
    }
    throw_if_any(std::move(errors));
    return aero;
}

Vector3 vector_of(const dynamics::LaneVector<double>& v) {
    return {v.x, v.y, v.z};
}

std::size_t place_of(const dynamics::LaneVector<double>& hub_m) noexcept {
    const std::uint64_t mixed = std::bit_cast<std::uint64_t>(hub_m.x) * 0x9E3779B97F4A7C15U ^
                                std::bit_cast<std::uint64_t>(hub_m.y) * 0xD6E8FEB86659FD93U ^
                                std::bit_cast<std::uint64_t>(hub_m.z) * 0xC2B2AE3D27D4EB4FU;
    return static_cast<std::size_t>(mixed >> 57U);
}

}  // namespace

DirectSpaceEffect::DirectSpaceEffect(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero,
                                     const SpaceRobot& robot)
    : rotor_(std::make_unique<const DirectEffect>(scene, of_single_rotors(aero), robot.rotor_radius_m)) {
    if (aero.enabled && aero.wall.is_any()) {
        const std::vector<SpaceRotor>& rotors = robot.plant.rotors;
        Vector3 center_m{};
        for (const SpaceRotor& rotor : rotors) {
            center_m = center_m + 1 / static_cast<double>(rotors.size()) * rotor.position_m;
        }
        for (const SpaceRotor& rotor : rotors) {
            const Vector3 from_m = rotor.position_m - center_m;
            wall_reach_m_ = std::max(wall_reach_m_, std::sqrt(from_m[0] * from_m[0] + from_m[1] * from_m[1]));
        }
        wall_decay_m_ = aero.wall.decay_radii * robot.rotor_radius_m;
    }
}

DirectSpaceEffect::~DirectSpaceEffect() = default;

SidedFactor<double> DirectSpaceEffect::at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) {
    Asked& asked = asked_[place_of(hub_m)];
    if (!asked.is_known || asked.hub_m.x != hub_m.x || asked.hub_m.y != hub_m.y || asked.hub_m.z != hub_m.z) {
        asked = {hub_m, rotor_->sided_factor(vector_of(hub_m)), true};
    }
    return asked.factor;
}

dynamics::LaneVector<double> DirectSpaceEffect::wall_nearness(const dynamics::LaneVector<double>& center_m) {
    if (!(wall_decay_m_ > 0)) {
        return {0, 0, 0};
    }
    const auto distance_m = [&](double dx_m, double dy_m) {
        return horizontal_clearance_m(rotor_->scene(), {center_m.x + dx_m, center_m.y + dy_m, center_m.z});
    };
    const double here_m = distance_m(0, 0);
    if (!std::isfinite(here_m)) {
        return {0, 0, 0};
    }
    // The distance falls as fast as the way leads towards the wall. Between two walls this step makes the direction
    // turn without a jump.
    constexpr double step_m = 0.02;
    double x = (distance_m(-step_m, 0) - distance_m(step_m, 0)) / (2 * step_m);
    double y = (distance_m(0, -step_m) - distance_m(0, step_m)) / (2 * step_m);
    const double length = std::max(1.0, std::sqrt(x * x + y * y));
    const double gap_m = std::max(0.0, here_m - wall_reach_m_ - rotor_->rotor_radius_m());
    const double scale = std::exp(-gap_m / wall_decay_m_) / length;
    return {scale * x, scale * y, 0};
}

bool DirectSpaceEffect::is_flyable(int /*rotor*/, const dynamics::LaneVector<double>& hub_m) {
    return rotor_->is_flyable(vector_of(hub_m));
}

}  // namespace downwash::simulation
