// The cost of the aero map: building, memory and look-ups beside direct evaluation, for scenes of primitives, the
// shipped problems, triangle meshes and a volume. Prints Markdown, with the bounds for the map and whether they are
// kept.

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/measuring.hpp"
#include "../support/scenes.hpp"
#include "downwash/aeromap/map_cache.hpp"
#include "downwash/aeromap/volume_map.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/problem_model.hpp"
#include "downwash/problems/problem_reader.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double max_build_s = 1;
constexpr double max_bytes = 64e6;
constexpr double max_look_up_s = 15e-9;

struct Options {
    std::string ten_primitives;
    std::vector<std::string> problems;
    int repetitions = 5;
    unsigned random_scenes = 20;
    bool with_meshes = true;
};

/// Part of the plane of motion, or a block of space about it.
struct Region {
    Bounds extent;
    double lateral_m = 0;  ///< to either side

    [[nodiscard]] bool holds(const Vector3& at) const {
        return at[0] >= extent.x_low_m && at[0] <= extent.x_high_m && std::abs(at[1]) <= lateral_m &&
               at[2] >= extent.z_low_m && at[2] <= extent.z_high_m;
    }
};

/// Random flyable hubs of a region, as (x, lateral, z) in the coordinates of the plane.
class RandomHubs {
 public:
    RandomHubs(const Region& region, std::function<bool(const Vector3&)> is_flyable)
        : region_(region), is_flyable_(std::move(is_flyable)) {}

    std::vector<Vector3> scattered(std::size_t count) {
        std::vector<Vector3> hubs(count);
        std::generate(hubs.begin(), hubs.end(), [this] { return one(); });
        return hubs;
    }
    /// Along straight flights of 1 m/s, looked up at 500 Hz, each at most 4 m long.
    std::vector<Vector3> in_flight_order(std::size_t count) {
        constexpr double step_m = 0.002;
        std::vector<Vector3> hubs;
        while (hubs.size() < count) {
            Vector3 at = one();
            const double heading = region_.lateral_m > 0 ? random_.uniform(-3.14, 3.14) : 0;
            const double climb = region_.lateral_m > 0 ? random_.uniform(-0.5, 0.5) : random_.uniform(-3.14, 3.14);
            for (int i = 0; i < 2000 && hubs.size() < count && region_.holds(at) && is_flyable_(at); ++i) {
                hubs.push_back(at);
                at = {at[0] + step_m * std::cos(heading) * std::cos(climb),
                      at[1] + step_m * std::sin(heading) * std::cos(climb), at[2] + step_m * std::sin(climb)};
            }
        }
        return hubs;
    }

 private:
    Vector3 one() {
        const Bounds& all = region_.extent;
        while (true) {
            const Vector3 at{random_.uniform(all.x_low_m, all.x_high_m),
                             random_.uniform(-region_.lateral_m, region_.lateral_m),
                             random_.uniform(all.z_low_m, all.z_high_m)};
            if (is_flyable_(at)) {
                return at;
            }
        }
    }

    Region region_;
    std::function<bool(const Vector3&)> is_flyable_;
    test::Random random_{1};
};

/// The minimum of the mean time of a query over the repetitions [s].
template <class Query>
double mean_s(const std::vector<Vector3>& hubs, int repetitions, const Query& query) {
    return best_of(repetitions,
                   [&] {
                       double sum = 0;
                       for (const Vector3& hub : hubs) {
                           sum += query(hub);
                       }
                       keep(sum);
                   }) /
           static_cast<double>(hubs.size());
}

/// The cost of a map: times [s] and memory [bytes].
struct MapFigures {
    std::string name;
    double build_s = 0, bytes = 0, growth_bytes = 0, load_s = 0;
    double cold_s = 0, scattered_s = 0, in_flight_order_s = 0, direct_s = 0;
};

template <class Map>
void measure_build(MapFigures& figures, int repetitions, std::shared_ptr<const Map>& map,
                   const std::function<std::shared_ptr<const Map>()>& build) {
    figures.growth_bytes = peak_growth_bytes([&] { map = build(); });
    figures.build_s = best_of(repetitions, [&] { map = build(); });
    figures.bytes = static_cast<double>(map->memory_bytes());
}

/// @param times of a look-up: repeated more often than the rest, since a neighbour on the machine soon doubles it
template <class LookUp, class Direct>
void measure_look_ups(MapFigures& figures, RandomHubs& random, std::size_t count, int times, int repetitions,
                      const LookUp& look_up, const Direct& direct) {
    constexpr int cold_batches = 20;  // before each of which the caches are emptied of all but the hubs
    for (int i = 0; i < cold_batches; ++i) {
        const std::vector<Vector3> hubs = random.scattered(1024);
        empty_caches();
        keep(mean_s(hubs, 1, [](const Vector3& hub) { return hub[0] + hub[2]; }));
        figures.cold_s += mean_s(hubs, 1, look_up) / cold_batches;
    }
    figures.scattered_s = mean_s(random.scattered(count), times, look_up);
    figures.in_flight_order_s = mean_s(random.in_flight_order(count), times, look_up);
    figures.direct_s = mean_s(random.scattered(8192), repetitions, direct);
}

double cache_load_s(const AeroMap& map, int repetitions) {
    const auto folder = std::filesystem::temp_directory_path() / ("downwash-bench-" + std::to_string(getpid()));
    const MapCache cache(folder);
    cache.keep(map);
    bool is_found = true;
    const double min_s = best_of(
        repetitions, [&] { is_found = is_found && cache.find(map.layers(), map.plane(), map.extent()) != nullptr; });
    std::error_code ignored;
    std::filesystem::remove_all(folder, ignored);
    if (!is_found) {
        throw std::runtime_error("a map that was kept was not found again");
    }
    return min_s;
}

/// Flyable hubs of a map's first layer.
RandomHubs random_hubs(const AeroMap& map) {
    return {{map.extent()}, [&map](const Vector3& hub) { return map.is_flyable(0, hub[0], hub[2]); }};
}

MapFigures measured(const std::string& name, const Problem& problem, int repetitions) {
    MapFigures figures;
    figures.name = name;
    const auto model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map;
    measure_build<AeroMap>(figures, repetitions, map, [&] { return model->make_whole_map(problem.bounds); });
    figures.load_s = cache_load_s(*map, repetitions);
    RandomHubs random = random_hubs(*map);
    measure_look_ups(
        figures, random, std::size_t{1} << 18U, 100, repetitions,
        [&map](const Vector3& hub) { return map->factor(0, hub[0], hub[2]); },
        [&model](const Vector3& hub) { return model->direct_factor(0, hub[0], hub[2]); });
    return figures;
}

/// A volume of 30 m3 under the deck of the bridge: its underside, the walkway's top and edges, the cross girder.
MapFigures measured_volume(const Problem& bridge, int repetitions) {
    const Region block{{-8, -2, 8, 10}, 1.25};
    const auto model = make_flight_model(bridge);
    const auto effect = std::make_shared<const DirectEffect>(model->effect(0));
    const auto in_world = [&model](const Vector3& hub) { return model->plane().to_world(hub[0], hub[1], hub[2]); };
    MapFigures figures;
    std::shared_ptr<const VolumeMap> map;
    measure_build<VolumeMap>(figures, std::min(2, repetitions), map, [&] {
        auto filled =
            std::make_shared<const VolumeMap>(effect, model->plane(), block.extent, -block.lateral_m, block.lateral_m);
        filled->fill();
        return filled;
    });
    RandomHubs random(block, [&](const Vector3& hub) { return effect->is_flyable(in_world(hub)); });
    measure_look_ups(
        figures, random, std::size_t{1} << 16U, 30, repetitions,
        [&](const Vector3& hub) { return map->factor(in_world(hub)); },
        [&](const Vector3& hub) { return effect->factor(in_world(hub)); });
    return figures;
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

std::vector<MapFigures> print_random_scenes(const Options& options) {
    const Problem bounds_of = read_problem(options.ten_primitives);
    std::vector<MapFigures> all;
    for (unsigned seed = 1; seed <= options.random_scenes; ++seed) {
        const Problem problem = with_random_primitives(bounds_of, seed);
        const auto model = make_flight_model(problem);
        std::shared_ptr<const AeroMap> map;
        measure_build<AeroMap>(all.emplace_back(), std::min(2, options.repetitions), map,
                               [&] { return model->make_whole_map(problem.bounds); });
    }
    std::sort(all.begin(), all.end(), [](const MapFigures& a, const MapFigures& b) { return a.build_s < b.build_s; });
    const auto largest = [&all](double MapFigures::*figure) {
        double max = 0;
        for (const MapFigures& f : all) {
            max = std::max(max, f.*figure);
        }
        return max;
    };
    const auto within =
        std::count_if(all.begin(), all.end(), [](const MapFigures& f) { return f.build_s <= max_build_s; });
    fmt::print(
        "\n## Ten primitives at random\n\n{} scenes (seeds 1 to {}) of the same bounds with four boxes, three "
        "cylinders "
        "and three spheres at any attitude around the plane:\nbuilt in {:.2f} to {:.2f} s, median {:.2f} s, {} of {} "
        "within {:.0f} s; maps of at most {}, peak at most {}.\n",
        all.size(), all.size(), all.front().build_s, all.back().build_s, all[all.size() / 2].build_s, within,
        all.size(), max_build_s, megabytes(largest(&MapFigures::bytes)), megabytes(largest(&MapFigures::growth_bytes)));
    std::fflush(stdout);
    return all;
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
        const double build_s = best_of(1, [&] { map = model->make_whole_map(problem.bounds); });
        const std::vector<Vector3> anywhere = random_hubs(*map).scattered(512);
        const Vector3& center_m = problem.obstacles.front().center_world_m;
        std::vector<Vector3> above, below;
        for (int i = 0; i < 256; ++i) {
            const double x_m = center_m[0] + 5 * std::sin(i);
            const double gap_m = 0.1 + 0.5 * i / 256;
            above.push_back({x_m, 0, center_m[2] + 0.25 + gap_m});
            below.push_back({x_m, 0, center_m[2] - 0.25 - gap_m});
        }
        const auto direct = [&](const Vector3& p) { return model->direct_factor(0, p[0], p[2]); };
        const auto clearance = [&](const Vector3& p) { return model->collisions().clearance_m({p[0], p[2], 0, 0}); };
        const auto collision = [&](const Vector3& p) {
            return model->collisions().is_nearer_than({p[0], p[2], 0, 0}, 0.05) ? 1.0 : 0.0;
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

/// The map of the bridge, where it is among the problems.
std::optional<MapFigures> print_volume(const Options& options) {
    const auto bridge = std::find_if(options.problems.begin(), options.problems.end(), [](const std::string& file) {
        return std::filesystem::path(file).stem() == "bridge_inspection";
    });
    if (bridge == options.problems.end()) {
        return std::nullopt;
    }
    const MapFigures f = measured_volume(read_problem(*bridge), options.repetitions);
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

void print_bounds(const std::vector<MapFigures>& maps, const std::vector<MapFigures>& random_scenes,
                  const std::optional<MapFigures>& volume) {
    const MapFigures& ten = maps.front();
    fmt::print("\n## Bounds\n\n| bound | found | |\n|---|---|---|\n");
    print_bound("map of 20 m x 12 m with ten primitives built within 1 s on one core",
                fmt::format("{:.3f} s", ten.build_s), ten.build_s <= max_build_s);
    const double slowest_s = random_scenes.empty() ? 0 : random_scenes.back().build_s;
    print_bound("the slowest of the random scenes built within 1 s", fmt::format("{:.2f} s", slowest_s),
                slowest_s <= max_build_s);
    const double bytes = std::max(ten.bytes, ten.growth_bytes);
    print_bound("under 64 MB, building included", megabytes(bytes), bytes < max_bytes);
    const auto slowest_of = [&maps](double MapFigures::*figure) {
        return *std::max_element(maps.begin(), maps.end(),
                                 [figure](const MapFigures& a, const MapFigures& b) { return a.*figure < b.*figure; });
    };
    const auto print_look_up = [&](const std::string& kind, double MapFigures::*figure) {
        const MapFigures slowest = slowest_of(figure);
        print_bound("a look-up within 15 ns, " + kind + ", every problem above",
                    fmt::format("at most {:.1f} ns ({})", 1e9 * (slowest.*figure), slowest.name),
                    slowest.*figure <= max_look_up_s);
    };
    print_look_up("in flight order", &MapFigures::in_flight_order_s);
    print_look_up("at random points", &MapFigures::scattered_s);
    print_look_up("at random points with emptied caches", &MapFigures::cold_s);
    if (volume) {
        const auto print_volume_look_up = [](const std::string& kind, double time_s) {
            print_bound("a volume's look-up within 15 ns, " + kind, fmt::format("{:.1f} ns", 1e9 * time_s),
                        time_s <= max_look_up_s);
        };
        print_volume_look_up("in flight order", volume->in_flight_order_s);
        print_volume_look_up("at random points", volume->scattered_s);
        print_volume_look_up("at random points with emptied caches", volume->cold_s);
    }
}

void run(const Options& options) {
    fmt::print(
        "# Cost of the aero map\n\nCommit {}, {}, g++ {}, {}. One thread; the minimum processor time of "
        "{} repetitions\n(look-ups: of 100; meshes: of 3, their maps built once; random scenes and volume: of 2), as "
        "other "
        "programs may have run at "
        "the same time. `bench/aero_map.sh` writes this page.\n\n",
        source_commit(), processor(), __VERSION__, DOWNWASH_BUILD_TYPE, options.repetitions);
    const std::vector<MapFigures> maps = print_maps(options);
    const std::vector<MapFigures> random_scenes = print_random_scenes(options);
    if (options.with_meshes) {
        print_meshes(options);
    }
    const std::optional<MapFigures> volume = print_volume(options);
    print_bounds(maps, random_scenes, volume);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The cost of the aero map, as Markdown");
    app.add_option("ten_primitives", options.ten_primitives, "the problem that the bounds are for")->required();
    app.add_option("problems", options.problems, "other problems to measure");
    app.add_option("--repetitions", options.repetitions, "of which the best counts")->check(CLI::PositiveNumber);
    app.add_option("--random-scenes", options.random_scenes, "number of random scenes")->check(CLI::PositiveNumber);
    app.add_flag("!--no-meshes", options.with_meshes, "leave the meshes out");
    return run_program(app, argc, argv, [&options] { run(options); });
}
