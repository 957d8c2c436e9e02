#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::simulation {

/// The EffectField of a scene, evaluated directly. For one flight at a time: it remembers what it was asked lately,
/// because a step and its two halves begin at the same place, and so does the row of a log.
class DirectField {
 public:
    /// @pre the model outlives the field
    explicit DirectField(const FlightModel& model) : model_(&model) {}

    [[nodiscard]] SidedFactor<double> at_rotor(int rotor, double x_m, double z_m) {
        Asked& asked = asked_[place_of(rotor, x_m, z_m)];
        if (asked.rotor != rotor || asked.x_m != x_m || asked.z_m != z_m) {
            asked = {rotor, x_m, z_m, model_->sided_factor(rotor, x_m, z_m)};
        }
        return asked.factor;
    }
    [[nodiscard]] int same_as(int rotor) const noexcept { return rotor; }
    [[nodiscard]] SidedFactor<double> at_body(double x_m, double z_m) const {
        return model_->factor_in_layer(model_->body_layer(), x_m, z_m);
    }
    [[nodiscard]] double wall_nearness(double x_m, double z_m) const {
        return model_->factor_in_layer(model_->wall_layer(), x_m, z_m).all - 1;
    }
    DirectField& as_read() noexcept { return *this; }

 private:
    struct Asked {
        int rotor = -1;
        double x_m = 0, z_m = 0;
        SidedFactor<double> factor{1, 1};
    };
    static constexpr std::size_t places = 128;  ///< a power of two

    [[nodiscard]] static std::size_t place_of(int rotor, double x_m, double z_m) noexcept {
        const std::uint64_t mixed = std::bit_cast<std::uint64_t>(x_m) * 0x9E3779B97F4A7C15U ^
                                    std::bit_cast<std::uint64_t>(z_m) * 0xC2B2AE3D27D4EB4FU ^
                                    static_cast<std::uint64_t>(rotor) * 0xD6E8FEB86659FD93U;
        return static_cast<std::size_t>(mixed >> 57U);
    }

    const FlightModel* model_;
    std::array<Asked, places> asked_;
};

}  // namespace downwash::simulation
