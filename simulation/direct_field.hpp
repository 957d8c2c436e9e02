#pragma once

#include "downwash/simulation/effect_field.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::simulation {

/// The EffectField of a scene, evaluated directly.
class DirectField {
 public:
    /// @pre the model outlives the field
    explicit DirectField(const FlightModel& model) : model_(&model) {}

    [[nodiscard]] SidedFactor<double> at_rotor(int rotor, double x_m, double z_m) const {
        return model_->sided_factor(rotor, x_m, z_m);
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
    const FlightModel* model_;
};

}  // namespace downwash::simulation
