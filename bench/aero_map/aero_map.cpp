// What the aero map costs: building, memory, look-ups, against direct evaluation; for scenes of primitives, the shipped
// problems, triangle meshes and a volume. Prints Markdown, with the bounds that the map is to keep and whether it does.

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "downwash/aeromap/map_cache.hpp"
#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "measuring.hpp"
#include "scenes.hpp"
#include "volume.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double most_build_s = 1;
constexpr double most_bytes = 64e6;
constexpr double most_look_up_s = 15e-9;

struct Options {
    std::string ten_primitives;
    std::vector<std::string> problems;
    std::string commit = "unknown";
    int repetitions = 5;
    unsigned random_scenes = 20;
    bool with_meshes = true;
};

struct Point {
    double x_m, z_m;
};

class RandomPoints {
 public:
    explicit RandomPoints(const AeroMap& map) : map_(map) {}

    /// Flyable for the map's first layer.
    Point one() {
        const Bounds& all = map_.extent();
        while (true) {
            const Point p{uniform(all.x_low_m, all.x_high_m), uniform(all.z_low_m, all.z_high_m)};
            if (map_.is_flyable(0, p.x_m, p.z_m)) {
                return p;
            }
        }
    }
    std::vector<Point> scattered(std::size_t count) {
        std::vector<Point> points(count);
        std::generate(points.begin(), points.end(), [this] { return one(); });
        return points;
    }
    /// Along straight flights of 1 m/s, looked up at 500 Hz, each at most 4 m long.
    std::vector<Point> in_flight_order(std::size_t count) {
        constexpr double step_m = 0.002;
        std::vector<Point> points;
        while (points.size() < count) {
            Point p = one();
            const double angle = uniform(-3.14, 3.14);
            for (int i = 0; i < 2000 && points.size() < count && is_inside(p); ++i) {
                points.push_back(p);
                p = {p.x_m + step_m * std::cos(angle), p.z_m + step_m * std::sin(angle)};
            }
        }
        return points;
    }

 private:
    double uniform(double low, double high) { return uniform_between(engine_, low, high); }
    bool is_inside(const Point& p) const {
        const Bounds& all = map_.extent();
        return p.x_m >= all.x_low_m && p.x_m <= all.x_high_m && p.z_m >= all.z_low_m && p.z_m <= all.z_high_m &&
               map_.is_flyable(0, p.x_m, p.z_m);
    }

    const AeroMap& map_;
    std::mt19937_64 engine_{1};
};

void look_up(const AeroMap& map, const std::vector<Point>& points) {
    double sum = 0;
    for (const Point& p : points) {
        sum += map.factor(0, p.x_m, p.z_m);
    }
    keep(sum);
}

/// Repeated more often than the rest: it takes milliseconds, and a neighbour on the machine soon doubles it.
double look_up_s(const AeroMap& map, const std::vector<Point>& points) {
    constexpr int repetitions = 100;
    return best_of(repetitions, [&] { look_up(map, points); }) / static_cast<double>(points.size());
}

/// Mean over batches, before each of which the caches are emptied of all but the points.
double cold_look_up_s(const AeroMap& map, RandomPoints& random) {
    constexpr int batches = 20;
    constexpr std::size_t batch = 1024;
    double total_s = 0;
    for (int i = 0; i < batches; ++i) {
        const std::vector<Point> points = random.scattered(batch);
        empty_caches();
        double sum = 0;
        for (const Point& p : points) {
            sum += p.x_m + p.z_m;
        }
        keep(sum);
        total_s += best_of(1, [&] { look_up(map, points); });
    }
    return total_s / (batches * static_cast<double>(batch));
}

double cache_load_s(const AeroMap& map, int repetitions) {
    const auto folder = std::filesystem::temp_directory_path() / ("downwash-bench-" + std::to_string(getpid()));
    const MapCache cache(folder);
    cache.keep(map);
    bool is_found = true;
    const double least_s = best_of(
        repetitions, [&] { is_found = is_found && cache.find(map.layers(), map.plane(), map.extent()) != nullptr; });
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (!is_found) {
        throw std::runtime_error("a map that was kept was not found again");
    }
    return least_s;
}

/// One row of the first table.
struct MapFigures {
    std::string name;
    double build_s = 0, bytes = 0, growth_bytes = 0, load_s = 0;
    double cold_s = 0, scattered_s = 0, in_flight_order_s = 0, direct_s = 0;
};

MapFigures measured(const std::string& name, const Problem& problem, int repetitions) {
    MapFigures figures;
    figures.name = name;
    const auto model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map;
    figures.growth_bytes = peak_growth_bytes([&] { map = model->make_map(problem.bounds); });
    figures.build_s = best_of(repetitions, [&] { map = model->make_map(problem.bounds); });
    figures.bytes = static_cast<double>(map->memory_bytes());
    figures.load_s = cache_load_s(*map, repetitions);
    RandomPoints random(*map);
    figures.cold_s = cold_look_up_s(*map, random);
    constexpr std::size_t many = std::size_t{1} << 18U;
    figures.scattered_s = look_up_s(*map, random.scattered(many));
    figures.in_flight_order_s = look_up_s(*map, random.in_flight_order(many));
    const std::vector<Point> points = random.scattered(8192);
    figures.direct_s = best_of(repetitions,
                               [&] {
                                   double sum = 0;
                                   for (const Point& p : points) {
                                       sum += model->direct_factor(0, p.x_m, p.z_m);
                                   }
                                   keep(sum);
                               }) /
                       static_cast<double>(points.size());
    return figures;
}

std::string processor() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.rfind("model name", 0) == 0) {
            return line.substr(line.find(':') + 2);
        }
    }
    return "an unknown processor";
}

std::string megabytes(double bytes) {
    return bytes < 0 ? "unknown" : fmt::format("{:.1f} MB", 1e-6 * bytes);
}

std::vector<MapFigures> print_maps(const Options& options) {
    fmt::print(
        "## Maps\n\nOf the whole bounds, with the defaults. `peak`: how much the process grew while building. "
        "Look-ups: at random flyable points with emptied caches\n(`cold`), at 262,144 random flyable points over and "
        "over, and along flights of 1 m/s at 500 Hz. `direct`: the evaluation that a look-up replaces,\nat random "
        "flyable points.\n\n"
        "| problem | build | map | peak | load from cache | look-up, cold | random | in flight order | direct |\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    std::vector<std::string> files{options.ten_primitives};
    files.insert(files.end(), options.problems.begin(), options.problems.end());
    std::vector<MapFigures> all;
    for (const std::string& file : files) {
        const MapFigures f = measured(std::filesystem::path(file).stem(), read_problem(file), options.repetitions);
        fmt::print("| {} | {:.3f} s | {} | {} | {:.1f} ms | {:.0f} ns | {:.1f} ns | {:.1f} ns | {:.0f} ns |\n", f.name,
                   f.build_s, megabytes(f.bytes), megabytes(f.growth_bytes), 1e3 * f.load_s, 1e9 * f.cold_s,
                   1e9 * f.scattered_s, 1e9 * f.in_flight_order_s, 1e9 * f.direct_s);
        std::fflush(stdout);
        all.push_back(f);
    }
    return all;
}

/// Building alone.
struct BuildFigures {
    double build_s = 0, bytes = 0, growth_bytes = 0;
};

std::vector<BuildFigures> print_random_scenes(const Options& options) {
    const Problem bounds_of = read_problem(options.ten_primitives);
    std::vector<BuildFigures> all;
    for (unsigned seed = 1; seed <= options.random_scenes; ++seed) {
        const Problem problem = with_random_primitives(bounds_of, seed);
        const auto model = make_flight_model(problem);
        std::shared_ptr<const AeroMap> map;
        BuildFigures f;
        f.growth_bytes = peak_growth_bytes([&] { map = model->make_map(problem.bounds); });
        f.build_s = best_of(std::min(2, options.repetitions), [&] { map = model->make_map(problem.bounds); });
        f.bytes = static_cast<double>(map->memory_bytes());
        all.push_back(f);
    }
    std::sort(all.begin(), all.end(),
              [](const BuildFigures& a, const BuildFigures& b) { return a.build_s < b.build_s; });
    const auto largest = [&all](double BuildFigures::*figure) {
        double most = 0;
        for (const BuildFigures& f : all) {
            most = std::max(most, f.*figure);
        }
        return most;
    };
    const auto within =
        std::count_if(all.begin(), all.end(), [](const BuildFigures& f) { return f.build_s <= most_build_s; });
    fmt::print(
        "\n## Ten primitives at random\n\n{} scenes (seeds 1 to {}) of the same bounds with four boxes, three "
        "cylinders "
        "and three spheres at any attitude around the plane:\nbuilt in {:.2f} to {:.2f} s, median {:.2f} s, {} of {} "
        "within {:.0f} s; maps of at most {}, peak at most {}.\n",
        all.size(), all.size(), all.front().build_s, all.back().build_s, all[all.size() / 2].build_s, within,
        all.size(), most_build_s, megabytes(largest(&BuildFigures::bytes)),
        megabytes(largest(&BuildFigures::growth_bytes)));
    std::fflush(stdout);
    return all;
}

/// The mean time of a query at poses or points [s].
template <class Query>
double mean_s(const std::vector<Point>& points, int repetitions, const Query& query) {
    return best_of(repetitions,
                   [&] {
                       double sum = 0;
                       for (const Point& p : points) {
                           sum += query(p);
                       }
                       keep(sum);
                   }) /
           static_cast<double>(points.size());
}

void print_meshes(const Options& options) {
    fmt::print(
        "\n## Triangle meshes\n\nA pipe of 0.5 m diameter, 12 m long, as a closed mesh in the middle of the same "
        "bounds, "
        "nothing else. `above`, `below`: hubs at 0.1 to 0.6 m from the pipe\nand over or under it; `anywhere`: random "
        "flyable points. Clearance and collision (margin 0.05 m) of the whole robot at the same poses, with the arm "
        "level.\n\n"
        "| triangles | scene | map build | map | direct, above | below | anywhere | clearance, near | anywhere | "
        "collision, near | anywhere |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    const Problem bounds_of = read_problem(options.ten_primitives);
    struct Fineness {
        std::uint32_t around, along;
    };
    for (const auto& [around, along] : {Fineness{20, 24}, Fineness{50, 99}, Fineness{100, 499}}) {
        const Problem problem = with_pipe_mesh(bounds_of, around, along);
        const std::uint32_t triangles = 2 * around * (along + 1);
        const double scene_s = best_of(1, [&] { static_cast<void>(Scene(problem.obstacles)); });
        const auto model = make_flight_model(problem);
        std::shared_ptr<const AeroMap> map;
        const double build_s = best_of(1, [&] { map = model->make_map(problem.bounds); });
        RandomPoints random(*map);
        const std::vector<Point> anywhere = random.scattered(512);
        const Vector3& center_m = problem.obstacles.front().center_world_m;
        std::vector<Point> above;
        std::vector<Point> below;
        for (int i = 0; i < 256; ++i) {
            const double x_m = center_m[0] + 5 * std::sin(i);
            const double gap_m = 0.1 + 0.5 * i / 256;
            above.push_back({x_m, center_m[2] + 0.25 + gap_m});
            below.push_back({x_m, center_m[2] - 0.25 - gap_m});
        }
        const auto direct = [&](const Point& p) { return model->direct_factor(0, p.x_m, p.z_m); };
        const auto clearance = [&](const Point& p) { return model->collisions().clearance_m({p.x_m, p.z_m, 0, 0}); };
        const auto collision = [&](const Point& p) {
            return model->collisions().is_nearer_than({p.x_m, p.z_m, 0, 0}, 0.05) ? 1.0 : 0.0;
        };
        const int n = std::min(3, options.repetitions);
        fmt::print(
            "| {} | {:.0f} ms | {:.2f} s | {} | {:.1f} us | {:.1f} us | {:.1f} us | {:.1f} us | {:.1f} us | {:.1f} us "
            "| "
            "{:.1f} us |\n",
            triangles, 1e3 * scene_s, build_s, megabytes(static_cast<double>(map->memory_bytes())),
            1e6 * mean_s(above, n, direct), 1e6 * mean_s(below, n, direct), 1e6 * mean_s(anywhere, n, direct),
            1e6 * mean_s(above, n, clearance), 1e6 * mean_s(anywhere, n, clearance), 1e6 * mean_s(above, n, collision),
            1e6 * mean_s(anywhere, n, collision));
        std::fflush(stdout);
    }
}

/// Of the bridge, where it is among the problems.
std::optional<VolumeFigures> print_volume(const Options& options) {
    const auto bridge = std::find_if(options.problems.begin(), options.problems.end(), [](const std::string& file) {
        return std::filesystem::path(file).stem() == "bridge_inspection";
    });
    if (bridge == options.problems.end()) {
        return std::nullopt;
    }
    const VolumeFigures f = measured_volume(read_problem(*bridge), options.repetitions);
    fmt::print(
        "\n## A volume\n\n`VolumeMap` of 6 m x 2.5 m x 2 m under the deck of `bridge_inspection`, its underside, the "
        "walkway and a girder included; look-ups as above, at 65,536 flyable hubs.\n\n"
        "| build | map | peak | look-up, cold | random | in flight order | direct |\n|---|---|---|---|---|---|---|\n"
        "| {:.2f} s | {} | {} | {:.0f} ns | {:.1f} ns | {:.1f} ns | {:.0f} ns |\n",
        f.build_s, megabytes(f.bytes), megabytes(f.growth_bytes), 1e9 * f.cold_s, 1e9 * f.scattered_s,
        1e9 * f.in_flight_order_s, 1e9 * f.direct_s);
    std::fflush(stdout);
    return f;
}

void print_bound(const std::string& bound, const std::string& found, bool is_kept) {
    fmt::print("| {} | {} | {} |\n", bound, found, is_kept ? "kept" : "**not kept**");
}

void print_bounds(const std::vector<MapFigures>& maps, const std::vector<BuildFigures>& random_scenes,
                  const std::optional<VolumeFigures>& volume) {
    const MapFigures& ten = maps.front();
    fmt::print("\n## Bounds\n\n| bound | found | |\n|---|---|---|\n");
    print_bound("map of 20 m x 12 m with ten primitives built within 1 s on one core",
                fmt::format("{:.3f} s", ten.build_s), ten.build_s <= most_build_s);
    const double slowest_s = random_scenes.empty() ? 0 : random_scenes.back().build_s;
    print_bound("the slowest of the random scenes built within 1 s", fmt::format("{:.2f} s", slowest_s),
                slowest_s <= most_build_s);
    const double most = std::max(ten.bytes, ten.growth_bytes);
    print_bound("under 64 MB, building included", megabytes(most), most < most_bytes);
    const auto slowest_of = [&maps](double MapFigures::*figure) {
        return *std::max_element(maps.begin(), maps.end(),
                                 [figure](const MapFigures& a, const MapFigures& b) { return a.*figure < b.*figure; });
    };
    const auto print_look_up = [&](const std::string& kind, double MapFigures::*figure) {
        const MapFigures slowest = slowest_of(figure);
        print_bound("a look-up within 15 ns, " + kind + ", every problem above",
                    fmt::format("at most {:.1f} ns ({})", 1e9 * (slowest.*figure), slowest.name),
                    slowest.*figure <= most_look_up_s);
    };
    print_look_up("in flight order", &MapFigures::in_flight_order_s);
    print_look_up("at random points", &MapFigures::scattered_s);
    print_look_up("at random points with emptied caches", &MapFigures::cold_s);
    if (volume) {
        const auto print_volume_look_up = [](const std::string& kind, double time_s) {
            print_bound("a volume's look-up within 15 ns, " + kind, fmt::format("{:.1f} ns", 1e9 * time_s),
                        time_s <= most_look_up_s);
        };
        print_volume_look_up("in flight order", volume->in_flight_order_s);
        print_volume_look_up("at random points", volume->scattered_s);
        print_volume_look_up("at random points with emptied caches", volume->cold_s);
    }
}

void run(const Options& options) {
    fmt::print(
        "# What the aero map costs\n\nCommit {}, {}, {} core(s), g++ {}, {}. One thread; the least processor time of "
        "{} repetitions\n(look-ups: of 100; meshes: of 3, their maps built once; random scenes and volume: of 2), as "
        "other "
        "programs may have run at "
        "the same time. `bench/aero_map.sh` writes this page.\n\n",
        options.commit, processor(), sysconf(_SC_NPROCESSORS_ONLN), __VERSION__, DOWNWASH_BUILD_TYPE,
        options.repetitions);
    const std::vector<MapFigures> maps = print_maps(options);
    const std::vector<BuildFigures> random_scenes = print_random_scenes(options);
    if (options.with_meshes) {
        print_meshes(options);
    }
    const std::optional<VolumeFigures> volume = print_volume(options);
    print_bounds(maps, random_scenes, volume);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("What the aero map costs, as Markdown");
    app.add_option("ten_primitives", options.ten_primitives, "the problem that the bounds are for")->required();
    app.add_option("problems", options.problems, "others to measure");
    app.add_option("--commit", options.commit, "commit that the runs are made from");
    app.add_option("--repetitions", options.repetitions, "of which the best counts")->check(CLI::PositiveNumber);
    app.add_option("--random-scenes", options.random_scenes, "how many")->check(CLI::PositiveNumber);
    app.add_flag("!--no-meshes", options.with_meshes, "leave the meshes out");
    CLI11_PARSE(app, argc, argv);
    try {
        run(options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
