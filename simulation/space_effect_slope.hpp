#pragma once

// Private to simulation/.

#include <array>
#include <limits>
#include <vector>

#include "downwash/simulation/space_effect.hpp"

// The surface effect around one configuration in space, as values and slopes; effect_slope.hpp has that of the plane.

namespace downwash::simulation {

/// Where a vehicle in space asks for surface effects.
struct AskedPlaces {
    dynamics::LaneRotation<double> attitude;               ///< of the vehicle
    std::vector<dynamics::LaneVector<double>> hub_m;       ///< of each rotor
    std::vector<dynamics::LaneVector<double>> read_hub_m;  ///< where its law reads K; empty: nowhere
    dynamics::LaneVector<double> center_m;                 ///< between the rotors
    bool has_fountain = false, has_walls = false;
};

/// A surface effect near one pose, linear in the position of every rotor and in the attitude of the vehicle.
class LinearSpaceEffect final : public SpaceEffect {
 public:
    /// The tangent of an effect, by differences over slope_step_m to both sides, and over as many radians about each
    /// axis of the body. Where K has a kink the slope is the mean of both.
    LinearSpaceEffect(SpaceEffect& surfaces, const AskedPlaces& places);

    /// These two are of the attitude about which the effect is linear.
    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) override;
    SidedFactor<double> at_body(const dynamics::LaneVector<double>& center_m) override;
    SidedFactor<double> at_turned_rotor(int rotor, const dynamics::LaneVector<double>& hub_m,
                                        const dynamics::LaneRotation<double>& attitude) override;
    SidedFactor<double> at_turned_body(const dynamics::LaneVector<double>& center_m,
                                       const dynamics::LaneRotation<double>& attitude) override;
    dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& center_m) override;

 private:
    /// Some numbers of a place and a small turn about the body's axes.
    template <std::size_t size>
    struct Tangent {
        dynamics::LaneVector<double> at_m{std::numeric_limits<double>::infinity(), 0, 0};  ///< nowhere
        std::array<double, size> value{};
        std::array<dynamics::LaneVector<double>, size> slope_1_m{}, slope_1_rad{};

        [[nodiscard]] double operator()(std::size_t i, const dynamics::LaneVector<double>& there_m,
                                        const dynamics::LaneVector<double>& turn_rad = {}) const {
            return value[i] + dot(slope_1_m[i], there_m - at_m) + dot(slope_1_rad[i], turn_rad);
        }
    };
    /// @param ask for the numbers at a place and a turn
    template <std::size_t size, class Ask>
    static Tangent<size> tangent(const dynamics::LaneVector<double>& at_m, const Ask& ask);
    /// How far an attitude is turned from the one about which the effect is linear.
    [[nodiscard]] dynamics::LaneVector<double> turn_rad(const dynamics::LaneRotation<double>& attitude) const;

    dynamics::LaneRotation<double> attitude_;
    std::vector<Tangent<2>> rotor_, read_;  ///< K of all surfaces, K of those above
    Tangent<2> body_;
    Tangent<3> walls_;
};

}  // namespace downwash::simulation
