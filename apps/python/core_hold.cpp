#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
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
#include "downwash/simulation/space_hover.hpp"
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

/// @throws InputError for what the analysis of a hover does not take
void require_places(const Points& points) {
    constexpr double farthest_m = 1e6;
    if (!std::all_of(points.data(), points.data() + points.size(),
                     [](double x) { return std::abs(x) <= farthest_m; })) {
        throw_input_error("has a coordinate that is not finite, or beyond 1e6 m", "points");
    }
}

void require_angle(double angle, const char* name) {
    if (!std::isfinite(angle)) {
        throw_input_error("is not finite", name);
    }
}

/// What analyse(i) gives for so many points, without the interpreter lock.
template <class Answer, class Analyse>
std::vector<Answer> analysed(std::size_t count, int threads, const Analyse& analyse) {
    return interruptible(py::none(), [&](Attendance& attendance) {
        std::vector<Answer> found(count);
        run_parallel(count, thread_count(threads), [&, token = attendance.token()](std::size_t i) {
            if (!token.stop_requested()) {
                found[i] = analyse(i);
            }
        });
        return found;
    });
}

py::tuple hold(const CoreProblem& of, const Points& points, const std::optional<double>& arm_deg, int threads) {
    const FlightModel& model = *of.model();
    const std::size_t count = count_points(points, Coordinates::plane);
    const double arm_rad = arm_deg ? *arm_deg / degrees_per_radian : of.problem().start.at[plane::arm];
    require_places(points);
    require_angle(arm_rad, "arm_deg");
    const double* at = points.data();
    const std::vector<HoldAnswer> answers = analysed<HoldAnswer>(count, threads, [&](std::size_t i) {
        const double x_m = at[2 * i], z_m = at[2 * i + 1];
        return HoldAnswer{analyse_hover(model, x_m, z_m, arm_rad), vehicle_effect(model, {x_m, z_m, 0, arm_rad})};
    });
    py::list verdicts, limits;
    for (const HoldAnswer& answer : answers) {
        verdicts.append(name_of(answer.analysis.verdict));
        limits.append(name_of(answer.analysis.trim.limit));
    }
    return py::make_tuple(columns_of(table_of(answers, points)), verdicts, limits);
}

/// Names of the joints' columns: "joint_1" and what follows.
void add_joints(std::vector<std::string>& names, int joints, const std::string& before, const std::string& after) {
    for (int i = 1; i <= joints; ++i) {
        names.push_back(std::string(before).append("joint_").append(std::to_string(i)).append(after));
    }
}

std::vector<std::string> names_in_space(const SpaceRobot& robot) {
    std::vector<std::string> names{
        "x_m", "y_m", "z_m", "reference_x_m", "reference_y_m", "reference_z_m", "reference_yaw_deg"};
    add_joints(names, robot.joints(), "reference_", "_deg");
    names.insert(names.end(), {"qw", "qx", "qy", "qz", "tilt_deg"});
    for (std::size_t i = 1; i <= robot.plant.rotors.size(); ++i) {
        names.push_back("rotor_" + std::to_string(i) + "_cmd_n");
    }
    add_joints(names, robot.joints(), "", "_torque_nm");
    names.insert(names.end(), {"saturation", "spectral_radius", "growth_rate_1_s", "frequency_rad_s", "growing_modes",
                               "force_slope_n_m", "force_gain_n_m", "roll_slope_nm_rad", "pitch_slope_nm_rad"});
    return names;
}

/// The numbers of a point, in the order of names_in_space(). What a verdict leaves undefined is NaN.
std::vector<double> row_in_space(const double* at_m, const SpaceHoverAnalysis& analysis, const SpaceRobot& robot) {
    const SpaceHoverTrim& trim = analysis.trim;
    const SpaceHoverStability& of = analysis.stability;
    std::vector<double> row(at_m, at_m + 3);
    const auto add = [&](HoldVerdict from, double number) { row.push_back(analysis.verdict >= from ? number : NAN); };
    const auto add_trim = [&](double number) { add(HoldVerdict::no_equilibrium, number); };
    for (int i = 0; i < space::first_joint + robot.joints(); ++i) {
        add_trim(trim.reference.position[i] * (i < space::yaw ? 1 : degrees_per_radian));
    }
    for (const double part : trim.motion.attitude) {
        add_trim(part);
    }
    add_trim(trim.tilt_rad * degrees_per_radian);
    for (std::size_t i = 0; i < robot.plant.rotors.size(); ++i) {
        add_trim(trim.rotor_command_n[i]);
    }
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        add_trim(trim.joint_torque_nm[i]);
    }
    add_trim(trim.saturation);
    for (const double number :
         {of.spectral_radius, of.growth_rate_1_s, of.frequency_rad_s, static_cast<double>(of.growing_modes),
          of.force_slope_n_m, of.force_gain_n_m, of.roll_slope_nm_rad, of.pitch_slope_nm_rad}) {
        add(HoldVerdict::unstable, number);
    }
    return row;
}

/// Yaw and joints of hovers, by default those of the start. @throws InputError
SpacePoint pose_of(const SpaceProblem& problem, const std::optional<double>& yaw_deg,
                   const std::optional<std::vector<double>>& joints_deg) {
    SpacePoint pose;
    pose.position[space::yaw] = yaw_deg ? *yaw_deg / degrees_per_radian : problem.start.yaw_rad;
    require_angle(pose.position[space::yaw], "yaw_deg");
    std::copy(problem.start.joints_rad.begin(), problem.start.joints_rad.end(), pose.position + space::first_joint);
    if (joints_deg) {
        if (joints_deg->size() != problem.robot.links.size()) {
            throw_input_error("has " + std::to_string(joints_deg->size()) + " numbers: expected one for each of the " +
                                  std::to_string(problem.robot.links.size()) + " joints",
                              "joints_deg");
        }
        for (std::size_t i = 0; i < joints_deg->size(); ++i) {
            require_angle((*joints_deg)[i], "joints_deg");
            pose.position[space::first_joint + i] = (*joints_deg)[i] / degrees_per_radian;
        }
    }
    return pose;
}

/// @return the columns, the verdicts, the limits and the loops that are slowest
py::tuple hold_in_space(const CoreSpaceProblem& of, const Points& points, const std::optional<double>& yaw_deg,
                        const std::optional<std::vector<double>>& joints_deg, int threads) {
    const SpaceProblem& problem = of.problem();
    const std::size_t count = count_points(points, Coordinates::world);
    require_places(points);
    const SpacePoint pose = pose_of(problem, yaw_deg, joints_deg);
    const SpaceHover hover(problem.robot, of.model()->shared_scene(), problem.aero);
    const double* at = points.data();
    const auto answers = analysed<SpaceHoverAnalysis>(count, threads, [&](std::size_t i) {
        SpacePoint place = pose;
        std::copy_n(at + 3 * i, 3, place.position);
        return hover.at(place);
    });
    NumberTable table;
    table.names = names_in_space(problem.robot);
    table.columns.resize(table.names.size());
    py::list verdicts, limits, loops;
    for (std::size_t i = 0; i < count; ++i) {
        const SpaceHoverAnalysis& analysis = answers[i];
        table.add_row(row_in_space(at + 3 * i, analysis, problem.robot));
        verdicts.append(name_of(analysis.verdict));
        limits.append(name_of(analysis.trim.limit));
        const bool has_modes = analysis.verdict >= HoldVerdict::unstable;
        loops.append(has_modes ? space_loop_name(analysis.stability.slowest_loop) : std::string());
    }
    return py::make_tuple(columns_of(std::move(table)), verdicts, limits, loops);
}

}  // namespace

void bind_hold(py::module_& module) {
    module.def("hold", hold);
    module.def("hold_in_space", hold_in_space);
}

}  // namespace downwash::python
