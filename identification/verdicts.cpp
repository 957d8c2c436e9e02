#include "downwash/identification/verdicts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string_view>

#include "downwash/base/text.hpp"

namespace downwash::identification {
namespace {

using Eigen::Index;

/// Why flights do not tell a number: they do not show it, or only together with others.
std::string reason_for(Index number, const SoughtNumbers& sought, const Information& information,
                       double learned_share) {
    const double needed = 1 / (learned_share * learned_share) - 1;
    if (information.fisher(number, number) < needed) {
        return "these flights hardly depend on it";
    }
    std::vector<std::pair<double, Index>> others;
    for (Index i = 0; i < sought.of_vehicle(); ++i) {
        if (i != number) {
            const double scale = std::sqrt(information.covariance(number, number) * information.covariance(i, i));
            others.emplace_back(std::abs(information.covariance(number, i)) / scale, i);
        }
    }
    std::ranges::sort(others, std::greater{});
    constexpr double with = 0.3;  // correlation
    std::vector<std::string> names;
    for (const auto& [correlation, i] : others) {
        if (names.empty() || (correlation > with && names.size() < 3)) {
            names.push_back(sought.name(i));
        }
    }
    return "these flights show it only together with " +
           joined(names, ", ", [](const std::string& name) { return name; });
}

void add_weak(const SoughtNumbers& sought, const Information& information, Identification& found) {
    const Index count = sought.of_vehicle();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information.fisher);
    constexpr double weak = 1;  // flights say less than was known before
    constexpr double shown = 0.2;
    for (Index i = 0; i < count && solver.eigenvalues()[i] < weak; ++i) {
        WeakDirection direction{std::max(0.0, solver.eigenvalues()[i]), {}};
        for (Index k = 0; k < count; ++k) {
            if (std::abs(solver.eigenvectors()(k, i)) > shown) {
                direction.shares.emplace_back(sought.name(k), solver.eigenvectors()(k, i));
            }
        }
        std::ranges::sort(direction.shares,
                          [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
        found.weak.push_back(std::move(direction));
    }
}

}  // namespace

void add_numbers(const SoughtNumbers& sought, const std::vector<double>& vehicle, const Information& information,
                 const IdentifySettings& settings, Identification& found) {
    for (Index i = 0; i < sought.of_vehicle() - sought.surface_effects(); ++i) {
        IdentifiedNumber number;
        const Known& known = sought.known(i);
        const double share = std::sqrt(information.covariance(i, i));
        number.name = sought.name(i);
        number.before = known.mean;
        number.before_sd = known.sd;
        number.value = sought.value(i, vehicle[static_cast<std::size_t>(i)]);
        number.sd = known.sd * share;
        number.is_learned = share <= settings.learned_share;
        if (!number.is_learned) {
            number.reason = reason_for(i, sought, information, settings.learned_share);
        }
        found.numbers.push_back(std::move(number));
    }
    add_weak(sought, information, found);
}

void add_ratios(const SoughtNumbers& sought, const SurfaceNodes& surface, const std::vector<double>& vehicle,
                const Information& information, Identification& found) {
    const Index first = sought.of_vehicle() - sought.surface_effects();
    for (Index k = 0; k < sought.surface_effects(); ++k) {
        const Index i = first + k;
        const auto node = static_cast<std::size_t>(k);
        const bool is_ceiling = !surface.ground_m || node >= surface.of_one();
        const double share = std::sqrt(information.covariance(i, i));
        constexpr double learned_share = 0.5;  // of what could be anything
        if (share < learned_share) {
            found.ratios.push_back({is_ceiling, surface.z_over_r[node % surface.of_one()],
                                    1 + sought.value(i, vehicle[static_cast<std::size_t>(i)]),
                                    sought.known(i).sd * share});
        }
    }
}

void add_wind(const SoughtNumbers& sought, const std::string& flight, const std::array<double, 3>& wind,
              std::size_t index, const Information& information, const IdentifySettings& settings,
              Identification& found) {
    IdentifiedWind identified{flight, {}, {}, true};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Index i = sought.of_vehicle() + static_cast<Index>(3 * index + axis);
        const double share = std::sqrt(information.covariance(i, i));
        const Known& known = sought.known_wind(static_cast<Index>(axis));
        identified.wind_m_s[axis] = known.mean + wind[axis] * known.sd;
        identified.sd_m_s[axis] = known.sd * share;
        identified.is_learned = identified.is_learned && (axis == 2 || share <= settings.learned_share);
    }
    found.winds.push_back(std::move(identified));
}

void add_noise(const PerChannel& variances, const PerChannel& counts, Identification& found) {
    constexpr std::array<std::string_view, channel_count> names{
        "sensing.position_noise_m",   "attitude [rad]",           "joints [rad]",
        "sensing.velocity_noise_m_s", "sensing.gyro_noise_rad_s", "joint rates [rad/s]"};
    for (std::size_t k = 0; k < channel_count; ++k) {
        if (counts[k] > 0) {
            const double sd = std::sqrt(variances[k]);
            found.noise.push_back({std::string(names[k]), sd, sd / std::sqrt(2 * counts[k])});
        }
    }
}

void add_left_out(const SpaceRobot& robot, bool sees, Identification& found) {
    found.left_out.emplace_back(
        "sensing.position_bias_m: a flight is the same wherever it is; only places that are known from outside tell "
        "it");
    if (!robot.plant.drag.is_any()) {
        found.left_out.emplace_back("multirotor.drag: the robot file has none that could be scaled");
    }
    if (!sees) {
        found.left_out.emplace_back(
            "sensing and vehicle.delay_s: the logs have the true motion, not what the controller saw");
    }
}

}  // namespace downwash::identification
