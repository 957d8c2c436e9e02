#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
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
    return joined(field_kinds, ", ",
                  [](const FieldKind& kind) { return fmt::format("{} ({})", kind.name, kind.description); });
}

/// What a request asks to show.
struct Shown {
    explicit Shown(const PlotRequest& request)
        : problem(!request.problem.empty()),
          vehicle(problem && (request.what == "force" || request.what == "torque")),
          hover(problem && request.what == "hold"),
          rotor(problem && !vehicle && !hover),
          models(!request.models.empty()),
          data(!request.data.empty()),
          curves(models || data),
          distances(curves || request.is_flow),
          multirotor(std::any_of(request.models.begin(), request.models.end(),
                                 [](const std::string& name) { return is_multirotor(model_named(name).model); })) {}

    bool problem, vehicle, hover, rotor, models, data, curves, distances, multirotor;
};

/// An option that only some pictures use.
struct OptionUse {
    const char* option;
    bool Shown::*is_used;
    const char* use;  ///< for people
};

constexpr std::array<OptionUse, 14> option_uses{{
    {"--what", &Shown::problem, "PROBLEM"},
    {"--rotor", &Shown::rotor, "PROBLEM and --what factor, ground or ceiling"},
    {"--lateral", &Shown::rotor, "PROBLEM and --what factor, ground or ceiling"},
    {"--arm-deg", &Shown::hover, "PROBLEM and --what hold"},
    {"--pitch-deg", &Shown::vehicle, "PROBLEM and --what force or torque"},
    {"--x", &Shown::problem, "PROBLEM"},
    {"--z", &Shown::problem, "PROBLEM"},
    {"--no-labels", &Shown::problem, "PROBLEM"},
    {"--surface", &Shown::data, "--data"},
    {"--source", &Shown::data, "--data"},
    {"--max-factor", &Shown::models, "--model"},
    {"--rotor-spacing", &Shown::multirotor, "--model multirotor-images or multirotor-body"},
    {"--tilt-deg", &Shown::curves, "--model or --data"},
    {"--z-over-r", &Shown::distances, "--model, --data or --flow"},
}};

/// A request with the command whose options gave it.
struct PlotArguments : PlotRequest {
    Command command;
};

void reject_useless_options(const PlotArguments& request) {
    const Shown shown(request);
    for (const OptionUse& use : option_uses) {
        if (request.command.option(use.option).is_given() && !(shown.*use.is_used)) {
            throw UsageError("{} changes nothing in this picture: it goes with {}", use.option, use.use);
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
        throw UsageError("{} {} {}: expected LOW below HIGH, in m, at most {} either way", option, given[0], given[1],
                         max_m);
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
    const bool has_models = !request.models.empty() || !request.data.empty();
    if ((request.problem.empty() ? 0 : 1) + (has_models ? 1 : 0) + (request.is_flow ? 1 : 0) != 1) {
        throw UsageError(
            "aeromap plot needs one of PROBLEM, --model NAME... (with or without --data CSV), and --flow with "
            "--z-over-r H");
    }
    static_cast<void>(entry_named(field_kinds, request.what, "--what"));
    reject_useless_options(request);
    static_cast<void>(pitch_option(request.pitch_deg));
    if (request.lateral_m) {
        require_coordinate(*request.lateral_m, "--lateral");
    }
}

std::string picture(const PlotRequest& request, const PictureSettings& settings) {
    if (request.is_flow) {
        return draw(potential_flow_figure(request), settings);
    }
    if (request.problem.empty()) {
        return draw(model_figure(request), settings);
    }
    const Problem problem = read_problem(request.problem, {}, print_outdated);
    const FieldKind& kind = entry_named(field_kinds, request.what, "--what");
    FieldFigure figure = kind.make(request, problem, shown_extent(request, problem));
    figure.has_names = !request.no_labels;
    return draw(figure, settings);
}

ExitCode run(const PlotArguments& given) {
    require_sound_options(given);
    const PictureSettings settings{picture_format("--out", given.output),
                                   given.width_px.value_or(PictureSettings{}.width_px), default_threads()};
    require_writable_result(given.output, "--out");
    write_result(given.output, picture(given, settings), "--out");
    if (!given.is_quiet) {
        print_error(fmt::format("wrote {}\n", given.output));
    }
    return ExitCode::done;
}

}  // namespace

void add_aeromap_plot(Command aeromap, Action& action) {
    auto [plot, given] = add_command<PlotArguments>(
        aeromap, action, "plot",
        "Draw a problem's aero map, curves of models with measurements, or a rotor's potential flow", run);
    given.command = plot;
    plot.add_option("PROBLEM", given.problem, "problem file: draw a picture over its plane of motion")
        .offers_files({".yaml", ".yml"});
    Option kind = plot.add_option("--what", given.what, "what to show of a problem: " + kinds_text());
    kind.shows_default().offers(names_of(field_kinds));
    Option one_rotor = plot.add_option("--rotor N", given.rotor, "number of the rotor, counted from 1").shows_default();
    plot.add_option("--lateral Y", given.lateral_m,
                    "distance to the left of the plane of motion [m]; of the hub, default: its own place")
        .excludes(one_rotor);
    add_arm(plot, given.arm_deg);
    plot.add_option("--pitch-deg P", given.pitch_deg,
                    "pitch of the vehicle [deg], positive nose down; with --what force or torque")
        .shows_default();
    plot.add_option("--x LOW HIGH", given.x_m, "shown part of the plane [m]; default: the reach of the rotors")
        .values(2);
    plot.add_option("--z LOW HIGH", given.z_m, "the same for z").values(2);
    Option model =
        plot.add_option("--model NAME...", given.models, "name of a model as in a problem file; curves of K over z/R");
    offer_models(model);
    plot.add_option("--data CSV", given.data, "measurements to show with them: CSV as for `aeromap fit`");
    plot.add_option("--surface S", given.surface, "only measurements at this surface, `ground` or `ceiling`")
        .offers(measured_surfaces);
    plot.add_option("--source NAME", given.source, "only measurements of this source");
    plot.add_option("--max-factor K", given.max_factor, "cap of K; default 2");
    plot.add_option("--rotor-spacing D", given.rotor_spacing,
                    "spacing of adjacent axes of a square quadrotor in radii; for multirotor models, default 2.5");
    plot.add_option("--tilt-deg T...", given.tilt_deg, "tilt of the rotor's axis from the vertical [deg]");
    plot.add_flag("--flow", given.is_flow, "the potential flow of a rotor and its image below the ground");
    plot.add_option(
            "--z-over-r LOW HIGH", given.z_over_r,
            "distance from the surface in rotor radii; shown range of curves (default 0 4), or the rotor's height "
            "with --flow")
        .values(1, 2);
    add_out(plot, "FILE", given.output, "the picture, .svg, .png or .pdf").required();
    add_width(plot, given.width_px);
    add_no_labels(plot, given.no_labels);
    add_quiet(plot, given.is_quiet);
}

}  // namespace downwash::cli
