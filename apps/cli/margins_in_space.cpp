#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>

#include "downwash/base/angles.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/margins.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/robot_facts.hpp"
#include "downwash/simulation/space_hover.hpp"
#include "downwash/simulation/space_statics.hpp"

namespace downwash::cli {
namespace {

struct PoseMargins {
    ExaminedPose pose;
    SpaceLoopMargins margins;
};

std::vector<ExaminedPose> poses_of(const SpaceRobot& robot, const std::vector<double>& joints_deg) {
    if (joints_deg.empty()) {
        return examined_poses(robot);
    }
    return {{"given", joints_option(joints_deg, robot, {})}};
}

std::vector<PoseMargins> margins_of(const SpaceRobot& robot, const std::vector<ExaminedPose>& poses) {
    std::vector<PoseMargins> all;
    all.reserve(poses.size());
    for (const ExaminedPose& pose : poses) {
        all.push_back({pose, space_loop_margins(robot, pose.joints_rad)});
    }
    return all;
}

std::string text_of_margin_in_space(double value, const char* unit) {
    return std::isfinite(value) ? fmt::format("{:.1f} {}", value, unit) : "-";
}

/// The table of margins. @param before stands before each line
std::string table_of(const std::vector<PoseMargins>& all, const std::string& before) {
    std::string text = fmt::format("{}{:<7}{:<10}{:>12}{:>14}{:>16}{:>14}{:>14}\n", before, "arm", "loop",
                                   "gain margin", "phase margin", "crossover", "delay margin", "bandwidth");
    for (const PoseMargins& one : all) {
        for (std::size_t i = 0; i < one.margins.loops.size(); ++i) {
            const LoopMargins& margins = one.margins.loops[i];
            text +=
                fmt::format("{}{:<7}{:<10}{:>12}{:>14}{:>16}{:>14}{:>14}{}\n", before, one.pose.name,
                            space_loop_name(static_cast<int>(i)), text_of_margin_in_space(margins.gain_margin_db, "dB"),
                            text_of_margin_in_space(margins.phase_margin_rad * degrees_per_radian, "deg"),
                            text_of_margin_in_space(margins.crossover_rad_s, "rad/s"),
                            text_of_margin_in_space(1e3 * margins.delay_margin_s, "ms"),
                            text_of_margin_in_space(margins.bandwidth_rad_s, "rad/s"),
                            has_enough(margins) ? "" : "  below 6 dB or 45 deg");
        }
    }
    for (const PoseMargins& one : all) {
        const SpaceHoverStability& stability = one.margins.stability;
        text +=
            fmt::format("{}{}{}: the slowest disturbance shows in {} and decays at {:.3f} 1/s\n", before, one.pose.name,
                        one.pose.joints_rad.empty() ? "" : ", joints " + joints_text(one.pose.joints_rad) + " deg",
                        space_loop_name(stability.slowest_loop), -stability.growth_rate_1_s);
    }
    return text;
}

Json degrees_of(const std::vector<double>& joints_rad) {
    Json degrees = Json::array();
    for (const double rad : joints_rad) {
        degrees.push_back(rad * degrees_per_radian);
    }
    return degrees;
}

/// "margins" and "stability" of a document.
void add_json(const std::vector<PoseMargins>& all, Json& document) {
    auto rows = Json::array();
    auto stabilities = Json::array();
    for (const PoseMargins& one : all) {
        for (std::size_t i = 0; i < one.margins.loops.size(); ++i) {
            const LoopMargins& margins = one.margins.loops[i];
            rows.push_back({{"arm", one.pose.name},
                            {"loop", space_loop_name(static_cast<int>(i))},
                            {"gain_margin_db", finite(margins.gain_margin_db)},
                            {"phase_margin_deg", finite(margins.phase_margin_rad * degrees_per_radian)},
                            {"crossover_rad_s", finite(margins.crossover_rad_s)},
                            {"delay_margin_s", finite(margins.delay_margin_s)},
                            {"bandwidth_rad_s", finite(margins.bandwidth_rad_s)},
                            {"is_enough", has_enough(margins)}});
        }
        const SpaceHoverStability& stability = one.margins.stability;
        stabilities.push_back({{"arm", one.pose.name},
                               {"joints_deg", degrees_of(one.pose.joints_rad)},
                               {"spectral_radius", stability.spectral_radius},
                               {"growth_rate_1_s", stability.growth_rate_1_s},
                               {"frequency_rad_s", stability.frequency_rad_s},
                               {"slowest_loop", space_loop_name(stability.slowest_loop)}});
    }
    document["margins"] = std::move(rows);
    document["stability"] = std::move(stabilities);
}

/// The same figures of a planar robot, as a comment.
std::string planar_table(const Robot& robot, const std::string& before) {
    std::string text = fmt::format("{}{:<7}{:<15}{:>12}{:>14}\n", before, "arm", "loop", "gain margin", "phase margin");
    for (const double arm_rad : examined_arm_angles_rad(robot.arm)) {
        const auto all = loop_margins(robot, arm_rad);
        for (const LoopInput input : all_loop_inputs) {
            const LoopMargins& margins = all[static_cast<std::size_t>(input)];
            text += fmt::format("{}{:<7}{:<15}{:>12}{:>14}{}\n", before, arm_name(arm_rad), name_of(input),
                                text_of_margin_in_space(margins.gain_margin_db, "dB"),
                                text_of_margin_in_space(margins.phase_margin_rad * degrees_per_radian, "deg"),
                                has_enough(margins) ? "" : "  below 6 dB or 45 deg");
        }
    }
    return text;
}

/// The keys and values of a section in YAML, one value a line, as JSON.
Json json_of_section(const std::string& yaml) {
    Json root = Json::object();
    std::vector<Json*> levels{&root};
    std::istringstream lines(yaml);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t indent = line.find_first_not_of(' ');
        const std::size_t colon = line.find(':');
        levels.resize(indent / 2 + 1);
        Json& value = (*levels.back())[line.substr(indent, colon - indent)];
        if (colon + 1 == line.size()) {
            value = Json::object();
            levels.push_back(&value);
        } else {
            const std::string text = line.substr(colon + 2);
            value = Json::parse(text, nullptr, false);
            if (value.is_discarded()) {
                value = text;
            }
        }
    }
    return root;
}

}  // namespace

std::vector<double> joints_option(const std::vector<double>& joints_deg, const SpaceRobot& robot,
                                  const std::vector<double>& otherwise) {
    if (joints_deg.empty()) {
        return otherwise;
    }
    if (joints_deg.size() != robot.links.size()) {
        throw UsageError("--joints-deg has {} angles: expected {}, one for each joint", joints_deg.size(),
                         robot.links.size());
    }
    std::vector<double> joints_rad;
    for (std::size_t i = 0; i < joints_deg.size(); ++i) {
        constexpr double max_deg = 3600;
        const double rad = joints_deg[i] / degrees_per_radian;
        constexpr double tolerance_rad = 1e-9;
        const SpaceLinkLimits& link = robot.links[i];
        const bool is_beyond = link.is_limited && (rad < link.lower_limit_rad - tolerance_rad ||
                                                   rad > link.upper_limit_rad + tolerance_rad);
        if (!(std::abs(joints_deg[i]) <= max_deg)) {
            throw UsageError("--joints-deg {}: expected angles of at most {} degrees", joints_deg[i], max_deg);
        }
        if (is_beyond) {
            throw UsageError("--joints-deg {}: beyond the limits of joint {}, expected {:.6g} to {:.6g} degrees",
                             joints_deg[i], i + 1, link.lower_limit_rad * degrees_per_radian,
                             link.upper_limit_rad * degrees_per_radian);
        }
        joints_rad.push_back(rad);
    }
    return joints_rad;
}

ExitCode margins_in_space(const std::string& file, const std::vector<double>& joints_deg, bool as_json) {
    const SpaceRobot robot = read_space_robot(file);
    const auto all = margins_of(robot, poses_of(robot, joints_deg));
    if (as_json) {
        Json document = {{"robot", robot.name}};
        add_json(all, document);
        print_json(document);
        return ExitCode::done;
    }
    fmt::print("{}: margins of the sampled loop at hover in free air, opened at one place at a time\n\n{}", robot.name,
               table_of(all, ""));
    return ExitCode::done;
}

ExitCode design_gains(const Design& given) {
    const AnyRobot robot = read_robot_for_design(given.robot, given.bandwidths, given.law);
    const std::string section = controller_yaml(robot);
    const std::string name = std::visit([](const auto& any) { return any.name; }, robot);
    Json document = {{"robot", name}};
    document.update(json_of_section(section));
    std::string margins;
    try {
        if (const auto* in_space = std::get_if<SpaceRobot>(&robot)) {
            const auto all = margins_of(*in_space, examined_poses(*in_space));
            margins = table_of(all, "# ");
            add_json(all, document);
        } else {
            margins = planar_table(std::get<Robot>(robot), "# ");
        }
    } catch (const InputError& error) {  // what the gains come to is for the reader to judge
        margins = fmt::format("# {}\n", error.what());
        document["margins"] = nullptr;
    }
    if (given.as_json) {
        print_json(document);
        return ExitCode::done;
    }
    fmt::print("{}# {}: margins with these gains at hover in free air\n{}", section, name, margins);
    return ExitCode::done;
}

}  // namespace downwash::cli
