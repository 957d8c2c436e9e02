#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

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
    /// The same two of a vehicle with an attitude, which matters among the images of several rotors and to a fountain:
    /// all rotors are then at their real places. The two above are of a level vehicle that heads along x.
    virtual SidedFactor<double> at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                                const dynamics::LaneRotation<double>& /*attitude*/) {
        return at_rotor(rotor, hub_m);
    }
    virtual SidedFactor<double> at_turned_body(const dynamics::LaneVector<double>& center_m,
                                               const dynamics::LaneRotation<double>& /*attitude*/) {
        return at_body(center_m);
    }
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

struct SpaceRotorPlaces;

/// The effects of a scene on a robot's rotors, evaluated directly. It remembers what it was asked lately: a step and
/// its two halves begin at the same place, and so does the row of a log.
class DOWNWASH_EXPORT DirectSpaceEffect final : public SpaceEffect {
 public:
    /// @throws InputError if a setting is out of range
    DirectSpaceEffect(const std::shared_ptr<const Scene>& scene, const AeroSettings& aero, const SpaceRobot& robot);
    ~DirectSpaceEffect() override;

    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) override;
    SidedFactor<double> at_body(const dynamics::LaneVector<double>& center_m) override;
    SidedFactor<double> at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                        const dynamics::LaneRotation<double>& attitude) override;
    SidedFactor<double> at_turned_body(const dynamics::LaneVector<double>& center_m,
                                       const dynamics::LaneRotation<double>& attitude) override;
    dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& center_m) override;
    bool is_flyable(int rotor, const dynamics::LaneVector<double>& hub_m) override;

 private:
    struct Asked {
        int rotor = -1;  ///< 0 for all where their attitude does not matter
        dynamics::LaneVector<double> hub_m{};
        dynamics::LaneRotation<double> attitude{};
        SidedFactor<double> factor{1, 1};
    };
    static constexpr std::size_t memories = 128;  ///< a power of two

    std::unique_ptr<const SpaceRotorPlaces> rotors_;
    std::vector<std::shared_ptr<const DirectEffect>> effects_;  ///< of each rotor; one where neighbours do not matter
    std::unique_ptr<const DirectEffect> fountain_;              ///< nullptr: there is none
    std::unique_ptr<const DirectEffect> walls_;                 ///< nullptr: walls do nothing
    std::array<Asked, memories> asked_;
    std::vector<Vector3> places_m_;  ///< room for those of other rotors
};

}  // namespace simulation
}  // namespace downwash
