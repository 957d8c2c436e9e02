#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// Set-points further than this from the plan do not fit it [m]; angles [rad].
inline constexpr double max_setpoint_distance_m = 0.01;
inline constexpr double max_setpoint_distance_rad = 0.01;

/// How far the set-points of a file come from the plan in one respect, at most [m or rad].
struct SetpointDistance {
    std::string name;       ///< "position", "yaw", or a joint's: "joint_1"
    bool is_angle = false;  ///< in rad, not in m
    double itself = 0;
    std::optional<double> rate_integrated;          ///< by its velocity from the first set-point on, if the file has it
    std::optional<double> acceleration_integrated;  ///< by its acceleration, twice, over each second, likewise
};

/// What a check of a file of set-points found.
struct SetpointCheck {
    std::string_view format;  ///< its name in export_formats
    std::size_t count = 0;    ///< of set-points
    double duration_s = 0;    ///< from the first to the last
    bool has_arm = false;     ///< otherwise the arm was not checked
    std::vector<SetpointDistance> distances = {};
    std::vector<std::string> findings = {};  ///< what does not fit the plan: "px4.json:12:3: ..."

    [[nodiscard]] bool fits() const noexcept { return findings.empty(); }
};

/// Compares set-points in a file with the plan of a run: positions and angles as they are, velocities and accelerations
/// by what they integrate to. The first set-point is taken for the beginning of the plan.
/// @param text of a file in one of the formats csv, ros, px4, px4-csv and mavlink, which it shows itself
/// @param file named in messages   @param bearing_deg as it was exported with: see ExportSettings
/// @throws InputError with the place of every error if the text is no such file, is damaged, lacks numbers, or has
/// times that do not rise; if the run has no plan that others can fly
[[nodiscard]] DOWNWASH_EXPORT SetpointCheck check_setpoints(const RunRecord& run, std::string_view text,
                                                            const std::string& file, double bearing_deg = 0);
/// The same of a run in space.
[[nodiscard]] DOWNWASH_EXPORT SetpointCheck check_setpoints(const SpaceRunRecord& run, std::string_view text,
                                                            const std::string& file, double bearing_deg = 0);

}  // namespace downwash
