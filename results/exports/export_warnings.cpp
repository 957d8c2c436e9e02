#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/export_format.hpp"
#include "downwash/exports/formats.hpp"

namespace downwash {
namespace {

bool has_certificate(const RunInWorld& run) {
    const auto solution = nlohmann::json::parse(run.solution_text, nullptr, false);
    if (!solution.is_object() || !solution.contains("certificate")) {
        return false;
    }
    const auto& certificate = solution["certificate"];
    return certificate.is_object() && certificate.value("given", false);
}

/// By how much the joint of the arm that moves most moves in the flight.
double arm_range_rad(const RunInWorld& run) {
    double range_rad = 0;
    for (const JointInWorld& joint : run.joints) {
        const std::vector<double>* angles = run.flight.find(joint.axis.position);
        if (angles != nullptr && !angles->empty()) {
            const auto [low, high] = std::ranges::minmax_element(*angles);
            range_rad = std::max(range_rad, *high - *low);
        }
    }
    return range_rad;
}

/// Infinite without obstacles.
double least_clearance_m(const RunInWorld& run) {
    double least_m = INFINITY;
    if (const std::vector<double>* clearances_m = run.flight.find("clearance_m")) {
        for (const double clearance_m : *clearances_m) {
            least_m = clearance_m < least_m ? clearance_m : least_m;  // NaN without obstacles
        }
    }
    return least_m;
}

std::vector<std::string> warnings_of(const RunInWorld& run, const ExportFormat& format) {
    constexpr double small_arm_range_rad = 5 / degrees_per_radian;
    std::vector<std::string> warnings;
    const bool is_mission = format.has_origin;
    if (const double clearance_m = least_clearance_m(run); is_mission && clearance_m < acceptance_radius_m) {
        warnings.push_back(
            "the plan passes obstacles at " + to_text(clearance_m, 2) + " m, but an autopilot may cut corners by " +
            to_text(acceptance_radius_m) +
            " m, the acceptance radius of a waypoint: plan with a larger --margin, or fly the set-points "
            "of `--format csv` or `ros`");
    }
    if (const double range_rad = arm_range_rad(run); format.leaves_out_arm && range_rad > small_arm_range_rad) {
        warnings.push_back("the plan moves the arm by " + to_fixed_text(range_rad * degrees_per_radian, 0) +
                           " degrees, and " + (is_mission ? "a mission has" : "these messages have") +
                           " no arm: `--format csv` and `ros` have");
    }
    if (is_mission && !has_certificate(run)) {
        warnings.push_back(
            "the plan has no certificate: it was checked in the nominal world alone; plan with an "
            "`uncertainty:`, or see `downwash validate --runs`");
    }
    return warnings;
}

}  // namespace

std::vector<std::string> export_warnings(const RunRecord& run, const ExportFormat& format) {
    return warnings_of(in_world(run), format);
}

std::vector<std::string> export_warnings(const SpaceRunRecord& run, const ExportFormat& format) {
    return warnings_of(in_world(run), format);
}

}  // namespace downwash
