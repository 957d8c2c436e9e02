#include <algorithm>
#include <cmath>
#include <string_view>

#include "downwash/identification/identification.hpp"
#include "downwash/identification/sought_numbers.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

namespace downwash {
namespace {

/// The spread that stands for several numbers of one key, such as those of all rotors: with their mean, and as wide as
/// their own spreads and their differences together.
Spread spread_of(const std::vector<identification::Known>& numbers) {
    double mean = 0, variance = 0;
    const auto count = static_cast<double>(numbers.size());
    for (const identification::Known& number : numbers) {
        mean += number.mean / count;
    }
    for (const identification::Known& number : numbers) {
        variance += (std::pow(number.sd, 2) + std::pow(number.mean - mean, 2)) / count;
    }
    return Spread::of_sd(std::sqrt(variance), mean);
}

void learn_noise(const IdentifiedNoise& noise, Uncertainty& uncertainty) {
    if (noise.name == "sensing.position_noise_m") {
        uncertainty.position_noise_m = Spread::of_sd(noise.sd);
    } else if (noise.name == "sensing.velocity_noise_m_s") {
        uncertainty.velocity_noise_m_s = Spread::of_sd(noise.sd);
    } else if (noise.name == "sensing.gyro_noise_rad_s") {
        uncertainty.gyro_noise_rad_s = Spread::of_sd(noise.sd);
    }
}

}  // namespace

SpaceRobot learned_robot(const SpaceRobot& robot, const Identification& learned) {
    SpaceRobot after = robot;
    const Uncertainty before = robot.uncertainty.value_or(Uncertainty{});
    Uncertainty& uncertainty = after.uncertainty.emplace(before);
    const auto number_of = [&](std::string_view name) {
        return std::ranges::find_if(learned.numbers, [&](const auto& number) { return number.name == name; });
    };
    const std::vector<const SpaceWorldParameter*> parameters = space_world_parameters_of(robot);
    for (const UncertaintyKey& key : space_uncertainty_keys()) {
        std::vector<identification::Known> of_key;
        bool is_learned = false;
        for (const SpaceWorldParameter* parameter : parameters) {
            if (key.spread == nullptr || parameter->spread != key.spread) {
                continue;
            }
            const auto number = number_of(parameter->name);
            const bool is_own = number != learned.numbers.end() && number->is_learned;
            is_learned = is_learned || is_own;
            of_key.push_back(is_own ? identification::Known{number->value, number->sd}
                                    : identification::known_of(*parameter, before, robot));
        }
        if (is_learned) {
            uncertainty.*key.spread = spread_of(of_key);
        }
    }
    for (const IdentifiedNoise& noise : learned.noise) {
        learn_noise(noise, uncertainty);
    }
    const auto drag = number_of("multirotor.drag");
    if (drag != learned.numbers.end() && drag->is_learned) {
        after.plant.drag.linear_n_s_m *= 1 + drag->value;
        after.plant.drag.quadratic_n_s2_m2 *= 1 + drag->value;
    }
    return after;
}

}  // namespace downwash
