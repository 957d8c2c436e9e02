#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/cli/cache_folder.hpp"
#include "downwash/cli/commands.hpp"
#include "downwash/cli/json_text.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/rotor_option.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

using Json = nlohmann::ordered_json;

struct QueryArguments {
    std::string problem;
    std::vector<std::array<double, 3>> at;
    std::string points;  ///< file of further points, "-" for standard input
    std::optional<int> rotor;
    ModelChoice model;
    std::vector<double> z_over_r;
    bool no_cache = false;
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
    /// @param cache folder of maps of earlier runs; empty: none
    Effects(const QueryArguments& arguments, const Problem& problem, std::filesystem::path cache)
        : problem_(problem),
          model_(make_flight_model(problem)),
          rotor_(rotor_option(arguments.rotor, *model_)),
          cache_(std::move(cache)) {}

    PointEffect at(const std::array<double, 3>& point_m) {
        const DirectEffect& direct = model_->effect(rotor_);
        PointEffect effect{point_m, direct.is_flyable(point_m), {}, {}, {}};
        if (effect.is_flyable) {
            const DirectEffect::Factors factors = direct.factors(point_m);
            if (!problem_.aero.map) {
                effect.ground = factors.ground;
                effect.ceiling = factors.ceiling;
            }
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
            const MapLayer& layer = model_->layer(rotor);
            if (layer.effect.get() == &model_->effect(rotor_) && std::abs(local_m[1] - layer.lateral_m) <= on_plane_m) {
                return map().factor(model_->rotor_layer(rotor), local_m[0], local_m[2]);
            }
        }
        return std::nullopt;
    }

    const AeroMap& map() {
        if (!map_) {
            const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 64U));
            ProgressDisplay display(false);
            map_ = model_->make_map(
                problem_.bounds, threads, [&display](double share) { display.show("building the map", share); },
                cache_);
        }
        return *map_;
    }

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    int rotor_;
    std::filesystem::path cache_;
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
        fmt::print("{}\n", json_text(Json{{"points", std::move(points)}}));
    }
}

void require_place(const std::array<double, 3>& point_m, const std::string& where) {
    for (const double coordinate_m : point_m) {
        if (!(std::abs(coordinate_m) <= 1e6)) {
            throw UsageError(fmt::format("{} {}: expected finite coordinates in m, at most 1e6", where, coordinate_m));
        }
    }
}

/// Lines of three numbers, apart by blanks or commas; empty lines, comments behind # and a line x_m,y_m,z_m are passed
/// over.
std::vector<std::array<double, 3>> read_points(std::istream& lines, const std::string& name) {
    std::vector<std::array<double, 3>> points;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        line.erase(std::min(line.find('#'), line.size()));
        std::replace_if(
            line.begin(), line.end(), [](char c) { return c == ',' || c == '\t' || c == '\r'; }, ' ');
        const auto first = line.find_first_not_of(' ');
        if (first == std::string::npos || line.compare(first, 3, "x_m") == 0) {
            continue;
        }
        std::array<double, 3> point_m{};
        const char* at = line.data() + first;
        const char* end = line.data() + line.size();
        for (double& coordinate_m : point_m) {
            const auto [rest, error] = std::from_chars(at, end, coordinate_m);
            at = std::find_if(rest, end, [](char c) { return c != ' '; });
            if (error != std::errc() || (rest != end && *rest != ' ')) {
                throw UsageError(
                    fmt::format("{}:{}: '{}': expected three numbers, x_m y_m z_m", name, number, excerpt(line)));
            }
        }
        if (at != end) {
            throw UsageError(
                fmt::format("{}:{}: '{}': expected three numbers, x_m y_m z_m", name, number, excerpt(line)));
        }
        require_place(point_m, fmt::format("{}:{}:", name, number));
        points.push_back(point_m);
    }
    return points;
}

std::vector<std::array<double, 3>> all_points(const QueryArguments& arguments) {
    std::vector<std::array<double, 3>> points = arguments.at;
    for (const auto& point_m : points) {
        require_place(point_m, "--at");
    }
    std::vector<std::array<double, 3>> further;
    if (arguments.points == "-") {
        further = read_points(std::cin, "standard input");
    } else if (!arguments.points.empty()) {
        std::error_code none;
        if (std::filesystem::is_directory(arguments.points, none)) {
            throw UsageError("--points " + arguments.points + ": is a directory, expected a file");
        }
        std::ifstream file(arguments.points);  // or a pipe
        if (!file) {
            throw UsageError("--points " + arguments.points + ": cannot be read");
        }
        further = read_points(file, arguments.points);
    }
    if (further.empty() && !arguments.points.empty()) {
        throw UsageError("--points " + arguments.points +
                         ": holds no point, expected lines of three numbers, x_m y_m z_m");
    }
    points.insert(points.end(), further.begin(), further.end());
    return points;
}

void query_problem(const QueryArguments& arguments) {
    const Problem problem = read_problem(arguments.problem);
    Effects effects(arguments, problem, arguments.no_cache ? std::filesystem::path() : cache_folder());
    std::vector<PointEffect> points;
    for (const auto& point_m : all_points(arguments)) {
        points.push_back(effects.at(point_m));
    }
    print_points(points, arguments.as_json);
}

void query_model(const QueryArguments& arguments) {
    const EffectCurve curve = curve_option(arguments.model);
    const EffectModelInfo& model = info(curve.effect().model);
    auto points = Json::array();
    for (const double z_over_r : arguments.z_over_r) {
        if (!(z_over_r >= 0 && std::isfinite(z_over_r))) {
            throw UsageError(fmt::format("--z-over-r {}: expected a finite distance in radii, at least 0", z_over_r));
        }
        points.push_back({{"z_over_r", z_over_r}, {"factor", curve(z_over_r)}});
    }
    if (arguments.as_json) {
        fmt::print("{}\n", json_text(Json{{"model", model.name}, {"points", std::move(points)}}));
        return;
    }
    fmt::print("{}: {}\nK = {}\nholds: {}\n{:>10}  {:>10}\n", model.name, model.source, model.formula, model.validity,
               "z_over_r", "factor");
    for (const Json& point : points) {
        fmt::print("{:>10.4f}  {:>10.6f}\n", point["z_over_r"].get<double>(), point["factor"].get<double>());
    }
}

ExitCode run(const QueryArguments& arguments) {
    const bool has_model = !arguments.model.name.empty();
    const bool has_points = !arguments.at.empty() || !arguments.points.empty();
    if (arguments.problem.empty() != has_model) {
        throw UsageError("aeromap query wants either PROBLEM with --at X Y Z, or --model NAME with --z-over-r V");
    }
    if (has_model && (arguments.z_over_r.empty() || has_points || arguments.rotor)) {
        throw UsageError("--model wants --z-over-r V... and no --at, --points or --rotor");
    }
    if (!has_model && (!has_points || !arguments.z_over_r.empty() || is_given(arguments.model))) {
        throw UsageError("PROBLEM wants --at X Y Z or --points FILE, and nothing that belongs to --model");
    }
    has_model ? query_model(arguments) : query_problem(arguments);
    return ExitCode::done;
}

}  // namespace

void add_aeromap_query(CLI::App& aeromap, Action& action) {
    const auto arguments = std::make_shared<QueryArguments>();
    CLI::App* query = aeromap.add_subcommand(
        "query", "Factors on a rotor's thrust: PROBLEM with --at, or --model with --z-over-r for a wide flat surface");
    query->add_option("PROBLEM", arguments->problem, "problem file");
    query
        ->add_option("--at", arguments->at,
                     "rotor hub in the world frame [m]; may be given several times. `factor` comes from the problem's "
                     "map where the point lies on one of its planes")
        ->type_name("X Y Z")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    query
        ->add_option("--points", arguments->points,
                     "file of many such points, a line each; - reads them from standard input")
        ->type_name("FILE");
    query->add_option("--rotor", arguments->rotor, "whose neighbours count for the multirotor models; default 1")
        ->type_name("N");
    CLI::Option* model = query->add_option("--model", arguments->model.name, "name of a model as in a problem file");
    offer_models(*model->type_name("NAME"));
    query->add_option("--z-over-r", arguments->z_over_r, "distances in rotor radii")->type_name("V...");
    add_model_options(*query, arguments->model);
    query->add_flag("--no-cache", arguments->no_cache, "neither read nor write the cache of aero maps");
    query->add_flag("--json", arguments->as_json, "print JSON");
    query->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace downwash::cli
