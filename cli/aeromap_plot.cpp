#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/parameter.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/completion.hpp"
#include "downwash/cli/measured_data.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/plot_request.hpp"
#include "downwash/cli/standard_error.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/cli/vehicle_figures.hpp"
#include "downwash/cli/vehicle_table.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::cli {
namespace {

/// A figure of the whole vehicle, which keeps the flight model that it asks.
template <class Make>
FieldFigure vehicle_figure(const Problem& problem, Make make) {
    const std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    FieldFigure figure = make(*model);
    figure.value = [model, value = std::move(figure.value)](double x_m, double z_m) { return value(x_m, z_m); };
    return figure;
}

FieldFigure force_kind(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    return vehicle_figure(problem, [&](const FlightModel& model) {
        return force_figure(problem, model, extent, pitch_option(request.pitch_deg));
    });
}

FieldFigure torque_kind(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    return vehicle_figure(problem, [&](const FlightModel& model) {
        return torque_figure(problem, model, extent, pitch_option(request.pitch_deg));
    });
}

FieldFigure hold_kind(const PlotRequest& request, const Problem& problem, const Bounds& extent) {
    const int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return vehicle_figure(problem, [&](const FlightModel& model) {
        return hold_figure(problem, model, extent, request.arm_deg / degrees_per_radian, threads);
    });
}

/// Every picture of a problem there is.
constexpr std::array<FieldKind, 6> field_kinds{{
    {"factor", "factor on a rotor's thrust", one_rotor, &factor_figure},
    {"ground", "the same from surfaces below alone", one_rotor, &factor_figure},
    {"ceiling", "the same from surfaces above alone", one_rotor, &factor_figure},
    {"force", "factor on the whole vehicle's thrust, level or at --pitch-deg", whole_vehicle, &force_kind},
    {"torque", "pitch torque on it in Nm", whole_vehicle, &torque_kind},
    {"hold", "where it can hover, with --arm-deg", where_to_hover, &hold_kind},
}};

std::string kinds_text() {
    std::string text;
    for (const FieldKind& kind : field_kinds) {
        text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", kind.name, kind.description);
    }
    return text;
}

std::vector<std::string_view> kind_names() {
    std::vector<std::string_view> names;
    names.reserve(field_kinds.size());
    for (const FieldKind& kind : field_kinds) {
        names.emplace_back(kind.name);
    }
    return names;
}

const FieldKind& kind_named(const std::string& name) {
    for (const FieldKind& kind : field_kinds) {
        if (name == kind.name) {
            return kind;
        }
    }
    const std::vector<std::string_view> names = kind_names();
    throw UsageError("--what '" + excerpt(name) + "' is not known: expected " + joined_names(names) +
                     did_you_mean(name, names));
}

/// Options that only some pictures care for.
struct OptionUse {
    std::string_view option;
    unsigned subjects;
    const char* use;  ///< for people
};

constexpr unsigned any_of_a_problem = one_rotor | whole_vehicle | where_to_hover;
constexpr std::array<OptionUse, 12> option_uses{{
    {"--what", any_of_a_problem, "it goes with PROBLEM"},
    {"--rotor", one_rotor, "it goes with PROBLEM and --what factor, ground or ceiling"},
    {"--lateral", one_rotor, "it goes with PROBLEM and --what factor, ground or ceiling"},
    {"--arm-deg", where_to_hover, "it goes with PROBLEM and --what hold"},
    {"--pitch-deg", whole_vehicle, "it goes with PROBLEM and --what force or torque"},
    {"--x", any_of_a_problem, "it goes with PROBLEM"},
    {"--z", any_of_a_problem, "it goes with PROBLEM"},
    {"--surface", curves, "it goes with --data"},
    {"--source", curves, "it goes with --data"},
    {"--max-factor", curves, "it goes with --model"},
    {"--rotor-spacing", curves, "it goes with --model multirotor-images or multirotor-body"},
    {"--z-over-r", curves | flow, "it goes with --model, --data or --flow"},
}};

PictureSubject subject_of(const PlotRequest& request) {
    if (request.is_flow) {
        return flow;
    }
    return request.problem.empty() ? curves : kind_named(request.what).subject;
}

/// Whether an option that goes with curves has something to act on.
bool has_use(std::string_view option, const PlotRequest& request) {
    if (option == "--surface" || option == "--source") {
        return !request.data.empty();
    }
    if (option == "--rotor-spacing") {
        return std::any_of(request.models.begin(), request.models.end(),
                           [](const std::string& name) { return is_multirotor(model_named(name).model); });
    }
    return option != "--max-factor" || !request.models.empty();
}

void refuse_useless_options(const PlotRequest& request) {
    const PictureSubject subject = subject_of(request);
    for (const OptionUse& use : option_uses) {
        const auto& given = request.given_options;
        if (std::find(given.begin(), given.end(), use.option) != given.end() &&
            !((use.subjects & subject) != 0 && (subject != curves || has_use(use.option, request)))) {
            throw UsageError(fmt::format("{} changes nothing in this picture: {}", use.option, use.use));
        }
    }
}

/// What of one axis is shown. @param usual where nothing is given
AxisRange shown_range(const char* option, const std::vector<double>& given, const AxisRange& usual) {
    constexpr double farthest_m = 1e6;
    if (given.empty()) {
        return usual;
    }
    if (!(given[0] < given[1] && std::abs(given[0]) <= farthest_m && std::abs(given[1]) <= farthest_m)) {
        throw UsageError(fmt::format("{} {} {}: expected LOW below HIGH, in m, at most {} either way", option, given[0],
                                     given[1], farthest_m));
    }
    return {given[0], given[1]};
}

/// Where the vehicle's rotors can be, and a little more.
Bounds shown_extent(const PlotRequest& request, const Problem& problem) {
    constexpr double margin = 0.04;  // of the longer side
    const Bounds rotors = rotor_extent(problem.robot.rotors, problem.bounds);
    const double margin_m = margin * std::max(rotors.x_high_m - rotors.x_low_m, rotors.z_high_m - rotors.z_low_m);
    const AxisRange x = shown_range("--x", request.x_m, {rotors.x_low_m - margin_m, rotors.x_high_m + margin_m});
    const AxisRange z = shown_range("--z", request.z_m, {rotors.z_low_m - margin_m, rotors.z_high_m + margin_m});
    return {x.low, x.high, z.low, z.high};
}

void require_sound_options(const PlotRequest& request) {
    const bool has_models = !request.models.empty() || !request.data.empty();
    const int given = (request.problem.empty() ? 0 : 1) + (has_models ? 1 : 0) + (request.is_flow ? 1 : 0);
    if (given != 1) {
        throw UsageError(
            "aeromap plot wants one of PROBLEM, --model NAME... (with or without --data CSV), and --flow with "
            "--z-over-r H");
    }
    refuse_useless_options(request);
    if (request.width_px < least_picture_width_px || request.width_px > most_picture_width_px) {
        throw UsageError(fmt::format("--width {}: expected {} to {} pixels", request.width_px, least_picture_width_px,
                                     most_picture_width_px));
    }
    if (!(std::abs(request.arm_deg) <= 1e5)) {
        throw UsageError(fmt::format("--arm-deg {}: expected degrees, at most 1e5 either way", request.arm_deg));
    }
    static_cast<void>(pitch_option(request.pitch_deg));
    if (request.lateral_m && !(std::abs(*request.lateral_m) <= 1e6)) {
        throw UsageError(fmt::format("--lateral {}: expected a finite distance in m, at most 1e6", *request.lateral_m));
    }
}

std::string picture(const PlotRequest& request, const PictureSettings& settings) {
    if (request.is_flow) {
        return draw(potential_flow_figure(request), settings);
    }
    if (request.problem.empty()) {
        return draw(model_figure(request), settings);
    }
    const FieldKind& kind = kind_named(request.what);
    const Problem problem = read_problem(request.problem);
    return draw(kind.make(request, problem, shown_extent(request, problem)), settings);
}

ExitCode run(const PlotRequest& request) {
    require_sound_options(request);
    const std::optional<PictureFormat> format = picture_format_of(request.output);
    if (!format) {
        throw UsageError("--output " + request.output + ": expected a name that ends in .svg, .png or .pdf");
    }
    try {
        require_writable(request.output);
        write_file(request.output, picture(request, {*format, request.width_px}));
    } catch (const FileError& error) {
        throw UsageError("--output " + request.output + " " + error.what());
    }
    if (!request.is_quiet) {
        print_error(fmt::format("wrote {}\n", request.output));
    }
    return ExitCode::done;
}

void add_options(CLI::App& plot, PlotRequest& request) {
    plot.add_option("PROBLEM", request.problem, "problem file: a picture over its plane of motion");
    CLI::Option* what = plot.add_option("--what", request.what, "what to show of a problem: " + kinds_text());
    offer_words(*what->capture_default_str(), kind_names());
    CLI::Option* rotor =
        plot.add_option("--rotor", request.rotor, "the rotor, counted from 1")->type_name("N")->capture_default_str();
    plot.add_option("--lateral", request.lateral_m,
                    "where its hub is, to the left of the plane [m]; default: its own place")
        ->type_name("Y")
        ->excludes(rotor);
    plot.add_option("--arm-deg", request.arm_deg, "angle of the arm with --what hold")
        ->type_name("A")
        ->capture_default_str();
    plot.add_option("--pitch-deg", request.pitch_deg,
                    "pitch of the vehicle with --what force or torque, positive nose down")
        ->type_name("P")
        ->capture_default_str();
    plot.add_option("--x", request.x_m, "shown part of the plane [m]; default: where rotors can be")
        ->expected(2)
        ->type_name("LOW HIGH");
    plot.add_option("--z", request.z_m, "the same for z")->expected(2)->type_name("LOW HIGH");
    CLI::Option* models =
        plot.add_option("--model", request.models, "curves of K over z/R, by names as in a problem file");
    offer_models(*models->type_name("NAME..."));
    plot.add_option("--data", request.data, "measurements to show with them: CSV as for `aeromap fit`")
        ->type_name("CSV");
    CLI::Option* surface = plot.add_option("--surface", request.surface, "only measurements at this surface");
    offer_words(*surface->type_name("S"), measured_surfaces);
    plot.add_option("--source", request.source, "only measurements of this source")->type_name("NAME");
    plot.add_option("--max-factor", request.max_factor, "cap of the models; default 2")->type_name("K");
    plot.add_option("--rotor-spacing", request.rotor_spacing,
                    "multirotor models: a square quadrotor whose adjacent axes are so many radii apart; default 2.5")
        ->type_name("D");
    plot.add_flag("--flow", request.is_flow, "the potential flow of a rotor and its image below the ground");
    plot.add_option("--z-over-r", request.z_over_r,
                    "shown range of curves (default 0 4), or the rotor's height with --flow [radii]")
        ->expected(1, 2)
        ->type_name("LOW HIGH");
    plot.add_option("-o,--output", request.output, "the picture, .svg, .png or .pdf")->required()->type_name("FILE");
    plot.add_option("--width", request.width_px, "width of the picture [pixels]")
        ->type_name("PX")
        ->capture_default_str();
    plot.add_flag("--quiet", request.is_quiet, "print nothing but errors");
}

}  // namespace

void add_aeromap_plot(CLI::App& aeromap, Action& action) {
    const auto request = std::make_shared<PlotRequest>();
    CLI::App* plot = aeromap.add_subcommand(
        "plot", "Pictures: a problem's aero map, curves of models with measurements, a rotor's potential flow");
    add_options(*plot, *request);
    plot->callback([request, plot, &action] {
        for (const CLI::Option* option : plot->get_options([](const CLI::Option* one) { return one->count() > 0; })) {
            request->given_options.push_back(option->get_name());
        }
        action = [request] { return run(*request); };
    });
}

}  // namespace downwash::cli
