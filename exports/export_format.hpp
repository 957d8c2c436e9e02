#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/problems/run_record.hpp"

namespace downwash {

/// Where the world frame lies on the Earth.
struct GeodeticOrigin {
    double latitude_deg = 0;   ///< WGS 84, -90 to 90
    double longitude_deg = 0;  ///< -180 to 180
    double altitude_m = 0;     ///< of z = 0, above the ellipsoid
    double bearing_deg = 0;    ///< compass direction of the x axis, clockwise from north, -360 to 360
};

/// What a format may need besides the run.
struct ExportSettings {
    std::optional<double> rate_hz;  ///< of set-points; empty: that of the controller
    std::optional<GeodeticOrigin> origin;
};

/// One format.
struct ExportFormat {
    std::string_view name;
    std::string_view extension;  ///< usual for its files, with the dot
    std::string_view description;
    std::string (*write)(const RunRecord& run, const ExportSettings& settings);
};

/// Every format that a run can be written in.
[[nodiscard]] DOWNWASH_EXPORT std::span<const ExportFormat> export_formats();

/// The bytes of a run in a format. Equal runs give equal bytes.
/// @throws InputError when the run has nothing of the kind (no plan, no flight), or settings are missing or out of
/// range
[[nodiscard]] DOWNWASH_EXPORT std::string exported(const RunRecord& run, const ExportFormat& format,
                                                   const ExportSettings& settings);

}  // namespace downwash
