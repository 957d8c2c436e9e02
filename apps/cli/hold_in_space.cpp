#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/space_hold_map.hpp"

namespace downwash::cli {
namespace {

Json degrees_of(const double* joints_rad, int joints) {
    Json degrees = Json::array();
    for (int i = 0; i < joints; ++i) {
        degrees.push_back(joints_rad[i] * degrees_per_radian);
    }
    return degrees;
}

template <class Numbers>
Json numbers_of(const Numbers& numbers, std::size_t count) {
    Json list = Json::array();
    for (std::size_t i = 0; i < count; ++i) {
        list.push_back(numbers[i]);
    }
    return list;
}

Json trim_json(const SpaceHoverTrim& trim, const SpaceRobot& robot) {
    const double* reference = trim.reference.position;
    const int joints = robot.joints();
    return {{"reference",
             {{"x_m", reference[space::x]},
              {"y_m", reference[space::y]},
              {"z_m", reference[space::z]},
              {"yaw_deg", reference[space::yaw] * degrees_per_radian},
              {"joints_deg", degrees_of(reference + space::first_joint, joints)}}},
            {"attitude", numbers_of(trim.motion.attitude, 4)},
            {"tilt_deg", trim.tilt_rad * degrees_per_radian},
            {"rotor_commands_n", numbers_of(trim.rotor_command_n, robot.plant.rotors.size())},
            {"joint_torques_nm", numbers_of(trim.joint_torque_nm, robot.links.size())},
            {"saturation", trim.saturation}};
}

Json stability_json(const SpaceHoverStability& stability) {
    return {{"spectral_radius", finite(stability.spectral_radius)},
            {"growth_rate_1_s", finite(stability.growth_rate_1_s)},
            {"frequency_rad_s", stability.frequency_rad_s},
            {"growing_modes", stability.growing_modes},
            {"slowest_loop", space_loop_name(stability.slowest_loop)},
            {"force_slope_n_m", stability.force_slope_n_m},
            {"force_gain_n_m", stability.force_gain_n_m},
            {"roll_slope_nm_rad", stability.roll_slope_nm_rad},
            {"pitch_slope_nm_rad", stability.pitch_slope_nm_rad}};
}

Json json_of_place(const Vector3& at_m, const SpaceHoverAnalysis& analysis, const SpaceRobot& robot) {
    Json point = {{"x_m", at_m[0]},
                  {"y_m", at_m[1]},
                  {"z_m", at_m[2]},
                  {"verdict", name_of(analysis.verdict)},
                  {"limit", name_of(analysis.trim.limit)},
                  {"trim", nullptr},
                  {"stability", nullptr}};
    if (analysis.verdict >= HoldVerdict::no_equilibrium) {
        point["trim"] = trim_json(analysis.trim, robot);
    }
    if (analysis.verdict >= HoldVerdict::unstable) {
        point["stability"] = stability_json(analysis.stability);
    }
    return point;
}

Json json_of_place(const SpaceHoldMap& map, std::size_t i) {
    const SpaceHoldNode& node = map.all[i];
    const Vector3 at_m = map.place_m(i);
    const bool has_trim = node.verdict >= HoldVerdict::no_equilibrium;
    const bool has_modes = node.verdict >= HoldVerdict::unstable;
    return {{"x_m", at_m[0]},
            {"y_m", at_m[1]},
            {"z_m", at_m[2]},
            {"verdict", name_of(node.verdict)},
            {"limit", name_of(node.limit)},
            {"growth_rate_1_s", finite(node.growth_rate_1_s)},
            {"frequency_rad_s", finite(node.frequency_rad_s)},
            {"slowest_loop", has_modes ? Json(space_loop_name(node.slowest_loop)) : Json()},
            {"tilt_deg", has_trim ? Json(node.tilt_rad * degrees_per_radian) : Json()},
            {"saturation", has_trim ? Json(node.saturation) : Json()}};
}

void print_heading() {
    fmt::print("{:>9} {:>9} {:>9}  {:<14} {:>9} {:>9} {:<9} {:>9} {:>10}\n", "x_m", "y_m", "z_m", "verdict", "rate_1_s",
               "freq_1_s", "in", "tilt_deg", "saturation");
}

void print_row(const Vector3& at_m, const SpaceHoldNode& node) {
    fmt::print("{:>9} {:>9} {:>9}  {:<14}", to_text(at_m[0], 6), to_text(at_m[1], 6), to_text(at_m[2], 6),
               name_of(node.verdict));
    if (node.verdict >= HoldVerdict::unstable) {
        fmt::print(" {:>9.4f} {:>9.4f} {:<9} {:>9.3f} {:>10.3f}", node.growth_rate_1_s, node.frequency_rad_s,
                   space_loop_name(node.slowest_loop), node.tilt_rad * degrees_per_radian, node.saturation);
    } else if (node.verdict == HoldVerdict::no_equilibrium) {
        fmt::print(" {}", name_of(node.limit));
    }
    fmt::print("\n");
}

/// The yaw and the joints of a hover. @throws UsageError
SpacePoint pose_of(const HoldInSpace& given, const SpaceProblem& problem) {
    constexpr double max_deg = 3600;
    if (given.yaw_deg && !(std::abs(*given.yaw_deg) <= max_deg)) {
        throw UsageError("--yaw-deg {}: expected an angle of at most {} degrees", *given.yaw_deg, max_deg);
    }
    std::vector<double> start_rad = problem.start.joints_rad;
    start_rad.resize(problem.robot.links.size());
    const std::vector<double> joints_rad = joints_option(given.joints_deg, problem.robot, start_rad);
    SpacePoint pose;
    pose.position[space::yaw] = given.yaw_deg ? *given.yaw_deg / degrees_per_radian : problem.start.yaw_rad;
    std::copy(joints_rad.begin(), joints_rad.end(), pose.position + space::first_joint);
    return pose;
}

void require_place(const std::vector<double>& at_m, const std::string& where) {
    for (const double coordinate_m : at_m) {
        require_coordinate(coordinate_m, where);
    }
}

Vector3 vector_of(const std::vector<double>& at_m) {
    return {at_m[0], at_m[1], at_m[2]};
}

}  // namespace

ExitCode hold_in_space(const HoldInSpace& given) {
    const bool has_grid = !given.from.empty() && !given.to.empty();
    if (given.from.empty() != given.to.empty()) {
        throw UsageError("--low and --high are the two ends of a grid: expected both");
    }
    if (given.places.empty() == !has_grid) {
        throw UsageError("a problem in space needs places: expected --place X Y Z, or a grid --low X Y Z --high X Y Z");
    }
    for (const auto& place : given.places) {
        require_place({place.begin(), place.end()}, "--place");
    }
    require_place(given.from, "--low");
    require_place(given.to, "--high");
    const SpaceProblem problem = read_space_problem(given.problem, {}, print_outdated);
    const SpacePoint pose = pose_of(given, problem);
    const SpaceHover hover(problem.robot, std::make_shared<const Scene>(problem.obstacles), problem.aero);
    std::optional<SpaceHoldMap> map;
    if (has_grid) {
        map = make_space_hold_map(hover, vector_of(given.from), vector_of(given.to), given.step_m, pose, given.threads);
    }
    auto points = Json::array();
    if (!given.as_json) {
        print_heading();
    }
    for (std::size_t i = 0; map && i < map->all.size(); ++i) {
        if (given.as_json) {
            points.push_back(json_of_place(*map, i));
        } else {
            print_row(map->place_m(i), map->all[i]);
        }
    }
    for (const auto& place : given.places) {
        SpacePoint at = pose;
        std::copy(place.begin(), place.end(), at.position);
        const SpaceHoverAnalysis analysis = hover.at(at);
        if (given.as_json) {
            points.push_back(json_of_place(Vector3{place[0], place[1], place[2]}, analysis, problem.robot));
        } else {
            print_row({place[0], place[1], place[2]}, node_of(analysis));
        }
    }
    if (given.as_json) {
        print_json({{"yaw_deg", pose.position[space::yaw] * degrees_per_radian},
                    {"joints_deg", degrees_of(pose.position + space::first_joint, problem.robot.joints())},
                    {"points", std::move(points)}});
    }
    return ExitCode::done;
}

}  // namespace downwash::cli
