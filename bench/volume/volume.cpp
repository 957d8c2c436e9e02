// What the first look-ups of a volume cost, which fills where it is asked; what a flight of 20 s in a fresh girder bay
// pays for its cells; and how far look-ups at random flyable places are from direct evaluation. Prints Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../../tests/support/volume_scenes.hpp"
#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double max_first_s = 200e-6;
constexpr double max_first_in_mesh_s = 2e-3;
constexpr double max_flight_s = 0.2;
constexpr double max_error = 0.01;

struct Options {
    int first = 2000;
    int places = 100000;
};

/// Times of look-ups that looked into a box [s], from the shortest to the longest.
std::vector<double> first_look_ups(const test::VolumeSite& site, int count) {
    const auto effect = site.effect();
    const VolumeMap map = site.map(effect);
    test::Random random(5);
    std::vector<double> times_s;
    while (times_s.size() < static_cast<std::size_t>(count)) {
        const Vector3 hub_m = site.any(random);
        if (!effect->is_flyable(hub_m)) {
            continue;
        }
        const double filled_s = map.filling_s();
        const double begin_s = processor_time_s();
        keep(map.sided_factor(hub_m).all);
        const double time_s = processor_time_s() - begin_s;
        if (map.filling_s() != filled_s) {
            times_s.push_back(time_s);
        }
    }
    std::sort(times_s.begin(), times_s.end());
    return times_s;
}

double quantile(const std::vector<double>& sorted, double share) {
    return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

struct FlightCost {
    double whole_s, again_s;
};

/// A flight in a fresh bay, and the same once more.
FlightCost flight_cost() {
    const test::VolumeSite bay = test::girder_bay();
    const VolumeMap map({bay.effect(), bay.frame, {-6, 6, 0, 4}, bay.lateral_low_m, bay.lateral_high_m});
    const std::vector<Vector3> hubs_m = test::flight_in_girder_bay();
    const auto flown_s = [&] {
        const double begin_s = processor_time_s();
        for (const Vector3& hub_m : hubs_m) {
            keep(map.sided_factor(hub_m).all + (map.is_flyable(hub_m) ? 1 : 0));
        }
        return processor_time_s() - begin_s;
    };
    const double whole_s = flown_s();
    return {whole_s, flown_s()};
}

void run(const Options& options) {
    fmt::print(
        "# First look-ups of volumes\n\nCommit {}, {}, g++ {}, {}. Processor time of one thread. Sites of "
        "`tests/support/volume_scenes.hpp`; `bench/volume.sh` writes this page.\n\n"
        "## The first look-up in a box\n\n{} look-ups that find nothing filled, at random flyable places.\n\n"
        "| site | parts | median [us] | 95 % [us] | max [us] |\n|---|--:|--:|--:|--:|\n",
        source_commit(), processor(), __VERSION__, DOWNWASH_BUILD_TYPE, options.first);
    struct Row {
        test::VolumeSite site;
        double bound_s;
        std::vector<double> times_s;
    };
    std::vector<Row> rows{{test::girder_bay(), max_first_s, {}},
                          {test::pipe_rack(), max_first_s, {}},
                          {test::rough_deck(224), max_first_in_mesh_s, {}}};
    for (Row& row : rows) {
        row.times_s = first_look_ups(row.site, options.first);
        fmt::print("| {} | {} | {:.1f} | {:.0f} | {:.0f} |\n", row.site.name, row.site.effect()->scene().part_count(),
                   1e6 * quantile(row.times_s, 0.5), 1e6 * quantile(row.times_s, 0.95), 1e6 * row.times_s.back());
    }
    const FlightCost flight = flight_cost();
    fmt::print(
        "\n## A flight of 20 s\n\nSix rotors through two bays, under a girder between them, asked every hundredth of a "
        "second: {:.4f} s in fresh bays, {:.4f} s once more.\n\n"
        "## Random flyable places\n\n| site | places | greatest error | with K beyond 0.02 of 1 |\n|---|--:|--:|--:|\n",
        flight.whole_s, flight.again_s);
    double worst = 0;
    int misjudged = 0;
    for (const test::VolumeSite& site : {test::girder_bay(), test::pipe_rack(), test::rough_deck(24)}) {
        const VolumeMap map = site.map(site.effect());
        const test::VolumeComparison found = test::compared_at_random(site, map, options.places, 6);
        fmt::print("| {} | {} | {:.4f} | {} |\n", site.name, found.flyable, found.worst, found.felt);
        worst = std::max(worst, found.worst);
        misjudged += found.misjudged;
    }
    fmt::print("\n## Bounds\n\n| bound | found | |\n|---|---|---|\n");
    for (const Row& row : rows) {
        for (const auto& [name, share] : {std::pair("median", 0.5), std::pair("95 %", 0.95), std::pair("all", 1.0)}) {
            const double time_s = quantile(row.times_s, share);
            print_bound(
                fmt::format("the first look-up within {:.1f} ms in the {}, {}", 1e3 * row.bound_s, row.site.name, name),
                fmt::format("{:.3f} ms", 1e3 * time_s), time_s <= row.bound_s);
        }
    }
    print_bound("a flight of 20 s in fresh bays pays less than 0.2 s", fmt::format("{:.3f} s", flight.whole_s),
                flight.whole_s <= max_flight_s);
    print_bound("within 0.01 of direct evaluation at random flyable places", fmt::format("{:.4f}", worst),
                worst <= max_error);
    print_bound("flyable or not as direct evaluation says", fmt::format("{} differ", misjudged), misjudged == 0);
    if (worst > max_error || misjudged > 0) {
        throw std::runtime_error("a volume is not what direct evaluation says");
    }
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("What first look-ups of volumes cost, as Markdown; fails where a volume is not exact");
    app.add_option("--first", options.first, "first look-ups to measure at each site")->check(CLI::PositiveNumber);
    app.add_option("--places", options.places, "random flyable places at each site")->check(CLI::PositiveNumber);
    return run_program(app, argc, argv, [&options] { run(options); });
}
