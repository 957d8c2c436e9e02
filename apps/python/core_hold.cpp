#include <pybind11/stl.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::python {
namespace {

/// The answer for one point.
struct HoldAnswer {
    HoverAnalysis analysis;
    VehicleEffect effect;
};

NumberTable table_of(const std::vector<HoldAnswer>& answers, const Points& points) {
    NumberTable table;
    table.names = {"x_m",
                   "z_m",
                   "force_factor",
                   "pitch_torque_nm",
                   "pitch_torque_factor",
                   "reference_x_m",
                   "reference_z_m",
                   "reference_arm_deg",
                   "pitch_reference_deg",
                   "joint_torque_nm",
                   "saturation",
                   "spectral_radius",
                   "growth_rate_1_s",
                   "frequency_rad_s",
                   "growing_modes",
                   "force_slope_n_m",
                   "force_gain_n_m",
                   "torque_slope_nm_rad",
                   "torque_gain_nm_rad"};
    table.columns.resize(table.names.size());
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const HoverAnalysis& analysis = answers[i].analysis;
        const VehicleEffect& effect = answers[i].effect;
        const auto only = [&](HoldVerdict from, double number) { return analysis.verdict >= from ? number : NAN; };
        const auto shown = [&](double number) { return only(HoldVerdict::in_collision, number); };
        const auto trim = [&](double number) { return only(HoldVerdict::no_equilibrium, number); };
        const auto mode = [&](double number) { return only(HoldVerdict::unstable, number); };
        const HoverTrim& at = analysis.trim;
        const HoverStability& of = analysis.stability;
        const auto row = static_cast<py::ssize_t>(i);
        table.add_row({points.at(row, 0), points.at(row, 1), shown(effect.force_factor), shown(effect.pitch_torque_nm),
                       shown(effect.pitch_torque_factor), trim(at.reference.position[0]),
                       trim(at.reference.position[1]), trim(at.reference.position[2] * degrees_per_radian),
                       trim(at.pitch_reference_rad * degrees_per_radian), trim(at.joint_torque_nm), trim(at.saturation),
                       mode(of.spectral_radius), mode(of.growth_rate_1_s), mode(of.frequency_rad_s),
                       mode(of.growing_modes), mode(of.force_slope_n_m), mode(of.force_gain_n_m),
                       mode(of.torque_slope_nm_rad), mode(of.torque_gain_nm_rad)});
    }
    return table;
}

/// @throws InputError for what analyse_hover() does not take
void require_finite(const Points& points, std::size_t count, double arm_rad) {
    constexpr double farthest_m = 1e6;
    for (std::size_t i = 0; i < 2 * count; ++i) {
        if (!(std::abs(points.data()[i]) <= farthest_m)) {
            throw_input_error("has a coordinate that is not finite, or beyond 1e6 m", "points");
        }
    }
    if (!std::isfinite(arm_rad)) {
        throw_input_error("is not finite", "arm_deg");
    }
}

py::tuple hold(const CoreProblem& of, const Points& points, const std::optional<double>& arm_deg, int threads) {
    const FlightModel& model = *of.model();
    const std::size_t count = count_points(points, false);
    const double arm_rad = arm_deg ? *arm_deg / degrees_per_radian : of.problem().start.at[plane::arm];
    require_finite(points, count, arm_rad);
    const double* at = points.data();
    const std::vector<HoldAnswer> answers = interruptible(py::none(), [&](Attendance& attendance) {
        std::vector<HoldAnswer> found(count);
        run_parallel(count, thread_count(threads), [&, token = attendance.token()](std::size_t i) {
            if (!token.stop_requested()) {
                const double x_m = at[2 * i], z_m = at[2 * i + 1];
                found[i] = {analyse_hover(model, x_m, z_m, arm_rad), vehicle_effect(model, {x_m, z_m, 0, arm_rad})};
            }
        });
        return found;
    });
    py::list verdicts, limits;
    for (const HoldAnswer& answer : answers) {
        verdicts.append(name_of(answer.analysis.verdict));
        limits.append(name_of(answer.analysis.trim.limit));
    }
    return py::make_tuple(columns_of(table_of(answers, points)), verdicts, limits);
}

}  // namespace

void bind_hold(py::module_& module) {
    module.def("hold", hold);
}

}  // namespace downwash::python
