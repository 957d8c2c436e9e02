#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/in_space.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/simulation/hover_analysis.hpp"
#include "downwash/simulation/vehicle_effect.hpp"

namespace downwash::cli {
namespace {

struct HoldArguments {
    std::string problem;
    std::optional<double> arm_deg;
    std::vector<std::array<double, 2>> at;
    HoldInSpace in_space;
    bool as_json = false;
};

/// The answer for one point; everything but the place and the verdict may be missing.
struct HoldAnswer {
    double x_m, z_m;
    HoverAnalysis analysis;
    VehicleEffect effect;

    [[nodiscard]] bool is_defined() const { return analysis.verdict != HoldVerdict::not_flyable; }
    [[nodiscard]] bool has_trim() const { return analysis.verdict >= HoldVerdict::no_equilibrium; }
    [[nodiscard]] bool has_modes() const { return analysis.verdict >= HoldVerdict::unstable; }
};

Json trim_json(const HoverTrim& trim, int rotors) {
    const double* reference = trim.reference.position;
    Json commands = Json::array();
    for (int i = 0; i < rotors; ++i) {
        commands.push_back(trim.rotor_command_n[i]);
    }
    return {
        {"reference", {{"x_m", reference[0]}, {"z_m", reference[1]}, {"arm_deg", reference[2] * degrees_per_radian}}},
        {"pitch_reference_deg", trim.pitch_reference_rad * degrees_per_radian},
        {"rotor_commands_n", std::move(commands)},
        {"joint_torque_nm", trim.joint_torque_nm},
        {"saturation", trim.saturation}};
}

Json stability_json(const HoverStability& stability) {
    return {
        {"spectral_radius", stability.spectral_radius},         {"growth_rate_1_s", stability.growth_rate_1_s},
        {"frequency_rad_s", stability.frequency_rad_s},         {"growing_modes", stability.growing_modes},
        {"force_slope_n_m", stability.force_slope_n_m},         {"force_gain_n_m", stability.force_gain_n_m},
        {"torque_slope_nm_rad", stability.torque_slope_nm_rad}, {"torque_gain_nm_rad", stability.torque_gain_nm_rad}};
}

Json json_of_answer(const HoldAnswer& answer, int rotors) {
    Json point = {{"x_m", answer.x_m},
                  {"z_m", answer.z_m},
                  {"verdict", name_of(answer.analysis.verdict)},
                  {"limit", name_of(answer.analysis.trim.limit)},
                  {"effect", nullptr},
                  {"trim", nullptr},
                  {"stability", nullptr}};
    if (answer.is_defined()) {
        point["effect"] = {{"force_factor", answer.effect.force_factor},
                           {"pitch_torque_nm", answer.effect.pitch_torque_nm},
                           {"pitch_torque_factor", answer.effect.pitch_torque_factor}};
    }
    if (answer.has_trim()) {
        point["trim"] = trim_json(answer.analysis.trim, rotors);
    }
    if (answer.has_modes()) {
        point["stability"] = stability_json(answer.analysis.stability);
    }
    return point;
}

void print_table(const std::vector<HoldAnswer>& answers) {
    fmt::print("{:>9} {:>9}  {:<14} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "x_m", "z_m", "verdict", "force_K",
               "torque_nm", "ref_dz_m", "rate_1_s", "dF/dz_n_m", "gain_n_m");
    for (const HoldAnswer& answer : answers) {
        fmt::print("{:>9} {:>9}  {:<14}", to_text(answer.x_m), to_text(answer.z_m), name_of(answer.analysis.verdict));
        if (answer.is_defined()) {
            fmt::print(" {:>8.4f} {:>9.4f}", answer.effect.force_factor, answer.effect.pitch_torque_nm);
        }
        const HoverStability& stability = answer.analysis.stability;
        if (answer.has_modes()) {
            fmt::print(" {:>9.4f} {:>9.4f} {:>9.4f} {:>9.4f}", answer.analysis.trim.reference.position[1] - answer.z_m,
                       stability.growth_rate_1_s, stability.force_slope_n_m, stability.force_gain_n_m);
        } else if (answer.has_trim()) {
            fmt::print(" {}", name_of(answer.analysis.trim.limit));
        }
        fmt::print("\n");
    }
}

ExitCode run(const HoldArguments& given) {
    const HoldInSpace& space = given.in_space;
    if (is_space_problem_file(given.problem)) {
        if (!given.at.empty() || given.arm_deg) {
            throw UsageError(
                "--at and --arm-deg are for problems in a vertical plane: {} is one in space, expected "
                "--place and --joints-deg",
                given.problem);
        }
        HoldInSpace own = space;
        own.problem = given.problem;
        own.as_json = given.as_json;
        return hold_in_space(own);
    }
    if (!space.places.empty() || !space.from.empty() || !space.to.empty() || space.yaw_deg ||
        !space.joints_deg.empty()) {
        throw UsageError(
            "--place, --low, --high, --yaw-deg and --joints-deg are for problems in space: {} is none, "
            "expected --at and --arm-deg",
            given.problem);
    }
    if (given.at.empty()) {
        throw UsageError("--at is required");
    }
    for (const auto& [x_m, z_m] : given.at) {
        require_coordinate(x_m, "--at");
        require_coordinate(z_m, "--at");
    }
    const Problem problem = read_problem(given.problem, {}, print_outdated);
    const double arm_rad = arm_option(given.arm_deg, problem);
    const auto model = make_flight_model(problem);
    std::vector<HoldAnswer> answers;
    for (const auto& [x_m, z_m] : given.at) {
        answers.push_back({x_m, z_m, analyse_hover(*model, x_m, z_m, arm_rad),
                           vehicle_effect(*model, PlanarPose{x_m, z_m, 0, arm_rad})});
    }
    if (!given.as_json) {
        print_table(answers);
        return ExitCode::done;
    }
    auto points = Json::array();
    for (const HoldAnswer& answer : answers) {
        points.push_back(json_of_answer(answer, model->tick().plant.rotor_count));
    }
    print_json({{"arm_deg", given.arm_deg.value_or(arm_rad * degrees_per_radian)}, {"points", std::move(points)}});
    return ExitCode::done;
}

}  // namespace

void add_aeromap_hold(Command aeromap, Action& action) {
    auto [command, given] = add_command<HoldArguments>(
        aeromap, action, "hold",
        "Check whether the vehicle can hover at a point: rotor limits, saturation and stability of the closed loop",
        run);
    add_problem(command, given.problem);
    add_arm(command, given.arm_deg);
    add_points(command, given.at, "centre of mass in plane coordinates [m], within the bounds or not");
    HoldInSpace& space = given.in_space;
    command
        .add_option("--place X Y Z", space.places,
                    "a place of a problem in space; may be repeated; the multirotor's centre of mass [m]")
        .repeated();
    command.add_option("--low X Y Z", space.from, "lowest corner of a grid of places in space [m]").values(3);
    command.add_option("--high X Y Z", space.to, "its highest corner").values(3);
    command.add_option("--spacing M", space.step_m, "distance of its places").positive().shows_default();
    command.add_option("--yaw-deg A", space.yaw_deg, "yaw in space; default: that of the start");
    command
        .add_option("--joints-deg Q", space.joints_deg,
                    "angles of all joints of a robot in space; default: those of the start")
        .values(1, max_joints);
    add_threads(command, space.threads);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
