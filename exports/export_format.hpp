#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

/// The position of the world frame on the Earth.
struct GeodeticOrigin {
    double latitude_deg = 0;   ///< WGS 84, -90 to 90
    double longitude_deg = 0;  ///< -180 to 180
    double altitude_m = 0;     ///< height of z = 0 above mean sea level
    double bearing_deg = 0;    ///< compass direction of the x axis, clockwise from north, -360 to 360
};

/// Settings that a format may need besides the run.
struct ExportSettings {
    std::optional<double> rate_hz;  ///< rate of set-points; empty: the rate of the controller
    std::optional<GeodeticOrigin> origin;
};

/// One format.
struct ExportFormat {
    std::string_view name;
    std::string_view file_name;  ///< default name of its file in a run's folder
    std::string_view description;
    bool is_to_be_flown = false;  ///< commands for a vehicle
    bool has_rate = false;        ///< made of set-points at ExportSettings::rate_hz
    bool has_origin = false;      ///< needs ExportSettings::origin
    std::string (*write)(const RunRecord& run, const ExportSettings& settings);
};

/// All formats for a run.
[[nodiscard]] DOWNWASH_EXPORT std::span<const ExportFormat> export_formats();

/// A run as the bytes of a format. Equal runs give equal bytes.
/// @throws InputError if the run lacks what the format shows (plan, flight), or a setting is missing or out of range
[[nodiscard]] DOWNWASH_EXPORT std::string exported(const RunRecord& run, const ExportFormat& format,
                                                   const ExportSettings& settings);

}  // namespace downwash
