#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "downwash/aeromap/aero_settings.hpp"
#include "downwash/base/export.hpp"
#include "downwash/dynamics/lane_vector.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_robot.hpp"

// Where a flight in space takes the effects of surfaces from, for one flight at a time and chosen at run time.

namespace downwash {

class DirectEffect;

namespace simulation {

/// A SpaceField (space_surroundings.hpp) of surfaces in their nominal places, and where rotors may be.
class SpaceEffect {
 public:
    SpaceEffect() = default;
    virtual ~SpaceEffect() = default;
    SpaceEffect(const SpaceEffect&) = delete;
    SpaceEffect& operator=(const SpaceEffect&) = delete;

    /// K by side of a level rotor with its hub there. @param rotor its number in the robot
    virtual SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) = 0;
    /// K by side of the body with the centre between its rotors there; 1 where there is no fountain.
    virtual SidedFactor<double> at_body(const dynamics::LaneVector<double>& /*center_m*/) { return {1, 1}; }
    /// Level vector towards the nearest wall, of length 1 where a rotor touches it and less with distance.
    virtual dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& /*center_m*/) {
        return {0, 0, 0};
    }
    /// Whether a rotor with its hub there is inside the flyable area (docs/model.md 4.4).
    virtual bool is_flyable(int /*rotor*/, const dynamics::LaneVector<double>& /*hub_m*/) { return true; }
};

/// No surface effect anywhere: everything is flyable.
class NoEffectInSpace final : public SpaceEffect {
 public:
    SidedFactor<double> at_rotor(int /*rotor*/, const dynamics::LaneVector<double>& /*hub_m*/) override {
        return {1, 1};
    }
};

/// The effects of a scene on a robot's rotors, evaluated directly. It remembers what it was asked lately: a step and
/// its two halves begin at the same place, and so does the row of a log.
class DOWNWASH_EXPORT DirectSpaceEffect final : public SpaceEffect {
 public:
    /// @throws InputError if a setting is out of range, or a model is one of several rotors, which depends on their
    /// heading
    DirectSpaceEffect(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero, const SpaceRobot& robot);
    ~DirectSpaceEffect() override;

    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) override;
    dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& center_m) override;
    bool is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) override;

 private:
    struct Asked {
        dynamics::LaneVector<double> hub_m{};
        SidedFactor<double> factor{1, 1};
        bool is_known = false;
    };
    static constexpr std::size_t places = 128;  ///< a power of two

    std::unique_ptr<const DirectEffect> rotor_;  ///< the same for all rotors
    double wall_reach_m_ = 0;                    ///< from the centre between the hubs to the farthest one, level
    double wall_decay_m_ = 0;                    ///< 0: walls do nothing
    std::array<Asked, places> asked_;
};

}  // namespace simulation
}  // namespace downwash
