#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/base/csv_dialect.hpp"
#include "downwash/base/text.hpp"
#include "downwash/cli/common_options.hpp"
#include "downwash/cli/model_option.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/cli/progress.hpp"
#include "downwash/cli/usage_error.hpp"
#include "downwash/effects/sided_factor.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::cli {
namespace {

struct QueryArguments {
    std::string problem;
    std::vector<std::array<double, 3>> at;
    std::string points;  ///< file of further points, "-" for standard input
    std::optional<int> rotor;
    ModelChoice model;
    std::vector<double> z_over_r;
    double tilt_deg = 0;
    int threads = default_threads();
    bool no_cache = false, is_quiet = false, as_json = false;
};

/// The effect of surfaces on a rotor at one point; the factors are empty where it is not flyable.
struct PointEffect {
    std::array<double, 3> at_m;
    bool is_flyable = false;
    std::optional<double> factor, ground, ceiling;
};

double sin_tilt(const QueryArguments& given) {
    if (!(given.tilt_deg >= -90 && given.tilt_deg <= 90)) {
        throw UsageError("--tilt-deg {}: expected degrees from -90 to 90", given.tilt_deg);
    }
    return std::sin(given.tilt_deg * std::numbers::pi / 180);
}

/// The factors of a problem: from its map where a point lies on one of the map's planes, directly elsewhere.
class Effects {
 public:
    /// @param cache folder of maps of earlier runs; empty: none
    Effects(const QueryArguments& given, const Problem& problem, std::filesystem::path cache)
        : problem_(problem),
          model_(make_flight_model(problem)),
          rotor_(rotor_option(given.rotor, model_->tick().plant.rotor_count)),
          sin_tilt_(sin_tilt(given)),
          cache_(std::move(cache)),
          threads_(given.threads),
          is_quiet_(given.is_quiet) {}

    /// Fills the map around some points, as far as they lie on its planes, and keeps that in the cache.
    void fill_around(const std::vector<std::array<double, 3>>& points_m) {
        std::vector<LayerPlace> places;
        for (const auto& point_m : points_m) {
            if (const auto place = place_on_map(point_m)) {
                places.push_back(*place);
            }
        }
        if (!places.empty()) {
            ProgressDisplay display(is_quiet_);
            map().fill_around(places, threads_, [&display](double share) { display.show("filling the map", share); });
            keep_map(cache_, map());
        }
    }

    PointEffect at(const std::array<double, 3>& point_m) {
        const DirectEffect& direct = model_->effect(rotor_);
        PointEffect effect{point_m, direct.is_flyable(point_m), {}, {}, {}};
        if (effect.is_flyable) {
            const DirectEffect::Factors factors = direct.factors(point_m);
            const TiltLoss& loss = model_->tick().tilt_loss;
            if (!problem_.aero.map) {
                effect.ground = tilted<double>({factors.ground, 1}, loss, sin_tilt_).all;
                effect.ceiling = tilted<double>({factors.ceiling, factors.ceiling}, loss, sin_tilt_).all;
            }
            const SidedFactor<double> level = map_factor(point_m).value_or(direct.sided_factor(point_m));
            effect.factor = tilted(level, loss, sin_tilt_).all;
        }
        return effect;
    }

 private:
    std::optional<SidedFactor<double>> map_factor(const Vector3& point_m) {
        const auto place = place_on_map(point_m);
        return place ? std::optional(map().sided_factor(place->layer, place->x_m, place->z_m)) : std::nullopt;
    }

    /// Where a point is on the map; empty if it lies on none of the planes of its layers.
    [[nodiscard]] std::optional<LayerPlace> place_on_map(const Vector3& point_m) const {
        constexpr double on_plane_m = 1e-9;
        if (!problem_.aero.enabled) {
            return std::nullopt;
        }
        const Vector3 local_m = model_->plane().from_world(point_m);
        for (int rotor = 0; rotor < model_->tick().plant.rotor_count; ++rotor) {
            const MapLayer& layer = model_->layer(rotor);
            if (layer.effect.get() == &model_->effect(rotor_) && std::abs(local_m[1] - layer.lateral_m) <= on_plane_m) {
                return LayerPlace{model_->rotor_layer(rotor), local_m[0], local_m[2]};
            }
        }
        return std::nullopt;
    }

    const AeroMap& map() {
        if (!map_) {
            map_ = model_->make_map(problem_.bounds, cache_);
        }
        return *map_;
    }

    const Problem& problem_;
    std::shared_ptr<const FlightModel> model_;
    int rotor_;
    double sin_tilt_;
    std::filesystem::path cache_;
    int threads_;
    bool is_quiet_;
    std::shared_ptr<const AeroMap> map_;
};

std::string text_of_factor(const std::optional<double>& value) {
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
            fmt::print("{:>10.4f} {:>10.4f} {:>10.4f}  {:>10} {:>10} {:>10}{}\n", x_m, y_m, z_m,
                       text_of_factor(effect.factor), text_of_factor(effect.ground), text_of_factor(effect.ceiling),
                       effect.is_flyable ? "" : "  not flyable");
        }
    }
    if (as_json) {
        print_json({{"points", std::move(points)}});
    }
}

void require_place(const std::array<double, 3>& point_m, const std::string& where) {
    for (const double coordinate_m : point_m) {
        require_coordinate(coordinate_m, where);
    }
}

/// The three numbers of a line; empty when it holds something else.
std::optional<std::array<double, 3>> point_in(std::string line) {
    const bool has_semicolons = line.find(';') != std::string::npos;  // then commas are decimal
    std::replace(line.begin(), line.end(), has_semicolons ? ';' : ',', ' ');
    std::array<double, 3> point_m{};
    std::istringstream words(line);
    std::string word;
    for (double& coordinate_m : point_m) {
        const auto number =
            words >> word ? decimal_number(word, word.find(',') != std::string::npos ? ',' : '.') : std::nullopt;
        if (!number) {
            return std::nullopt;
        }
        coordinate_m = *number;
    }
    return words >> word ? std::nullopt : std::optional(point_m);
}

/// Reads lines of three numbers, separated by blanks, commas or semicolons. Skips a byte order mark, empty lines,
/// comments after # and a line x_m,y_m,z_m.
std::vector<std::array<double, 3>> read_points(std::istream& lines, const std::string& name) {
    constexpr std::size_t most_points = 1'000'000;
    std::vector<std::array<double, 3>> points;
    std::array<char, 1000> buffer{};
    int number = 1;
    for (; lines.getline(buffer.data(), buffer.size()); ++number) {
        constexpr std::string_view mark = "\xEF\xBB\xBF";
        std::string_view line(buffer.data());
        line.remove_prefix(number == 1 && line.starts_with(mark) ? mark.size() : 0);
        line = trimmed(line.substr(0, line.find('#')));
        if (line.empty() || is_same_word(line.substr(0, 3), "x_m") || line.starts_with("\"x_m")) {
            continue;
        }
        const auto point_m = point_in(std::string(line));
        if (!point_m) {
            throw UsageError("{}:{}: '{}': expected three numbers, x_m y_m z_m", name, number, excerpt(line));
        }
        require_place(*point_m, fmt::format("{}:{}:", name, number));
        if (points.size() == most_points) {
            throw UsageError("{}:{}: more than {} points", name, number, most_points);
        }
        points.push_back(*point_m);
    }
    if (!lines.eof()) {
        throw UsageError("{}:{}: longer than {} characters, expected three numbers, x_m y_m z_m", name, number,
                         buffer.size() - 1);
    }
    return points;
}

std::vector<std::array<double, 3>> all_points(const QueryArguments& given) {
    std::vector<std::array<double, 3>> points = given.at;
    for (const auto& point_m : points) {
        require_place(point_m, "--at");
    }
    if (given.points.empty()) {
        return points;
    }
    const auto reject = [&given](const char* why) { throw UsageError("--points " + given.points + ": " + why); };
    std::vector<std::array<double, 3>> further;
    if (given.points == "-") {
        further = read_points(std::cin, "standard input");
    } else {
        std::error_code none;
        if (std::filesystem::is_directory(given.points, none)) {
            reject("is a directory, expected a file");
        }
        std::ifstream file(given.points);  // or a pipe
        if (!file) {
            reject("cannot be read");
        }
        further = read_points(file, given.points);
    }
    if (further.empty()) {
        reject("holds no point, expected lines of three numbers, x_m y_m z_m");
    }
    points.insert(points.end(), further.begin(), further.end());
    return points;
}

void query_problem(const QueryArguments& given) {
    const Problem problem = read_problem(given.problem, {}, given.is_quiet ? nullptr : print_outdated);
    Effects effects(given, problem, cache_folder(given.no_cache));
    const std::vector<std::array<double, 3>> points_m = all_points(given);
    effects.fill_around(points_m);
    std::vector<PointEffect> points;
    points.reserve(points_m.size());
    for (const auto& point_m : points_m) {
        points.push_back(effects.at(point_m));
    }
    print_points(points, given.as_json);
}

void query_model(const QueryArguments& given) {
    const EffectCurve curve = curve_option(given.model);
    const EffectModelInfo& model = info(curve.effect().model);
    const TiltLoss loss{model.surface == "ground" ? default_ground_tilt_loss : 0, 0};
    auto points = Json::array();
    for (const double z_over_r : given.z_over_r) {
        if (!(z_over_r >= 0 && std::isfinite(z_over_r))) {
            throw UsageError("--z-over-r {}: expected a finite distance in radii, at least 0", z_over_r);
        }
        points.push_back(
            {{"z_over_r", z_over_r}, {"factor", tilted<double>({curve(z_over_r), 1}, loss, sin_tilt(given)).all}});
    }
    if (given.as_json) {
        print_json({{"model", model.name}, {"points", std::move(points)}});
        return;
    }
    fmt::print("{}: {}\nK = {}\nholds: {}\n{:>10}  {:>10}\n", model.name, model.source, model.formula, model.validity,
               "z_over_r", "factor");
    for (const Json& point : points) {
        fmt::print("{:>10.4f}  {:>10.6f}\n", point["z_over_r"].get<double>(), point["factor"].get<double>());
    }
}

ExitCode run(const QueryArguments& given) {
    const bool has_model = !given.model.name.empty();
    const bool has_points = !given.at.empty() || !given.points.empty();
    if (given.problem.empty() != has_model) {
        throw UsageError("aeromap query needs either PROBLEM with --at X Y Z, or --model NAME with --z-over-r V");
    }
    if (has_model && (given.z_over_r.empty() || has_points || given.rotor)) {
        throw UsageError("--model needs --z-over-r V... and excludes --at, --points and --rotor");
    }
    if (!has_model && (!has_points || !given.z_over_r.empty() || is_given(given.model))) {
        throw UsageError("PROBLEM needs --at X Y Z or --points FILE and excludes the options of --model");
    }
    has_model ? query_model(given) : query_problem(given);
    return ExitCode::done;
}

}  // namespace

void add_aeromap_query(Command aeromap, Action& action) {
    auto [command, given] = add_command<QueryArguments>(
        aeromap, action, "query",
        "Print the thrust ratio K of a rotor: PROBLEM with --at, or --model with --z-over-r for a wide flat surface",
        run);
    command.add_option("PROBLEM", given.problem, "problem file").offers_files({".yaml", ".yml"});
    add_points(command, given.at,
               "rotor hub in the world frame [m]. `factor` comes from the problem's map if the point "
               "lies on one of its planes");
    command.add_option("--points FILE", given.points,
                       "file with more points, one per line; - reads them from standard input");
    command.add_option("--rotor N", given.rotor,
                       "number of the rotor, counted from 1; the multirotor models consider its neighbours, default 1");
    offer_models(command.add_option("--model NAME", given.model.name, "name of a model as in a problem file"));
    command.add_option("--z-over-r V...", given.z_over_r, "distance from the surface in rotor radii");
    command.add_option("--tilt-deg T", given.tilt_deg, "tilt of the rotor's axis from the vertical [deg]");
    add_model_options(command, given.model);
    add_threads(command, given.threads);
    add_no_cache(command, given.no_cache);
    add_quiet(command, given.is_quiet);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
