#pragma once

#include <span>
#include <string>
#include <string_view>

#include "downwash/base/export.hpp"
#include "downwash/exports/export_settings.hpp"
#include "downwash/results/run_record.hpp"

namespace downwash {

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
