#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// What files of thrust stands say of a rotor, and what they have to be told.

namespace downwash {

/// What the files do not say, or not in words that are known.
struct ThrustStandSettings {
    std::vector<std::pair<std::string, std::string>> columns;  ///< a quantity ("thrust") and its column's name
    std::vector<std::pair<std::string, std::string>> units;    ///< a quantity and the unit of its column ("gf")
    std::optional<double> radius_m;                            ///< of the rotor; coefficients without unit need it
    double air_density_kg_m3 = 1.225;                          ///< where it was measured
    std::optional<double> hover_thrust_n;  ///< where the power coefficient counts; empty: over all thrusts
};

/// A column that was taken.
struct StandColumn {
    std::string quantity, name, unit;
};

/// A file and what was taken of it.
struct StandFile {
    std::string file;
    std::vector<StandColumn> columns;
    std::vector<std::string> others;  ///< columns that were not taken
    std::size_t rows = 0;
    std::size_t measurements = 0;  ///< steady ones: rows, or stretches of equal throttle in a log
};

/// A value with its 95 % interval (Student's t). Without an interval where one or two measurements give it.
struct StandEstimate {
    double value = 0;
    std::optional<double> low, high;
};

/// A standard deviation with its 95 % interval (chi-squared).
struct StandScatter {
    double sd = 0;
    double low = 0, high = 0;
    std::size_t freedom = 0;  ///< measurements less the means that were taken of them
};

/// The lag of thrust behind steps of the throttle.
struct StandLag {
    StandEstimate time_constant_s;  ///< the mean over the steps that are slower, up or down
    std::optional<StandScatter> scatter_s;
    std::size_t steps = 0;  ///< that it is the mean of
    bool is_of_rise = true;
    bool is_of_speed = false;  ///< from the square of the speed; else from the thrust
};

/// What a rotor amounts to on a thrust stand.
struct ThrustStand {
    std::vector<StandFile> files;
    double min_thrust_n = 0;                                ///< at the lowest throttle at which it turns
    double max_thrust_n = 0;                                ///< at the throttle with the greatest mean
    std::optional<StandEstimate> thrust_coefficient_n_s2;   ///< thrust over the square of the speed in rad/s
    std::optional<double> thrust_number;                    ///< C_T = T / (rho n^2 D^4), n in 1/s; of a known radius
    std::optional<StandEstimate> torque_ratio_m;            ///< torque over thrust
    std::optional<StandEstimate> power_coefficient_w_n1p5;  ///< power over thrust^1.5
    std::optional<std::pair<double, double>> power_range;   ///< least and greatest such ratio of a measurement
    /// Of the thrust of measurements at the same throttle, relative to their mean, over all throttles.
    std::optional<StandScatter> thrust_scatter;
    std::optional<StandLag> lag;
    std::vector<std::string> remarks;  ///< what was assumed, left out, or is likely not meant
};

}  // namespace downwash
