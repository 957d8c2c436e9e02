#include "downwash/simulation/effect_slope.hpp"

#include "downwash/dynamics/rigid_body.hpp"

namespace downwash::simulation {

LinearEffect::LinearEffect(const FlightModel& model, const PlanarPose& pose, double offset_x_m, double offset_z_m) {
    const auto tangent_of = [&](std::size_t layer, const dynamics::PlanePoint<double>& at_m) -> Tangent {
        constexpr double h = slope_step_m;
        const double x = at_m.x - offset_x_m;
        const double z = at_m.z - offset_z_m;
        const auto factor = [&](double x_m, double z_m) { return model.factor_in_layer(layer, x_m, z_m).all; };
        return {x, z, factor(x, z), (factor(x + h, z) - factor(x - h, z)) / (2 * h),
                (factor(x, z + h) - factor(x, z - h)) / (2 * h)};
    };
    const PlantModel& plant = model.tick().plant;
    const auto attitude = dynamics::attitude(plant, pose.pitch_rad, pose.arm_rad);
    for (int i = 0; i < plant.rotor_count; ++i) {
        rotor_[i] = tangent_of(model.rotor_layer(i), dynamics::rotor_position(plant, attitude, pose.x_m, pose.z_m, i));
    }
    const auto center = dynamics::center_position(plant, attitude, pose.x_m, pose.z_m);
    if (plant.has_fountain) {
        body_ = tangent_of(model.body_layer(), center);
    }
    if (plant.has_walls) {
        walls_ = tangent_of(model.wall_layer(), center);
    }
}

LinearEffect::LinearEffect(const FlightModel& model, const PlanarPose& pose) : LinearEffect(model, pose, 0, 0) {
    if (const auto feed_forward = controllers::aids_of(model.tick().law).feed_forward) {
        read_.reset(new LinearEffect(model, pose, feed_forward->offset_x_m, feed_forward->offset_z_m));
    }
}

}  // namespace downwash::simulation
