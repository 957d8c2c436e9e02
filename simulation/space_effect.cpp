#include "downwash/simulation/space_effect.hpp"

#include <bit>
#include <cstdint>

#include "downwash/aeromap/direct_effect.hpp"
#include "downwash/effects/effect_models.hpp"
#include "downwash/simulation/space_rotor_places.hpp"

namespace downwash::simulation {
namespace {

Vector3 vector_of(const dynamics::LaneVector<double>& v) {
    return {v.x, v.y, v.z};
}

std::size_t memory_of(const dynamics::LaneVector<double>& hub_m) noexcept {
    const std::uint64_t mixed = std::bit_cast<std::uint64_t>(hub_m.x) * 0x9E3779B97F4A7C15U ^
                                std::bit_cast<std::uint64_t>(hub_m.y) * 0xD6E8FEB86659FD93U ^
                                std::bit_cast<std::uint64_t>(hub_m.z) * 0xC2B2AE3D27D4EB4FU;
    return static_cast<std::size_t>(mixed >> 57U);
}

bool are_equal(const dynamics::LaneVector<double>& a, const dynamics::LaneVector<double>& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool are_equal(const dynamics::LaneRotation<double>& a, const dynamics::LaneRotation<double>& b) {
    return are_equal(a.first, b.first) && are_equal(a.second, b.second) && are_equal(a.third, b.third);
}

}  // namespace

DirectSpaceEffect::DirectSpaceEffect(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero,
                                     const SpaceRobot& robot)
    : rotors_(std::make_unique<const SpaceRotorPlaces>(robot)) {
    const double radius_m = robot.rotor_radius_m;
    if (is_multirotor(aero.ground.model) || is_multirotor(aero.ceiling.model)) {
        for (std::size_t i = 0; i < rotors_->hubs_m.size(); ++i) {
            effects_.push_back(std::make_shared<const DirectEffect>(scene, aero, radius_m, rotors_->neighbours(i)));
        }
    } else {
        effects_.push_back(std::make_shared<const DirectEffect>(scene, aero, radius_m));
    }
    if (aero.enabled && !aero.map && aero.ground.model == EffectModel::multirotor_body) {
        fountain_ =
            std::make_unique<const DirectEffect>(DirectEffect::fountain(scene, aero, radius_m, rotors_->neighbours(0)));
    }
    if (aero.enabled && aero.wall.is_any()) {
        walls_ =
            std::make_unique<const DirectEffect>(DirectEffect::walls_around(scene, aero, radius_m, rotors_->reach_m));
    }
}

DirectSpaceEffect::~DirectSpaceEffect() = default;

SidedFactor<double> DirectSpaceEffect::at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) {
    return at_turned_rotor(rotor, hub_m, level_attitude);
}

SidedFactor<double> DirectSpaceEffect::at_body(const dynamics::LaneVector<double>& center_m) {
    return at_turned_body(center_m, level_attitude);
}

SidedFactor<double> DirectSpaceEffect::at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                                       const dynamics::LaneRotation<double>& attitude) {
    const bool are_alone = effects_.size() == 1;
    const int which = are_alone ? 0 : rotor;
    const dynamics::LaneRotation<double>& that_matters = are_alone ? level_attitude : attitude;
    Asked& asked = asked_[memory_of(hub_m)];
    if (asked.rotor != which || !are_equal(asked.hub_m, hub_m) || !are_equal(asked.attitude, that_matters)) {
        const auto i = static_cast<std::size_t>(which);
        if (!are_alone) {
            place_at(hub_m, attitude, rotors_->neighbours_m[i], places_m_);
        }
        asked = {which, hub_m, that_matters,
                 are_alone ? effects_[i]->sided_factor(vector_of(hub_m))
                           : effects_[i]->sided_factor(vector_of(hub_m), places_m_)};
    }
    return asked.factor;
}

SidedFactor<double> DirectSpaceEffect::at_turned_body(const dynamics::LaneVector<double>& center_m,
                                                      const dynamics::LaneRotation<double>& attitude) {
    if (fountain_ == nullptr) {
        return {1, 1};
    }
    place_at(center_m, attitude, rotors_->from_center_m, places_m_);
    return {fountain_->fountain_factor(places_m_), 1};
}

dynamics::LaneVector<double> DirectSpaceEffect::wall_nearness(const dynamics::LaneVector<double>& center_m) {
    if (walls_ == nullptr) {
        return {0, 0, 0};
    }
    const Vector3 towards = walls_->towards_wall(vector_of(center_m));
    return {towards[0], towards[1], towards[2]};
}

bool DirectSpaceEffect::is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) {
    return effects_[effects_.size() == 1 ? 0 : static_cast<std::size_t>(rotor)]->is_flyable(vector_of(hub_m));
}

}  // namespace downwash::simulation
