#include "downwash/problems/uncertainty_parameters.hpp"

#include <string>
#include <utility>

#include "downwash/base/parameter_factories.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;

/// That of a problem; the defaults where it has none.
const Uncertainty& uncertainty_of(const Problem& problem) {
    static const Uncertainty usual;
    return problem.uncertainty ? *problem.uncertainty : usual;
}
Uncertainty& uncertainty_of(Problem& problem) {
    return *problem.uncertainty;
}

/// The rows of one group of spreads.
class Spreads {
 public:
    Spreads(Rows& rows, std::string path, std::string_view description) : rows_(rows), path_(std::move(path)) {
        rows_.push_back(parameters::group<Problem>(path_, description));
    }

    /// What may be as much more as less than believed.
    void add(std::string_view name, std::string_view description, double most, Spread Uncertainty::*spread) {
        push(name, description, {"sd", "range"}, -most, most, spread);
    }
    /// What is never negative; factors are of what the robot has.
    void add_of_robot(std::string_view name, std::string_view description, double most, Spread Uncertainty::*spread) {
        push(name, description, {"sd", "range", "factor"}, 0, most, spread);
    }
    /// What is drawn anew all the time.
    void add_noise(std::string_view name, std::string_view description, double most, Spread Uncertainty::*spread) {
        push(name, description, {"sd"}, 0, most, spread);
    }

 private:
    void push(std::string_view name, std::string_view description, const std::vector<std::string_view>& forms,
              double low, double high, Spread Uncertainty::*spread) {
        rows_.push_back(parameters::spread<Problem>(
                            path_ + "." + std::string(name), description,
                            forms, [spread](auto& p) -> auto& { return uncertainty_of(p).*spread; })
                            .at_least(low)
                            .at_most(high));
    }

    Rows& rows_;
    std::string path_;
};

}  // namespace

void add_uncertainty_rows(Rows& rows) {
    using U = Uncertainty;
    rows.push_back(parameters::optional_group<Problem>(
                       "uncertainty", "what is not known exactly; plans survive it. none: everything is as believed",
                       [](auto& p) -> auto& { return p.uncertainty; })
                       .or_none());
    Spreads aero(rows, "uncertainty.aero", "surfaces and their effects");
    aero.add("ceiling_scale", "relative change of K - 1 below surfaces", 0.9, &U::ceiling_scale);
    aero.add("ground_scale", "relative change of K - 1 above surfaces, and of a given map", 0.9, &U::ground_scale);
    Spreads offset(rows, "uncertainty.aero.scene_offset_m",
                   "where the surfaces are, from where they are believed to be");
    offset.add("x", "along the plane [m]", 10, &U::scene_x_m);
    offset.add("z", "upwards [m]", 10, &U::scene_z_m);

    Spreads vehicle(rows, "uncertainty.vehicle", "the vehicle, beside what its controller knows");
    vehicle.add("mass_scale", "relative change of the multirotor's mass", 0.9, &U::mass_scale);
    vehicle.add("inertia_scale", "relative change of both inertias", 0.9, &U::inertia_scale);
    vehicle.add("arm_mass_scale", "relative change of the arm's mass", 0.9, &U::arm_mass_scale);
    Spreads center(rows, "uncertainty.vehicle.com_offset_m", "where the multirotor's centre of mass is, in its frame");
    center.add("x", "forward [m]", 1, &U::center_of_mass_x_m);
    center.add("z", "upward [m]", 1, &U::center_of_mass_z_m);
    vehicle.add("thrust_scale", "relative change of the thrust of all rotors", 0.9, &U::thrust_scale);
    vehicle.add("rotor_thrust_scale", "the same of each rotor for itself", 0.9, &U::rotor_thrust_scale);
    vehicle.add_of_robot("rotor_time_constant_s", "lag of the rotors; sd around the robot's, range in s", 10,
                         &U::rotor_time_constant_s);
    vehicle.add_of_robot("delay_s", "age of what the controller sees; sd around the robot's, range in s", 0.3,
                         &U::delay_s);

    Spreads sensing(rows, "uncertainty.sensing", "what the controller sees instead of the state");
    sensing.add("position_bias_m", "constant error, along x and along z", 10, &U::position_bias_m);
    sensing.add("pitch_bias_deg", "constant error", 30, &U::pitch_bias_rad);
    sensing.add_noise("gyro_noise_rad_s", "error of the pitch rate, anew in every control tick", 10,
                      &U::gyro_noise_rad_s);
    sensing.add_noise("velocity_noise_m_s", "the same of the velocity", 10, &U::velocity_noise_m_s);
    sensing.add_noise("position_noise_m", "the same of the position", 10, &U::position_noise_m);

    Spreads wind(rows, "uncertainty.wind", "moving air; it acts through the drag of the robot");
    Spreads steady(rows, "uncertainty.wind.steady_m_s", "wind that does not change");
    steady.add("x", "along the plane [m/s]", 30, &U::wind_x_m_s);
    steady.add("z", "upwards [m/s]", 30, &U::wind_z_m_s);
    wind.add_noise("gust_m_s", "Dryden gusts along x and z", 30, &U::gust_m_s);
    rows.push_back(parameters::pair<Problem>(
                       "uncertainty.wind.gust_length_m", "length scales of the gusts; default: 3 m above ground",
                       {"x", "z"}, [](auto& p) -> auto& { return uncertainty_of(p).gust_length_x_m; },
                       [](auto& p) -> auto& { return uncertainty_of(p).gust_length_z_m; })
                       .at_least(0.1)
                       .at_most(1000));
}

}  // namespace downwash
