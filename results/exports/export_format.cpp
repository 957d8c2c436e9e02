#include "downwash/exports/export_format.hpp"

#include <algorithm>
#include <array>

#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

/// The writers of export_formats, in the same order.
constexpr std::array writers{setpoint_csv, ros_trajectory, px4_setpoints, px4_csv,    mavlink_log,
                             qgc_plan,     vtk_flight,     vtk_scene,     gltf_binary};
static_assert(writers.size() == export_formats.size());

std::string written(const RunInWorld& run, const ExportFormat& format, const ExportSettings& settings) {
    const auto named = [&](const ExportFormat& one) { return one.name == format.name; };
    const auto place = std::find_if(export_formats.begin(), export_formats.end(), named) - export_formats.begin();
    return writers.at(static_cast<std::size_t>(place))(run, settings);
}

}  // namespace

std::string exported(const RunRecord& run, const ExportFormat& format, const ExportSettings& settings) {
    return written(in_world(run), format, settings);
}

std::string exported(const SpaceRunRecord& run, const ExportFormat& format, const ExportSettings& settings) {
    return written(in_world(run), format, settings);
}

}  // namespace downwash
