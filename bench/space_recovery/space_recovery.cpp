// How vehicles in space recover that are thrown at any attitude: with and without an arm, with little and much thrust,
// by either control law. Prints Markdown; every throw counts, and failures are listed.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "recovery.hpp"

using namespace downwash;
using namespace downwash::bench;

namespace {

/// Half of the throws have rates that the rotors stop within half a turn.
constexpr double max_effort = 2;
constexpr double turn_deg = 180 / std::numbers::pi;

struct Options {
    std::string robot;
    int vehicles = 1000;
    std::uint64_t seed = 1;
};

/// The throws of one robot under one law.
struct Case {
    SpaceRobot robot;
    double thrust_over_weight = 0;
    Vector3 stoppable_rad_s{};
    std::size_t thrown[2] = {}, recovered[2] = {};                 ///< with an effort up to 1, and beyond
    std::size_t home = 0;                                          ///< of those that recovered
    std::vector<double> upright_s = {}, home_s = {}, lost_m = {};  ///< of those that recovered, or came home
    double joint_beyond_rad = 0;

    [[nodiscard]] std::string_view law() const {
        return std::visit([](const auto& law) { return std::string_view(law.name); }, robot.controller.law);
    }
};

double quantile(std::vector<double> values, double q) {
    std::sort(values.begin(), values.end());
    return values.empty() ? 0 : values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

double tilt_deg(const SpaceMotion& motion) {
    const auto& q = motion.attitude;
    return turn_deg * std::acos(std::clamp(1 - 2 * (q[1] * q[1] + q[2] * q[2]), -1.0, 1.0));
}

std::string text_of(const Vector3& v) {
    return fmt::format("({:.2f}, {:.2f}, {:.2f})", v[0], v[1], v[2]);
}

class Throws {
 public:
    explicit Throws(const Options& options) : options_(options) {
        const SpaceRobot shipped = read_space_robot(options.robot);
        for (const SpaceRobot& robot : {without_arm(shipped), shipped}) {
            for (const double ratio : {1.3, 2.0}) {
                const SpaceRobot scaled = with_thrust_over_weight(robot, ratio);
                for (const SpaceRobot& flown : {scaled, under_cascade(scaled)}) {
                    cases_.push_back({flown, ratio, stoppable_rates_rad_s(flown)});
                }
            }
        }
    }

    void fly() {
        for (Case& each : cases_) {
            test::Random random(options_.seed);  // the same throws in every case, in units of what it stops
            for (int number = 0; number < options_.vehicles; ++number) {
                add(each, number, drawn_throw(each.stoppable_rad_s, max_effort, random));
            }
            fmt::print(stderr, "{}: {} of {} and {} of {} recover\n", name_of(each), each.recovered[0], each.thrown[0],
                       each.recovered[1], each.thrown[1]);
        }
    }

    void print() const {
        fmt::print(
            "# Recovery from any attitude\n\nCommit {}, g++ {}, {}, {}, seed {}. `bench/space_recovery.sh` writes this "
            "page.\n\n"
            "Vehicles made of {} are thrown {} times each: at attitudes drawn evenly from all, with up to 1 m/s along "
            "each axis, and\nwith body rates of a random direction and effort. The reference rests where they are "
            "thrown. They fly in free air for {:.0f} s, or until they are home for a second.\nWith thrust limits "
            "scaled, all rotors together lift 1.3 or 2 times the weight; without joints the arm is left out. The model "
            "inversion has the shipped gains, PX4's cascade\nthose that the same bandwidths give.\n\n"
            "**Stoppable rates.** About each axis, the rate that the rotors stop within half a turn; beyond it the "
            "shortest way back to upright is another one by then. The\nvehicle turns on at w for the time t of a tick, "
            "the delay and the rotors' lag, and then the greatest torque M of the rotors slows it:\nw t + I w^2 / (2 "
            "M) "
            "= pi. The effort of a throw is the root of the sum of (rate / stoppable rate)^2, drawn evenly from 0 to "
            "{:.0f}.\n\n"
            "**Recovered** is who is upright in the last second: tilted by less than 60 degrees, no body rate above 2 "
            "rad/s, sinking by less than 2 m/s. *Upright* is when the first such\nsecond began. *Home* is who is "
            "within "
            "0.1 m of the place for a second, slower than 0.1 m/s and tilted by less than 2 degrees. Times and heights "
            "are medians and 95 %\nquantiles of those that recover. Joints were at most {:.0f} degrees beyond their "
            "limits.\n\n",
            source_commit(), __VERSION__, DOWNWASH_BUILD_TYPE, processor(), options_.seed, cases_.front().robot.name,
            options_.vehicles, max_recovery_s, max_effort, turn_deg * most_beyond_rad());
        fmt::print(
            "| joints | thrust / weight | law | stoppable rates, rad/s | recovered, effort up to 1 | beyond | upright "
            "after, s | 95 % | height lost, m | 95 % | most | home | after, s | 95 % |\n"
            "|--:|--:|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
        for (const Case& each : cases_) {
            const Vector3& rates = each.stoppable_rad_s;
            fmt::print(
                "| {} | {:.1f} | {} | {:.1f}, {:.1f}, {:.1f} | {} | {} | {:.2f} | {:.2f} | {:.1f} | {:.1f} | "
                "{:.1f} | {} | {:.1f} | {:.1f} |\n",
                each.robot.joints(), each.thrust_over_weight, each.law(), rates[0], rates[1], rates[2],
                share_text(each, 0), share_text(each, 1), quantile(each.upright_s, 0.5), quantile(each.upright_s, 0.95),
                quantile(each.lost_m, 0.5), quantile(each.lost_m, 0.95), quantile(each.lost_m, 1), each.home,
                quantile(each.home_s, 0.5), quantile(each.home_s, 0.95));
        }
        fmt::print("\n| bound | found | |\n| --- | --- | --- |\n");
        for (const Case& each : cases_) {
            print_bound(fmt::format("{}: up to the stoppable rates none fails", name_of(each)),
                        fmt::format("{} of {}", each.thrown[0] - each.recovered[0], each.thrown[0]),
                        each.recovered[0] == each.thrown[0]);
        }
        fmt::print("\nThrows that did not recover: {}{}\n", failures_.size(), failures_.empty() ? "." : "\n");
        for (const std::string& failure : failures_) {
            fmt::print("- {}\n", failure);
        }
    }

 private:
    static std::string name_of(const Case& each) {
        return fmt::format("{} joints, {:.1f}, {}", each.robot.joints(), each.thrust_over_weight, each.law());
    }
    static std::string share_text(const Case& each, std::size_t is_beyond) {
        return fmt::format("{}/{} ({:.1f} %)", each.recovered[is_beyond], each.thrown[is_beyond],
                           100.0 * static_cast<double>(each.recovered[is_beyond]) /
                               static_cast<double>(std::max<std::size_t>(1, each.thrown[is_beyond])));
    }
    [[nodiscard]] double most_beyond_rad() const {
        double most = 0;
        for (const Case& each : cases_) {
            most = std::max(most, each.joint_beyond_rad);
        }
        return most;
    }
    void add(Case& each, int number, const Throw& thrown) {
        const Recovery found = recover(each.robot, thrown.motion);
        const std::size_t is_beyond = thrown.effort > 1 ? 1 : 0;
        ++each.thrown[is_beyond];
        each.joint_beyond_rad = std::max(each.joint_beyond_rad, found.joint_beyond_rad);
        if (found.is_upright) {
            ++each.recovered[is_beyond];
            each.upright_s.push_back(found.upright_s);
            each.lost_m.push_back(found.height_lost_m);
            if (found.is_home) {
                ++each.home;
                each.home_s.push_back(found.home_s);
            }
            return;
        }
        const std::array<double, 4>& a = thrown.motion.attitude;
        failures_.push_back(fmt::format(
            "{}, throw {}: effort {:.3f}, attitude ({:.4f}, {:.4f}, {:.4f}, {:.4f}), rates {} rad/s, velocity {} m/s; "
            "at the end {} m away, tilted by {:.0f} degrees, rates {} rad/s, velocity {} m/s",
            name_of(each), number, thrown.effort, a[0], a[1], a[2], a[3], text_of(thrown.motion.body_rates_rad_s),
            text_of(thrown.motion.velocity_m_s), text_of(found.end.position_m), tilt_deg(found.end),
            text_of(found.end.body_rates_rad_s), text_of(found.end.velocity_m_s)));
    }

 private:
    const Options& options_;
    std::vector<Case> cases_;
    std::vector<std::string> failures_;
};

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Vehicles in space thrown at any attitude, as Markdown");
    app.add_option("robot", options.robot, "robot file in space, with an arm")->required();
    app.add_option("--vehicles", options.vehicles, "thrown of each kind")->check(CLI::PositiveNumber);
    app.add_option("--seed", options.seed, "of the throws");
    return run_program(app, argc, argv, [&options] {
        Throws throws(options);
        throws.fly();
        throws.print();
    });
}
