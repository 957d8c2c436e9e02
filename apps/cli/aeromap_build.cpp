#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "downwash/aeromap/grid_sampling.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/cli/vehicle_table.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "downwash/problems/problem_model.hpp"
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
    int threads = default_threads();
    bool is_quiet = false;
};

double step_of(const BuildArguments& given, const Problem& problem) {
    const double step_m = given.step_m.value_or(problem.aero.grid_m);
    if (!(step_m > 0 && step_m <= 1000)) {
        throw UsageError("--step {}: expected metres above 0 and at most 1000", step_m);
    }
    return step_m;
}

/// One layer for each lateral offset of a rotor, or that of the one rotor.
std::vector<MapLayer> chosen_layers(const BuildArguments& given, const FlightModel& model) {
    if (given.rotor) {
        return {model.layer(rotor_option(given.rotor, model.tick().plant.rotor_count))};
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

FactorGrid sampled(const BuildArguments& given, const Problem& problem, const FlightModel& model,
                   const GridSampling& sampling) {
    const MapLayer& first = model.layer(rotor_option(given.rotor, model.tick().plant.rotor_count));
    Provenance provenance = provenance_of(*first.effect);
    provenance.insert(provenance.begin() + 1, {{"problem", problem.name}, {"problem_sha256", problem_sha256(problem)}});
    if (model.tick().plant.has_fountain) {
        provenance.emplace_back("fountain", "not contained: the grid holds the factors of rotors");
    }
    if (given.lateral_m.empty()) {
        return sample_planes(chosen_layers(given, model), sampling, provenance);
    }
    if (!(given.lateral_m[0] < given.lateral_m[1])) {
        throw UsageError("--lateral {} {}: expected a lower and a higher number of metres", given.lateral_m[0],
                         given.lateral_m[1]);
    }
    return sample_volume(*first.effect, given.lateral_m[0], given.lateral_m[1], sampling, provenance);
}

/// Checks the output before anything is computed. @throws UsageError
void require_sound_output(const BuildArguments& given) {
    if (given.pitch_deg.empty()) {
        require_grid_writable(given.output);
        return;
    }
    for (const double pitch_deg : given.pitch_deg) {
        static_cast<void>(pitch_option(pitch_deg));
    }
    if (std::filesystem::path(given.output).extension() != ".csv") {
        throw UsageError("--out " + given.output +
                         ": the whole vehicle (--pitch-deg) is written as CSV, expected a name that ends in .csv");
    }
    require_writable_result(given.output, "--out");
}

ExitCode build_vehicle(const BuildArguments& given, const Problem& problem, const FlightModel& model) {
    ProgressDisplay display(given.is_quiet);
    const std::string table =
        vehicle_table(problem, model, given.pitch_deg, step_of(given, problem), given.threads,
                      [&display](double share) { display.show("evaluating the vehicle", share); });
    write_result(given.output, table, "--out");
    display.say(fmt::format("{}: the whole vehicle at {} pitch angle(s)", given.output, given.pitch_deg.size()));
    return ExitCode::done;
}

ExitCode run(const BuildArguments& given) {
    require_sound_output(given);
    const Problem read = read_problem(given.problem, {}, print_outdated);
    if (!read.aero.enabled) {
        throw UsageError(given.problem + ": aero is none, so there is no map to build");
    }
    const auto model = make_flight_model(read);
    if (!given.pitch_deg.empty()) {
        return build_vehicle(given, read, *model);
    }
    ProgressDisplay display(given.is_quiet);
    GridSampling sampling{read.plane, rotor_extent(read.robot.rotors, read.bounds), step_of(given, read), given.threads,
                          [&display](double share) { display.show("building the map", share); }};
    const FactorGrid grid = sampled(given, read, *model, sampling);
    write_factor_grid(given.output, grid);
    if (model->tick().plant.has_fountain) {
        display.say("the grid holds the factors of rotors; it does not contain the fountain that pushes the body");
    }
    display.say(fmt::format("{}: {} x {} x {} nodes, {} layer(s)", given.output, grid.x().count, grid.y().count,
                            grid.z().count, grid.layers()));
    return ExitCode::done;
}

}  // namespace

void add_aeromap_build(Command aeromap, Action& action) {
    auto [command, given] =
        add_command<BuildArguments>(aeromap, action, "build",
                                    "Evaluate a problem's surface effects, on rotors or on the whole vehicle, on a "
                                    "regular grid and write it as a file",
                                    run);
    add_problem(command, given.problem);
    add_out(command, "FILE", given.output, "a file, .vti (VTK ImageData, opens in ParaView) or .csv").required();
    command.add_option("--step M", given.step_m, "maximum distance between nodes [m]; default aero.grid_m");
    Option one_rotor = command.add_option(
        "--rotor N", given.rotor,
        "number of the rotor, counted from 1; only its plane, default: one layer for every lateral offset");
    Option lateral =
        command
            .add_option("--lateral LOW HIGH", given.lateral_m,
                        "distance to the left of the plane of motion [m]; a volume from LOW to HIGH instead of planes")
            .values(2);
    command
        .add_option("--pitch-deg P...", given.pitch_deg,
                    "pitch of the vehicle [deg], positive nose down; the whole vehicle instead of rotors, as .csv: "
                    "force factor, "
                    "pitch torque and its factor over the place of the centre of mass")
        .excludes(one_rotor)
        .excludes(lateral);
    add_threads(command, given.threads);
    add_quiet(command, given.is_quiet);
}

}  // namespace downwash::cli
