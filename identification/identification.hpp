#pragma once

#include <optional>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/identification/logged_flight.hpp"
#include "downwash/simulation/space_robot.hpp"
#include "downwash/simulation/uncertainty.hpp"

namespace downwash {

/// How to identify a vehicle.
struct IdentifySettings {
    /// What is not known of wind and gusts. Of the vehicle, the robot's own uncertainty counts, or the defaults.
    Uncertainty air;
    /// Standard deviation of the multirotor's drag over that of the robot file, less 1.
    double drag_sd = 0.3;
    /// A number counts as learned if its standard deviation is at most this share of what it was.
    double learned_share = 0.8;
    /// Heights of wide, level surfaces in the world [m], near which K is identified; empty: there is none.
    std::optional<double> ground_m, ceiling_m;
    /// What of each log is used at most [s].
    double max_length_s = 600;
};

/// What flights say of one number. Values are differences from the robot file, as in worlds.
struct IdentifiedNumber {
    std::string name;   ///< as of space_world_parameters(): "vehicle.rotor_thrust_scale 2"
    double before = 0;  ///< mean and standard deviation before
    double before_sd = 0;
    double value = 0;  ///< the most likely value, and the standard deviation of its error
    double sd = 0;
    bool is_learned = false;
    std::string reason;  ///< why it is not learned
};

/// K of one surface at a distance.
struct IdentifiedRatio {
    bool is_ceiling = false;
    double z_over_r = 0;
    double ratio = 1;
    double sd = 0;
};

/// The steady wind of a flight [m/s], world axes.
struct IdentifiedWind {
    std::string flight;
    Vector3 wind_m_s{}, sd_m_s{};
    bool is_learned = false;
};

/// Noise of what a vehicle sees, a standard deviation of each number.
struct IdentifiedNoise {
    std::string name;  ///< key below `uncertainty`, or "attitude [rad]"...
    double sd = 0;
    double sd_of_sd = 0;
};

/// A combination of numbers of which flights say little, by its share in each of them.
struct WeakDirection {
    double information = 0;  ///< variance before over that of the flights alone, of this combination
    std::vector<std::pair<std::string, double>> shares;  ///< the greatest ones, in standard deviations from before
};

/// What flights say of a vehicle.
struct Identification {
    std::vector<IdentifiedNumber> numbers;  ///< the last one of a robot with drag is "multirotor.drag"
    std::vector<IdentifiedRatio> ratios;
    std::vector<IdentifiedWind> winds;  ///< one for each flight
    std::vector<IdentifiedNoise> noise;
    std::vector<WeakDirection> weak;
    std::vector<std::string> left_out;  ///< what cannot be identified from such logs at all, with the reason
    double duration_s = 0;
    int iterations = 0;
    bool is_converged = false;
    double fit = 0;  ///< Mean square of the innovations over what the filter expects; 1 if model and noise are right.
};

/// Identifies a vehicle from flights. docs/identification.md says how.
/// @throws InputError if a flight is too short, or a number in it is not finite; if the robot has more joints than this
/// library was built for
/// @pre space_robot_errors(robot) is empty; the flights are of this robot
[[nodiscard]] DOWNWASH_EXPORT Identification identify(const SpaceRobot& robot, const std::vector<LoggedFlight>& flights,
                                                      const IdentifySettings& settings = {});

/// The robot with an uncertainty, and drag, that contain what was learned.
[[nodiscard]] DOWNWASH_EXPORT SpaceRobot learned_robot(const SpaceRobot& robot, const Identification& learned);

}  // namespace downwash
