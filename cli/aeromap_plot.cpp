#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {
namespace {

/// One kind of picture of a problem, by the name that --what gives it.
struct FieldKind {
    std::string_view name;
    const char* description;
    MakeField* make;
};

constexpr std::array<FieldKind, 6> field_kinds{{
    {"factor", "thrust ratio K of a rotor", &factor_figure},
    {"ground", "the same from surfaces below alone", &factor_figure},
    {"ceiling", "the same from surfaces above alone", &factor_figure},
    {"force", "thrust ratio of the whole vehicle, level or at --pitch-deg", &force_figure},
    {"torque", "pitch torque on it in Nm", &torque_figure},
    {"hold", "where it can hover, with --arm-deg", &hold_figure},
}};

std::string kinds_text() {
    std::string text;
    for (const FieldKind& kind : field_kinds) {
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", kind.name, kind.description);
    }
    return text;
}

bool shows_problem(const PlotRequest& request) {
    return !request.problem.empty();
}
bool shows_vehicle(const PlotRequest& request) {
    return shows_problem(request) && (request.what == "force" || request.what == "torque");
}
bool shows_hover(const PlotRequest& request) {
    return shows_problem(request) && request.what == "hold";
}
bool shows_rotor(const PlotRequest& request) {
    return shows_problem(request) && !shows_vehicle(request) && !shows_hover(request);
}
bool shows_models(const PlotRequest& request) {
    return !request.models.empty();
}
bool shows_data(const PlotRequest& request) {
    return !request.data.empty();
}
bool shows_multirotor(const PlotRequest& request) {
    return std::any_of(request.models.begin(), request.models.end(),
                       [](const std::string& name) { return is_multirotor(model_named(name).model); });
}
bool has_distances(const PlotRequest& request) {
    return shows_models(request) || shows_data(request) || request.is_flow;
}

/// An option that only some pictures use.
struct OptionUse {
    const char* option;
    bool (*is_used)(const PlotRequest& request);
    const char* use;  ///< for people
};

constexpr std::array<OptionUse, 12> option_uses{{
    {"--what", shows_problem, "PROBLEM"},
    {"--rotor", shows_rotor, "PROBLEM and --what factor, ground or ceiling"},
    {"--lateral", shows_rotor, "PROBLEM and --what factor, ground or ceiling"},
    {"--arm-deg", shows_hover, "PROBLEM and --what hold"},
    {"--pitch-deg", shows_vehicle, "PROBLEM and --what force or torque"},
    {"--x", shows_problem, "PROBLEM"},
    {"--z", shows_problem, "PROBLEM"},
    {"--surface", shows_data, "--data"},
    {"--source", shows_data, "--data"},
    {"--max-factor", shows_models, "--model"},
    {"--rotor-spacing", shows_multirotor, "--model multirotor-images or multirotor-body"},
    {"--z-over-r", has_distances, "--model, --data or --flow"},
}};

/// A request with the command whose options gave it.
struct PlotArguments : PlotRequest {
    const CLI::App* command = nullptr;

    void add_to(CLI::App& plot);
    [[nodiscard]] ExitCode run() const;
};

void reject_useless_options(const PlotArguments& request) {
    for (const OptionUse& use : option_uses) {
        if (request.command->get_option(use.option)->count() > 0 && !use.is_used(request)) {
            throw UsageError(fmt::format("{} changes nothing in this picture: it goes with {}", use.option, use.use));
        }
    }
}

/// The shown part of one axis. @param usual without the option
AxisRange shown_range(const char* option, const std::vector<double>& given, const AxisRange& usual) {
    constexpr double max_m = 1e6;
    if (given.empty()) {
        return usual;
    }
    if (!(given[0] < given[1] && std::abs(given[0]) <= max_m && std::abs(given[1]) <= max_m)) {
        throw UsageError(fmt::format("{} {} {}: expected LOW below HIGH, in m, at most {} either way", option, given[0],
                                     given[1], max_m));
    }
    return {given[0], given[1]};
}

/// The reach of the vehicle's rotors and a margin.
Bounds shown_extent(const PlotRequest& request, const Problem& problem) {
    constexpr double margin = 0.04;  // of the longer side
    const Bounds rotors = rotor_extent(problem.robot.rotors, problem.bounds);
    const double margin_m = margin * std::max(rotors.x_high_m - rotors.x_low_m, rotors.z_high_m - rotors.z_low_m);
    const AxisRange x = shown_range("--x", request.x_m, {rotors.x_low_m - margin_m, rotors.x_high_m + margin_m});
    const AxisRange z = shown_range("--z", request.z_m, {rotors.z_low_m - margin_m, rotors.z_high_m + margin_m});
    return {x.low, x.high, z.low, z.high};
}

void require_sound_options(const PlotArguments& request) {
    const bool has_models = shows_models(request) || shows_data(request);
    if ((shows_problem(request) ? 1 : 0) + (has_models ? 1 : 0) + (request.is_flow ? 1 : 0) != 1) {
        throw UsageError(
            "aeromap plot needs one of PROBLEM, --model NAME... (with or without --data CSV), and --flow with "
            "--z-over-r H");
    }
    static_cast<void>(entry_named(field_kinds, request.what, "there is no --what"));
    reject_useless_options(request);
    if (!(std::abs(request.arm_deg) <= 1e5)) {
        throw UsageError(fmt::format("--arm-deg {}: expected degrees, at most 1e5 either way", request.arm_deg));
    }
    static_cast<void>(pitch_option(request.pitch_deg));
    if (request.lateral_m) {
        require_coordinate(*request.lateral_m, "--lateral");
    }
}

std::string picture(const PlotRequest& request, const PictureSettings& settings) {
    if (request.is_flow) {
        return draw(potential_flow_figure(request), settings);
    }
    if (!shows_problem(request)) {
        return draw(model_figure(request), settings);
    }
    const Problem problem = read_problem(request.problem);
    const FieldKind& kind = entry_named(field_kinds, request.what, "there is no --what");
    return draw(kind.make(request, problem, shown_extent(request, problem)), settings);
}

ExitCode PlotArguments::run() const {
    require_sound_options(*this);
    const PictureSettings settings{picture_format("--output", output), width_px.value_or(PictureSettings{}.width_px)};
    require_writable_result(output, "--output");
    write_result(output, picture(*this, settings), "--output");
    if (!is_quiet) {
        print_error(fmt::format("wrote {}\n", output));
    }
    return ExitCode::done;
}

void PlotArguments::add_to(CLI::App& plot) {
    command = &plot;
    plot.add_option("PROBLEM", problem, "problem file: draw a picture over its plane of motion");
    CLI::Option* kind = plot.add_option("--what", what, "what to show of a problem: " + kinds_text());
    offer_words(*kind->capture_default_str(), names_of(field_kinds));
    CLI::Option* one_rotor =
        plot.add_option("--rotor", rotor, "the rotor, counted from 1")->type_name("N")->capture_default_str();
    plot.add_option("--lateral", lateral_m,
                    "distance of its hub to the left of the plane of motion [m]; default: its own place")
        ->type_name("Y")
        ->excludes(one_rotor);
    plot.add_option("--arm-deg", arm_deg, "angle of the arm with --what hold")->type_name("A")->capture_default_str();
    plot.add_option("--pitch-deg", pitch_deg, "pitch of the vehicle with --what force or torque, positive nose down")
        ->type_name("P")
        ->capture_default_str();
    plot.add_option("--x", x_m, "shown part of the plane [m]; default: the reach of the rotors")
        ->expected(2)
        ->type_name("LOW HIGH");
    plot.add_option("--z", z_m, "the same for z")->expected(2)->type_name("LOW HIGH");
    CLI::Option* model = plot.add_option("--model", models, "curves of K over z/R, by names as in a problem file");
    offer_models(*model->type_name("NAME..."));
    plot.add_option("--data", data, "measurements to show with them: CSV as for `aeromap fit`")->type_name("CSV");
    CLI::Option* one_surface = plot.add_option("--surface", surface, "only measurements at this surface");
    offer_words(*one_surface->type_name("S"), measured_surfaces);
    plot.add_option("--source", source, "only measurements of this source")->type_name("NAME");
    plot.add_option("--max-factor", max_factor, "cap of the models; default 2")->type_name("K");
    plot.add_option("--rotor-spacing", rotor_spacing,
                    "multirotor models: spacing of adjacent axes of a square quadrotor in radii; default 2.5")
        ->type_name("D");
    plot.add_flag("--flow", is_flow, "the potential flow of a rotor and its image below the ground");
    plot.add_option("--z-over-r", z_over_r,
                    "shown range of curves (default 0 4), or the rotor's height with --flow [radii]")
        ->expected(1, 2)
        ->type_name("LOW HIGH");
    plot.add_option("-o,--output", output, "the picture, .svg, .png or .pdf")->required()->type_name("FILE");
    add_width(plot, width_px);
    add_quiet(plot, is_quiet);
}

}  // namespace

void add_aeromap_plot(CLI::App& aeromap, Action& action) {
    add_command<PlotArguments>(aeromap, action, "plot",
                               "Draw a problem's aero map, curves of models with measurements, or a rotor's potential "
                               "flow");
}

}  // namespace downwash::cli
