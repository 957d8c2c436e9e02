#include <fmt/core.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "downwash/aeromap/effect_curve.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

using Json = nlohmann::ordered_json;

struct QueryArguments {
    std::string problem;
    std::vector<std::array<double, 3>> at;
    std::string model;
    std::vector<double> z_over_r;
    std::optional<double> max_factor;
    bool as_json = false;
};

/// What surfaces do to a rotor at one point; factors are empty where it is not flyable.
struct PointEffect {
    std::array<double, 3> at_m;
    bool is_flyable = false;
    std::optional<double> factor, ground, ceiling;
};

/// The factors of a problem: from its map where a point lies on one of the map's planes, directly elsewhere.
class Effects {
 public:
    explicit Effects(const Problem& problem) : problem_(problem), model_(make_flight_model(problem)) {}

    PointEffect at(const std::array<double, 3>& point_m) {
        PointEffect effect{point_m, model_->effect(0).is_flyable(point_m), {}, {}, {}};
        if (effect.is_flyable) {
            const DirectEffect::Factors factors = model_->effect(0).factors(point_m);
            effect.ground = factors.ground;
            effect.ceiling = factors.ceiling;
            effect.factor = map_factor(point_m).value_or(factors.total);
        }
        return effect;
    }

 private:
    std::optional<double> map_factor(const Vector3& point_m) {
        constexpr double on_plane_m = 1e-9;
        if (!problem_.aero.enabled) {
            return std::nullopt;
        }
        const Vector3 local_m = model_->plane().from_world(point_m);
        for (int rotor = 0; rotor < model_->tick().plant.rotor_count; ++rotor) {
            if (std::abs(local_m[1] - model_->rotor_lateral_m(rotor)) <= on_plane_m) {
                return map().factor(model_->rotor_layer(rotor), local_m[0], local_m[2]);
            }
        }
        return std::nullopt;
    }

    const AeroMap& map() {
        if (!map_) {
            map_ = model_->make_map(problem_.bounds);
        }
        return *map_;
    }

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    std::shared_ptr<const AeroMap> map_;
};

Json json_of(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

std::string text_of(const std::optional<double>& value) {
    return value ? fmt::format("{:.6f}", *value) : "-";
}

void print_points(const std::vector<PointEffect>& effects, bool as_json) {
    if (!as_json) {
        fmt::print("{:>10} {:>10} {:>10}  {:>10} {:>10} {:>10}\n", "x_m", "y_m", "z_m", "factor", "ground", "ceiling");
    }
    auto points = Json::array();
    for (const PointEffect& effect : effects) {
        const auto& [x_m, y_m, z_m] = effect.at_m;
        if (as_json) {
            points.push_back({{"x_m", x_m},
                              {"y_m", y_m},
                              {"z_m", z_m},
                              {"flyable", effect.is_flyable},
                              {"factor", json_of(effect.factor)},
                              {"ground", json_of(effect.ground)},
                              {"ceiling", json_of(effect.ceiling)}});
        } else {
            fmt::print("{:>10.4f} {:>10.4f} {:>10.4f}  {:>10} {:>10} {:>10}{}\n", x_m, y_m, z_m, text_of(effect.factor),
                       text_of(effect.ground), text_of(effect.ceiling), effect.is_flyable ? "" : "  not flyable");
        }
    }
    if (as_json) {
        fmt::print("{}\n", Json{{"points", std::move(points)}}.dump(2));
    }
}

void query_problem(const QueryArguments& arguments) {
    for (const auto& point_m : arguments.at) {
        for (const double coordinate_m : point_m) {
            if (!(std::abs(coordinate_m) <= 1e6)) {
                throw UsageError(fmt::format("--at {}: expected finite coordinates in m, at most 1e6", coordinate_m));
            }
        }
    }
    const Problem problem = read_problem(arguments.problem);
    Effects effects(problem);
    std::vector<PointEffect> points;
    for (const auto& point_m : arguments.at) {
        points.push_back(effects.at(point_m));
    }
    print_points(points, arguments.as_json);
}

void query_model(const QueryArguments& arguments) {
    constexpr double most_factor = 100;
    const EffectModelInfo& model = model_named(arguments.model);
    if (model.model == EffectModel::table) {
        throw UsageError("--model table: a table belongs to a problem; expected the name of a formula");
    }
    const double max_factor = arguments.max_factor.value_or(AeroSettings{}.max_factor);
    if (!(max_factor >= 1 && max_factor <= most_factor)) {
        throw UsageError(fmt::format("--max-factor {}: expected a number from 1 to {}", max_factor, most_factor));
    }
    auto points = Json::array();
    for (const double z_over_r : arguments.z_over_r) {
        if (!(z_over_r >= 0 && std::isfinite(z_over_r))) {
            throw UsageError(fmt::format("--z-over-r {}: expected a finite distance in radii, at least 0", z_over_r));
        }
        points.push_back({{"z_over_r", z_over_r}, {"factor", EffectCurve(model.model, max_factor)(z_over_r)}});
    }
    if (arguments.as_json) {
        fmt::print("{}\n", Json{{"model", model.name}, {"points", std::move(points)}}.dump(2));
        return;
    }
    fmt::print("{}: {}\n{:>10}  {:>10}\n", model.name, model.source, "z_over_r", "factor");
    for (const Json& point : points) {
        fmt::print("{:>10.4f}  {:>10.6f}\n", point["z_over_r"].get<double>(), point["factor"].get<double>());
    }
}

ExitCode run(const QueryArguments& arguments) {
    const bool has_model = !arguments.model.empty();
    if (arguments.problem.empty() != has_model) {
        throw UsageError("aeromap query wants either PROBLEM with --at X Y Z, or --model NAME with --z-over-r V");
    }
    if (has_model ? arguments.z_over_r.empty() || !arguments.at.empty()
                  : arguments.at.empty() || !arguments.z_over_r.empty() || arguments.max_factor) {
        throw UsageError(has_model ? "--model wants --z-over-r V... and no --at"
                                   : "PROBLEM wants --at X Y Z, and neither --z-over-r nor --max-factor");
    }
    has_model ? query_model(arguments) : query_problem(arguments);
    return ExitCode::done;
}

}  // namespace

void add_aeromap(CLI::App& program, Action& action) {
    const auto arguments = std::make_shared<QueryArguments>();
    CLI::App* aeromap = program.add_subcommand("aeromap", "How surfaces change the thrust of a rotor");
    aeromap->require_subcommand(1);
    CLI::App* query = aeromap->add_subcommand(
        "query", "Factors on a rotor's thrust: PROBLEM with --at, or --model with --z-over-r for a wide flat surface");
    query->add_option("PROBLEM", arguments->problem, "problem file");
    query
        ->add_option("--at", arguments->at,
                     "rotor hub in the world frame [m]; may be given several times. `factor` comes from the problem's "
                     "map where the point lies on one of its planes")
        ->type_name("X Y Z");
    query->add_option("--model", arguments->model, "name of a model as in a problem file")->type_name("NAME");
    query->add_option("--z-over-r", arguments->z_over_r, "distances in rotor radii")->type_name("V...");
    query->add_option("--max-factor", arguments->max_factor, "cap of the model; default 2")->type_name("K");
    query->add_flag("--json", arguments->as_json, "print JSON");
    query->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
    add_aeromap_fit(*aeromap, action);
    add_aeromap_compare(*aeromap, action);
}

}  // namespace downwash::cli
