#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "downwash/identification/identification.hpp"
#include "downwash/identification/surface_nodes.hpp"
#include "downwash/identification/trial.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

// Private to identification/.

namespace downwash::identification {

/// Mean and standard deviation of a spread's differences from the nominal value.
struct Known {
    double mean = 0, sd = 0;
};
[[nodiscard]] Known known_of(const SpaceWorldParameter& parameter, const Uncertainty& uncertainty,
                             const SpaceRobot& robot);

/// The numbers that are sought: those of the vehicle, which all flights share, and three of the wind for each flight.
/// They are vectors in standard deviations from what was known before.
class SoughtNumbers {
 public:
    SoughtNumbers(const SpaceRobot& robot, const IdentifySettings& settings, const SurfaceNodes& surface);

    [[nodiscard]] Eigen::Index of_vehicle() const noexcept { return static_cast<Eigen::Index>(known_.size()); }
    [[nodiscard]] static constexpr Eigen::Index of_wind() noexcept { return 3; }
    [[nodiscard]] const std::string& name(Eigen::Index i) const { return names_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const Known& known(Eigen::Index i) const { return known_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const Known& known_wind(Eigen::Index axis) const { return wind_[static_cast<std::size_t>(axis)]; }
    /// Bounds of a number, in standard deviations.
    [[nodiscard]] double least(Eigen::Index i) const { return least_[static_cast<std::size_t>(i)]; }
    /// How many of the vehicle's numbers are K - 1 near surfaces; they are the last ones.
    [[nodiscard]] Eigen::Index surface_effects() const noexcept { return surface_effects_; }
    [[nodiscard]] double value(Eigen::Index i, double deviations) const {
        return known(i).mean + deviations * known(i).sd;
    }

    /// The vehicle with given numbers. @param vehicle,wind in standard deviations
    [[nodiscard]] Trial trial(const double* vehicle, const double* wind) const;

 private:
    void add(const std::string& name, const Known& known, double least = -10);

    const SpaceRobot& robot_;
    std::vector<const SpaceWorldParameter*> parameters_;  ///< the first numbers
    std::vector<std::string> names_;
    std::vector<Known> known_;
    std::vector<double> least_;
    std::array<Known, 3> wind_;
    bool has_drag_ = false;
    Eigen::Index surface_effects_ = 0;
};

}  // namespace downwash::identification
