// Whether the judge and an execution tell the same story of flights in space: random references through random scenes,
// half of them in a random world. Prints Markdown; every flight counts, disagreements are listed.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "../../tests/support/random.hpp"
#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/bench/statistics.hpp"
#include "downwash/controllers/space_duration.hpp"
#include "downwash/judge/space_judge.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_world_parameters.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

constexpr double clearance_tolerance_m = 0.01;
constexpr double cost_tolerance = 0.01;
/// References begin at least so far from everything, and head for places as far.
constexpr double start_margin_m = 0.4;

struct Options {
    std::vector<std::string> robots;
    int flights = 500;
    std::uint64_t seed = 1;
};

/// A site of 12 x 12 x 5 m: a floor, a deck on two girders, and some things in the air.
std::vector<Obstacle> random_site(test::Random& random) {
    std::vector<Obstacle> site{{"floor", Box{{14, 14, 0.2}}, {0, 0, -0.1}, {}},
                               {"deck", Box{{random.uniform(2, 6), 14, 0.2}}, {random.uniform(0, 3), 0, 4.3}, {}}};
    for (int girder = 0; girder < 2; ++girder) {
        site.push_back({fmt::format("girder_{}", girder),
                        Box{{random.uniform(0.2, 0.5), 14, random.uniform(0.3, 0.9)}},
                        {random.uniform(-1, 4), 0, 3.9},
                        {}});
    }
    for (int thing = 0; thing < 4; ++thing) {
        const Vector3 center_m{random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(0.5, 4)};
        const double size_m = random.uniform(0.2, 0.8);
        Obstacle obstacle{fmt::format("thing_{}", thing), Sphere{size_m / 2}, center_m, {}};
        if (thing < 2) {
            obstacle.shape = Box{{size_m, random.uniform(0.2, 2), random.uniform(0.2, 1)}};
        } else if (thing < 3) {
            obstacle.shape = Cylinder{size_m / 2, random.uniform(0.5, 4)};
        }
        site.push_back(obstacle);
    }
    return site;
}

SpaceMotion at_rest(const SpacePoint& point) {
    SpaceMotion motion;
    motion.position_m = {point.position[space::x], point.position[space::y], point.position[space::z]};
    const double half = 0.5 * point.position[space::yaw];
    motion.attitude = {std::cos(half), 0, 0, std::sin(half)};
    std::copy_n(point.position + space::first_joint, max_joints, motion.joints_rad.begin());
    return motion;
}

/// A random reference from rest to rest, over up to two points that it passes in motion.
class RandomReferences {
 public:
    RandomReferences(const SpaceRobot& robot, const SpaceChecker& checker, test::Random& random)
        : robot_(robot), checker_(checker), random_(random) {}

    /// A place some way from everything.
    SpacePoint free_place() {
        SpacePoint point = place();
        while (is_near_something(point)) {
            point = place();
        }
        return point;
    }
    SpacePlan from(const SpacePoint& start) {
        SpaceMotionLimits limits;
        limits.max_speed_m_s = random_.uniform(0.5, 3);
        limits.max_acceleration_m_s2 = random_.uniform(0.5, 5);
        limits.max_jerk_m_s3 = random_.uniform(4, 40);
        SpacePlan plan;
        plan.tick_s = 1 / robot_.controller.rate_hz;
        plan.joints = robot_.joints();
        plan.reference.push_back({0, start});
        const int pieces = random_.integer(1, 3);
        for (int piece = 1; piece <= pieces; ++piece) {
            const SpaceKnot before = plan.reference.back();
            SpacePoint next = free_place();
            const double share = random_.uniform(0.2, 0.6);  // of the way: flights of some seconds
            for (int axis = 0; axis < 3; ++axis) {
                next.position[axis] =
                    before.point.position[axis] + share * (next.position[axis] - before.point.position[axis]);
            }
            for (int axis = 0; axis < 3 && piece < pieces; ++axis) {
                next.velocity[axis] = random_.uniform(-0.3, 0.3) * limits.max_speed_m_s;
            }
            const std::int64_t ticks = shortest_ticks(before.point, next, limits, plan.tick_s);
            plan.reference.push_back({before.tick + ticks, next});
        }
        return plan;
    }

 private:
    SpacePoint place() {
        SpacePoint point;
        point.position[space::x] = random_.uniform(-5, 5);
        point.position[space::y] = random_.uniform(-5, 5);
        point.position[space::z] = random_.uniform(1, 3.5);
        point.position[space::yaw] = random_.uniform(-std::numbers::pi, std::numbers::pi);
        for (int i = 0; i < robot_.joints(); ++i) {
            const SpaceLinkLimits& link = robot_.links[static_cast<std::size_t>(i)];
            point.position[space::first_joint + i] = link.is_limited
                                                         ? random_.uniform(link.lower_limit_rad, link.upper_limit_rad)
                                                         : random_.uniform(-1.5, 1.5);
        }
        return point;
    }
    [[nodiscard]] bool is_near_something(const SpacePoint& point) const {
        const SpaceMotion motion = at_rest(point);
        return checker_.is_nearer_than({motion.position_m, motion.attitude, motion.joints_rad}, start_margin_m);
    }

    const SpaceRobot& robot_;
    const SpaceChecker& checker_;
    test::Random& random_;
};

judge::SpaceJudgedMotion judged(const SpaceMotion& motion) {
    return {motion.position_m,   motion.attitude,         motion.joints_rad,
            motion.velocity_m_s, motion.body_rates_rad_s, motion.joint_rates_rad_s};
}

/// One row of the table.
struct Count {
    std::string robot;
    bool is_in_world = false;
    int flights = 0, agreed = 0;
    std::map<std::string, int> outcomes{};  ///< of the execution
    double worst_place_m = 0;               ///< between both at the same tick, where both end ok
    double worst_clearance_m = 0;           ///< difference, where both end ok
    double worst_cost = 0;                  ///< relative difference of energy, where both end ok
};

class Comparison {
 public:
    explicit Comparison(const Options& options) : options_(options) {}

    void fly(const std::string& file) {
        const SpaceRobot robot = read_space_robot(file);
        AeroSettings aero;
        test::Random random(options_.seed);
        Count counts[2] = {{robot.name, false}, {robot.name, true}};
        for (int number = 0; number < options_.flights; ++number) {
            const std::vector<Obstacle> site = random_site(random);
            const auto scene = std::make_shared<const Scene>(site);
            const SpaceChecker checker(scene, shape_of(robot));
            simulation::DirectSpaceEffect effect(scene, aero, robot);
            RandomReferences references(robot, checker, random);
            const SpacePlan plan = references.from(references.free_place());
            const SpaceMotion start = at_rest(plan.at(0));
            const bool is_in_world = number % 2 == 1;
            std::optional<SpaceWorld> world;
            if (is_in_world) {
                world = draw_space_world(robot.uncertainty.value_or(Uncertainty{}), robot, options_.seed,
                                         static_cast<std::uint64_t>(number));
            }
            SpaceFlightSettings settings;
            settings.world = world.value_or(SpaceWorld{});
            settings.effect = &effect;
            settings.aero = simulation::space_aero(aero, robot.rotor_radius_m);
            settings.checker = &checker;
            settings.hold_ticks = std::lround(1 / plan.tick_s);
            settings.settles = is_in_world;
            const SpaceFlight flight = downwash::fly(robot, plan, start, settings);
            judge::SpaceFlightConditions conditions;
            conditions.start = judged(start);
            conditions.hold_ticks = settings.hold_ticks;
            conditions.world = world;
            compare(number, flight, judge::SpaceJudge(robot, site, aero).fly(plan, conditions), counts[is_in_world]);
        }
        rows_.insert(rows_.end(), counts, counts + 2);
        fmt::print(stderr, "{}: {} of {} and {} of {} agree\n", robot.name, counts[0].agreed, counts[0].flights,
                   counts[1].agreed, counts[1].flights);
    }

    void print() const {
        fmt::print(
            "# The judge beside the execution in space\n\nCommit {}, g++ {}, {}, seed {}. `bench/space_agreement.sh` "
            "writes this page.\n\n"
            "Random references of one to three pieces at random speeds, 2 to 20 s long, in random sites: floor, deck, "
            "two girders and four things\nin the air, with the default surface effects evaluated directly. Flights "
            "agree where both end with the same outcome and, where they are `ok`, the least\nclearance is the same "
            "within 1 cm, and the duration and the energy within 1 %. Both fly the whole reference or until their own "
            "rules end it.\nShares with 95 % Wilson intervals; every flight counts.\n\n"
            "| robot | world | agree | outcomes of the execution | largest difference of place, mm | of clearance, mm "
            "| of energy, % |\n|---|---|---|---|--:|--:|--:|\n",
            source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, options_.seed);
        for (const Count& row : rows_) {
            std::string outcomes;
            for (const auto& [name, count] : row.outcomes) {
                outcomes += fmt::format("{}{} {}", outcomes.empty() ? "" : ", ", count, name);
            }
            const Share share = share_of(static_cast<std::size_t>(row.agreed), static_cast<std::size_t>(row.flights));
            fmt::print("| {} | {} | {}/{} [{:.1f}, {:.1f} %] | {} | {:.3g} | {:.3g} | {:.2g} |\n", row.robot,
                       row.is_in_world ? "drawn" : "nominal", row.agreed, row.flights, 100 * share.low,
                       100 * share.high, outcomes, 1e3 * row.worst_place_m, 1e3 * row.worst_clearance_m,
                       100 * row.worst_cost);
        }
        fmt::print("\n{} flights disagree{}\n", disagreements_.size(), disagreements_.empty() ? "." : ":\n");
        for (const std::string& disagreement : disagreements_) {
            fmt::print("- {}\n", disagreement);
        }
    }

 private:
    void compare(int number, const SpaceFlight& flight, const judge::SpaceJudgedFlight& mine, Count& count) {
        ++count.flights;
        ++count.outcomes[std::string(name_of(flight.outcome))];
        bool agrees = name_of(flight.outcome) == judge::name_of(mine.outcome);
        double place_m = 0, clearance_m = 0, cost = 0;
        if (agrees && flight.outcome == Outcome::ok) {
            for (std::size_t i = 0; i < std::min(flight.rows.size(), mine.rows.size()); ++i) {
                const Vector3 apart = flight.rows[i].motion.position_m - mine.rows[i].motion.position_m;
                place_m = std::max(place_m, std::sqrt(dot(apart, apart)));
            }
            clearance_m = std::abs(flight.min_clearance_m - mine.min_clearance_m);
            cost = std::max(std::abs(flight.energy_j / mine.energy_j - 1),
                            std::abs(flight.duration_s / mine.duration_s - 1));
            agrees = clearance_m <= clearance_tolerance_m && cost <= cost_tolerance;
            count.worst_place_m = std::max(count.worst_place_m, place_m);
            count.worst_clearance_m = std::max(count.worst_clearance_m, clearance_m);
            count.worst_cost = std::max(count.worst_cost, cost);
        }
        count.agreed += agrees ? 1 : 0;
        if (!agrees) {
            disagreements_.push_back(fmt::format(
                "{}, reference {}, {}: execution {} after {:.2f} s, clearance {:.4f} m; judge {} after {:.2f} s, "
                "clearance {:.4f} m; energy differs by {:.3g} %",
                count.robot, number, count.is_in_world ? "drawn world" : "nominal", name_of(flight.outcome),
                flight.duration_s, flight.min_clearance_m, judge::name_of(mine.outcome), mine.duration_s,
                mine.min_clearance_m, 100 * cost));
        }
    }

    const Options& options_;
    std::vector<Count> rows_;
    std::vector<std::string> disagreements_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Flights in space by the execution and by the judge, as Markdown");
    app.add_option("robots", options.robots, "robot files in space")->required();
    app.add_option("--flights", options.flights, "per robot")->check(CLI::PositiveNumber);
    app.add_option("--seed", options.seed, "of references, sites and worlds");
    return run_program(app, argc, argv, [&options] {
        Comparison comparison(options);
        for (const std::string& robot : options.robots) {
            comparison.fly(robot);
        }
        comparison.print();
    });
}
