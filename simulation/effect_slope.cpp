#include "downwash/simulation/effect_slope.hpp"

#include "downwash/dynamics/flight_step.hpp"

namespace downwash::simulation {

LinearEffect::LinearEffect(const FlightModel& model, const PlanarPose& pose) {
    const auto tangent_of = [&](int rotor, double x, double z) -> Tangent {
        constexpr double h = slope_step_m;
        const auto factor = [&](double at_x, double at_z) { return model.direct_factor(rotor, at_x, at_z); };
        return {x, z, factor(x, z), (factor(x + h, z) - factor(x - h, z)) / (2 * h),
                (factor(x, z + h) - factor(x, z - h)) / (2 * h)};
    };
    const PlantModel& plant = model.tick().plant;
    const auto feed_forward = controllers::aids_of(model.tick().law).feed_forward;
    // Whatever the plant asks for on its way to a force is what has to be known.
    const double nothing_n[max_rotors] = {};
    static_cast<void>(dynamics::rotor_wrench(plant, dynamics::attitude(plant, pose.pitch_rad, pose.arm_rad), pose.x_m,
                                             pose.z_m, nothing_n, [&](int rotor, double x, double z) {
                                                 acting_[rotor] = tangent_of(rotor, x, z);
                                                 read_[rotor] = acting_[rotor];
                                                 if (feed_forward) {
                                                     read_[rotor] = tangent_of(rotor, x - feed_forward->offset_x_m,
                                                                               z - feed_forward->offset_z_m);
                                                 }
                                                 return 1.0;
                                             }));
}

}  // namespace downwash::simulation
