#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "downwash/aeromap/grid_sampling.hpp"
#include "downwash/base/files.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/rotor_option.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/cli/vehicle_table.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/problem_writer.hpp"

namespace downwash::cli {
namespace {

struct BuildArguments {
    std::string problem;
    std::string output;
    std::optional<double> step_m;
    std::optional<int> rotor;  ///< from 1 on
    std::vector<double> lateral_m;
    std::vector<double> pitch_deg;  ///< of the whole vehicle; empty: factors of rotors
    int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
    bool is_quiet = false;
};

double step_of(const BuildArguments& arguments, const Problem& problem) {
    const double step_m = arguments.step_m.value_or(problem.aero.grid_m);
    if (!(step_m > 0 && step_m <= 1000)) {
        throw UsageError(fmt::format("--step {}: expected metres above 0 and at most 1000", step_m));
    }
    return step_m;
}

/// One layer for each lateral offset of a rotor, or that of the one rotor.
std::vector<MapLayer> chosen_layers(const BuildArguments& arguments, const FlightModel& model) {
    if (arguments.rotor) {
        return {model.layer(rotor_option(arguments.rotor, model))};
    }
    std::vector<MapLayer> layers;
    for (int rotor = 0; rotor < model.tick().plant.rotor_count; ++rotor) {
        const MapLayer& layer = model.layer(rotor);
        const auto is_same = [&](const MapLayer& other) {
            return other.effect == layer.effect && other.lateral_m == layer.lateral_m;
        };
        if (std::none_of(layers.begin(), layers.end(), is_same)) {
            layers.push_back(layer);
        }
    }
    return layers;
}

FactorGrid sampled(const BuildArguments& arguments, const Problem& problem, const FlightModel& model,
                   const GridSampling& sampling) {
    const MapLayer& first = model.layer(rotor_option(arguments.rotor, model));
    Provenance provenance = provenance_of(*first.effect);
    provenance.insert(provenance.begin() + 1, {{"problem", problem.name}, {"problem_sha256", problem_sha256(problem)}});
    if (model.tick().plant.has_fountain) {
        provenance.emplace_back("fountain", "not contained: the grid holds the factors of rotors");
    }
    if (arguments.lateral_m.empty()) {
        return sample_planes(chosen_layers(arguments, model), sampling, provenance);
    }
    if (!(arguments.lateral_m[0] < arguments.lateral_m[1])) {
        throw UsageError(fmt::format("--lateral {} {}: expected a lower and a higher number of metres",
                                     arguments.lateral_m[0], arguments.lateral_m[1]));
    }
    return sample_volume(*first.effect, arguments.lateral_m[0], arguments.lateral_m[1], sampling, provenance);
}

/// Before anything is evaluated.
void require_sound_output(const BuildArguments& arguments) {
    if (arguments.pitch_deg.empty()) {
        require_grid_writable(arguments.output);
        return;
    }
    for (const double pitch_deg : arguments.pitch_deg) {
        static_cast<void>(pitch_option(pitch_deg));
    }
    if (std::filesystem::path(arguments.output).extension() != ".csv") {
        throw UsageError("--output " + arguments.output +
                         ": the whole vehicle (--pitch-deg) is written as CSV, expected a name that ends in .csv");
    }
    try {
        require_writable(arguments.output);
    } catch (const FileError& error) {
        throw UsageError("--output " + arguments.output + " " + error.what());
    }
}

ExitCode build_vehicle(const BuildArguments& arguments, const Problem& problem, const FlightModel& model) {
    ProgressDisplay display(arguments.is_quiet);
    const std::string table =
        vehicle_table(problem, model, arguments.pitch_deg, step_of(arguments, problem), arguments.threads,
                      [&display](double share) { display.show("evaluating the vehicle", share); });
    try {
        write_file(arguments.output, table);
    } catch (const FileError& error) {
        throw UsageError("--output " + arguments.output + " " + error.what());
    }
    display.say(
        fmt::format("{}: the whole vehicle at {} pitch angle(s)", arguments.output, arguments.pitch_deg.size()));
    return ExitCode::done;
}

ExitCode build(const BuildArguments& arguments) {
    if (arguments.threads < 1 || arguments.threads > 256) {
        throw UsageError(fmt::format("--threads {}: expected a number from 1 to 256", arguments.threads));
    }
    require_sound_output(arguments);
    const Problem problem = read_problem(arguments.problem);
    if (!problem.aero.enabled) {
        throw UsageError(arguments.problem + ": aero is none, so there is no map to build");
    }
    const auto model = make_flight_model(problem);
    if (!arguments.pitch_deg.empty()) {
        return build_vehicle(arguments, problem, *model);
    }
    ProgressDisplay display(arguments.is_quiet);
    GridSampling sampling{problem.plane, rotor_extent(problem.robot.rotors, problem.bounds),
                          step_of(arguments, problem), arguments.threads,
                          [&display](double share) { display.show("building the map", share); }};
    const FactorGrid grid = sampled(arguments, problem, *model, sampling);
    write_factor_grid(arguments.output, grid);
    if (model->tick().plant.has_fountain) {
        display.say("the fountain that pushes the body is not contained: the grid holds the factors of rotors");
    }
    display.say(fmt::format("{}: {} x {} x {} nodes, {} layer(s)", arguments.output, grid.x().count, grid.y().count,
                            grid.z().count, grid.layers()));
    return ExitCode::done;
}

}  // namespace

void add_aeromap_build(CLI::App& aeromap, Action& action) {
    const auto arguments = std::make_shared<BuildArguments>();
    CLI::App* build_command = aeromap.add_subcommand("build",
                                                     "Evaluate a problem's surface effects, on rotors or the whole "
                                                     "vehicle, on a regular grid and write it as a file");
    build_command->add_option("PROBLEM", arguments->problem, "problem file")->required();
    build_command
        ->add_option("-o,--output", arguments->output, "file to write: .vti (VTK ImageData, opens in ParaView) or .csv")
        ->type_name("FILE")
        ->required();
    build_command->add_option("--step", arguments->step_m, "most distance between nodes [m]; default aero.grid_m")
        ->type_name("M");
    CLI::Option* rotor =
        build_command
            ->add_option("--rotor", arguments->rotor,
                         "only the plane of this rotor, 1 the first; default: one layer for every lateral offset")
            ->type_name("N");
    CLI::Option* lateral =
        build_command
            ->add_option("--lateral", arguments->lateral_m,
                         "a volume instead of planes, from LOW to HIGH beside the plane of motion [m]")
            ->type_name("LOW HIGH")
            ->expected(2);
    build_command
        ->add_option("--pitch-deg", arguments->pitch_deg,
                     "the whole vehicle at these pitch angles instead of rotors: force factor, pitch torque and its "
                     "factor over where its centre of mass may be, as .csv; positive nose down")
        ->type_name("P...")
        ->excludes(rotor)
        ->excludes(lateral);
    build_command->add_option("--threads", arguments->threads, "threads; the result does not depend on it")
        ->type_name("N");
    build_command->add_flag("--quiet", arguments->is_quiet, "say nothing but errors");
    build_command->callback([arguments, &action] { action = [arguments] { return build(*arguments); }; });
}

}  // namespace downwash::cli
