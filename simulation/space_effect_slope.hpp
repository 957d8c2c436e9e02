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
    std::vector<dynamics::LaneVector<double>> hub_m;       ///< of each rotor
    std::vector<dynamics::LaneVector<double>> read_hub_m;  ///< where its law reads K; empty: nowhere
    dynamics::LaneVector<double> center_m;                 ///< between the rotors
    bool has_fountain = false, has_walls = false;
};

/// A surface effect near one pose, linear in the position of every rotor.
class LinearSpaceEffect final : public SpaceEffect {
 public:
    /// The tangent of an effect, by differences over slope_step_m to both sides. Where K has a kink the slope is the
    /// mean of both.
    LinearSpaceEffect(SpaceEffect& surfaces, const AskedPlaces& places);

    SidedFactor<double> at_rotor(int rotor, const dynamics::LaneVector<double>& hub_m) override;
    SidedFactor<double> at_body(const dynamics::LaneVector<double>& center_m) override;
    dynamics::LaneVector<double> wall_nearness(const dynamics::LaneVector<double>& center_m) override;

 private:
    template <std::size_t size>
    struct Tangent {
        dynamics::LaneVector<double> at_m{std::numeric_limits<double>::infinity(), 0, 0};  ///< nowhere
        std::array<double, size> value{};
        std::array<dynamics::LaneVector<double>, size> slope_1_m{};

        [[nodiscard]] double operator()(std::size_t i, const dynamics::LaneVector<double>& there_m) const {
            return value[i] + dot(slope_1_m[i], there_m - at_m);
        }
    };
    template <std::size_t size, class Ask>
    static Tangent<size> tangent(const dynamics::LaneVector<double>& at_m, const Ask& ask);

    std::vector<Tangent<2>> rotor_, read_;  ///< K of all surfaces, K of those above
    Tangent<2> body_;
    Tangent<3> walls_;
};

}  // namespace downwash::simulation
