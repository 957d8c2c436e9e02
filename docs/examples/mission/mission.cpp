// A small mission planner on an installed Downwash. It commands a vehicle in another process through a list of targets:
// it plans to the next one, sends the reference, follows the telemetry, and plans again when the deck turns out to be
// elsewhere or the vehicle is not where it should be. mission.py is the same in Python.
// Exit codes: 0 all targets held, 1 broken off, 2 bad input, 3 the vehicle's flight has failed, 4 the vehicle is gone.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <downwash/planner/planner.hpp>

#include "bridge.hpp"
#include "vehicle_link.hpp"

using namespace downwash;

namespace {

constexpr double lead_in_flight_s = 1;      ///< from the telemetry that a plan is made from to its first tick
constexpr double lead_in_hover_s = 3;       ///< the same where there is time
constexpr double planning_share = 0.8;      ///< of the lead, for planning
constexpr std::uint64_t iterations = 3000;  ///< of a search in lock step, where time does not count
constexpr std::size_t readings = 50;        ///< of the range finder for a mean: exact to some millimetres
constexpr double max_drift_m = 0.15;
constexpr int max_attempts = 6;  ///< plans for one target

struct MissionFailed : std::runtime_error {
    using runtime_error::runtime_error;
};

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    return sum / static_cast<double>(values.size());
}

/// To a tenth of a millimetre: sensors say no more.
double rounded(double length_m) {
    return std::round(1e4 * length_m) / 1e4;
}

/// The way to the first target, with limits for the search.
Problem first_leg(Problem bridge, bool is_lock_step) {
    bridge.goal = goals_of(bridge).front();
    bridge.goals_before.clear();
    bridge.planner.max_iterations.reset();
    bridge.planner.time_limit_s.reset();
    if (is_lock_step) {
        bridge.planner.max_iterations = iterations;
    } else {
        bridge.planner.time_limit_s = planning_share * lead_in_hover_s;
    }
    return bridge;
}

SolveOptions search_options() {
    SolveOptions options;
    options.threads = 2;
    options.stop_at_first_solution = true;
    return options;
}

class Mission {
 public:
    Mission(VehicleLink& link, const Problem& bridge, bool replans)
        : link_(link),
          replans_(replans),
          bridge_(bridge),
          planner_(first_leg(bridge, link.is_lock_step()), search_options()) {}

    void run() {
        read_telemetry();
        for (target_ = 0; target_ < goals_of(bridge_).size(); ++target_) {
            attempts_ = 0;
            target_ == 0 ? plan_first() : replan("next target", {{}, {}, target()});
            fly_to_target();
        }
        link_.end();
        std::printf("%8.2f s  all targets held, plans because of the deck: %d\n", now_s(), deck_plans_);
    }

 private:
    [[nodiscard]] Goal target() const { return goals_of(bridge_)[target_]; }
    [[nodiscard]] EndEffectorGoal place() const { return std::get<EndEffectorGoal>(target().kind); }
    [[nodiscard]] std::int64_t now() const { return rows_.back().tick; }
    [[nodiscard]] double now_s() const { return static_cast<double>(now()) * link_.tick_s(); }
    [[nodiscard]] std::int64_t ticks(double time_s) const { return std::llround(time_s / link_.tick_s()); }
    [[nodiscard]] std::vector<Telemetry> last_rows(std::ptrdiff_t count) const {
        return {rows_.end() - std::min(count, std::ssize(rows_)), rows_.end()};
    }

    void read_telemetry() { rows_.push_back(link_.next()); }

    /// Flies until the target is held, and plans again whenever that is needed.
    void fly_to_target() {
        for (;;) {
            read_telemetry();
            const bool has_arrived = now() >= following_.end_tick() + ticks(target().hold_s);
            const double lower_m = deck_is_lower_m();
            if (replans_ && lower_m != 0) {
                replan_below(lower_m);
            } else if (replans_ && now() % 10 == 0 && drift_m() > max_drift_m) {
                replan("the vehicle has drifted", {});
            } else if (has_arrived && !following_.leads_to_target()) {
                replan("the vehicle has stopped", {});
            } else if (has_arrived) {
                const double error_m = target_error_m();
                if (error_m <= place().tolerance_m) {
                    std::printf("%8.2f s  target %zu held, %.3f m off\n", now_s(), target_ + 1, error_m);
                    return;
                }
                replan("the target was missed", {{}, {}, target()});
            }
        }
    }

    /// Plans from the problem's start, where the vehicle hovers.
    void plan_first() {
        const Start start = planner_.problem().start;
        following_ = {now(), start, Plan{{{0, at_rest(start.at)}}, link_.tick_s()}, Advice::stop};
        const Solution& solution = planner_.solve();
        if (solution.status != Status::solved) {
            throw MissionFailed("no plan to the first target");
        }
        const Command command{now() + ticks(lead_in_hover_s), start, *solution.plan, Advice::follow};
        link_.send(command);
        say("first plan", command.advice, command.plan);
        wait_until(command.from_tick);
    }

    void replan_below(double lower_m) {
        const double before_m = place().z_m;
        lower_deck(bridge_, lower_m);
        SceneChange change{{deck_of(bridge_)}, {}, {}};
        if (place().z_m != before_m) {
            change.goal = target();
        }
        char reason[80];
        std::snprintf(reason, sizeof(reason), "the deck is %.3f m lower than believed", lower_m);
        ++deck_plans_;
        replan(reason, change);
    }

    /// Plans from where the vehicle will be a moment later, and sends each answer: first how to stop, then better ones.
    /// The vehicle follows the last one that comes in time.
    void replan(const std::string& reason, SceneChange change) {
        if (++attempts_ > max_attempts) {
            throw MissionFailed("too many plans for one target");
        }
        // In a hover there is time, and more with each attempt.
        const double lead_s = now() >= following_.end_tick() ? attempts_ * lead_in_hover_s : lead_in_flight_s;
        const std::int64_t from_tick = now() + ticks(lead_s);
        const Start start = predicted(from_tick);
        if (following_.leads_to_target()) {
            planner_.adopt(following_.plan);
        } else {
            change.goal = target();  // nothing is left of the way to it
        }
        ReplanOptions options;
        if (link_.is_lock_step()) {
            options.max_iterations = static_cast<std::uint64_t>(attempts_) * iterations;
        } else {
            options.time_limit_s = planning_share * lead_s;
        }
        std::exception_ptr lost;  // which must not leave the planner halfway
        options.on_answer = [&](const Answer& answer) {
            try {
                link_.send({from_tick, start, answer.plan, answer.advice});
            } catch (...) {
                lost = std::current_exception();
            }
        };
        const Answer answer = planner_.replan(start, from_tick - following_.from_tick, change, options);
        if (lost) {
            std::rethrow_exception(lost);
        }
        say(reason, answer.advice, answer.plan);
        wait_until(from_tick);
    }

    void say(const std::string& reason, Advice advice, const Plan& plan) const {
        std::printf("%8.2f s  target %zu, %s: %s, %.2f s to (%.3f, %.3f) m\n", now_s(), target_ + 1, reason.c_str(),
                    std::string(name_of(advice)).c_str(), plan.duration_s(), plan.last()[plane::x],
                    plan.last()[plane::z]);
        std::fflush(stdout);
    }

    void wait_until(std::int64_t tick) {
        while (now() < tick) {
            read_telemetry();
        }
        if (link_.accepted().from_tick == tick) {
            following_ = link_.accepted();
        }
    }

    /// The vehicle at a tick, as the model has it.
    [[nodiscard]] Start modelled(std::int64_t tick) const {
        return planner_.predicted(following_.start, following_.plan,
                                  std::max<std::int64_t>(0, tick - following_.from_tick));
    }

    /// The vehicle at a tick to come: as the model has it, moved by how far the real one is off now.
    [[nodiscard]] Start predicted(std::int64_t tick) const {
        Start start = modelled(tick);
        const auto [x_m, z_m] = offset_m();
        start.at[plane::x] += x_m;
        start.at[plane::z] += z_m;
        return start;
    }

    /// How far the vehicle is from where the model has it, on average over the last tenth of a second.
    [[nodiscard]] std::pair<double, double> offset_m() const {
        std::vector<double> x_m, z_m;
        for (const Telemetry& row : last_rows(10)) {
            x_m.push_back(row.x_m);
            z_m.push_back(row.z_m);
        }
        // The estimator is late. Within so short a time the vehicle moves almost evenly.
        const std::int64_t seen = now() - ticks(bridge_.robot.controller.delay_s);
        const Configuration last = modelled(seen).at;
        const Configuration first = modelled(seen + 1 - std::ssize(x_m)).at;
        return {rounded(mean(x_m) - 0.5 * (first[plane::x] + last[plane::x])),
                rounded(mean(z_m) - 0.5 * (first[plane::z] + last[plane::z]))};
    }

    [[nodiscard]] double drift_m() const {
        const auto [x_m, z_m] = offset_m();
        return std::hypot(x_m, z_m);
    }

    /// By how much the deck is lower than believed, once the range finder has said so often enough; else 0.
    double deck_is_lower_m() {
        const Telemetry& row = rows_.back();
        if (row.range_up_m) {
            const double z_m = row.z_m + bridge_.robot.controller.delay_s * row.vz_m_s;  // the estimator is late
            const double lower_m = underside_m(deck_of(bridge_)) - z_m - *row.range_up_m;
            if (std::abs(lower_m) < 0.3) {  // else the beam has met something else
                lower_m_.push_back(lower_m);
            }
        }
        if (lower_m_.size() < readings) {
            return 0;
        }
        const double mean_m = mean(lower_m_);
        double squares = 0;
        for (const double each : lower_m_) {
            squares += (each - mean_m) * (each - mean_m);
        }
        const double error_m = std::sqrt(squares / static_cast<double>(readings * (readings - 1)));
        lower_m_.clear();
        return std::abs(mean_m) > std::max(0.02, 4 * error_m) ? rounded(mean_m) : 0;
    }

    /// How far the end effector was from the target, on average over the last second.
    [[nodiscard]] double target_error_m() const {
        std::vector<double> x_m, z_m;
        const double length_m = bridge_.robot.arm.length_m;
        for (const Telemetry& row : last_rows(ticks(1))) {
            x_m.push_back(row.x_m + length_m * std::cos(row.pitch_rad + row.arm_rad));
            z_m.push_back(row.z_m - length_m * std::sin(row.pitch_rad + row.arm_rad));
        }
        return std::hypot(mean(x_m) - place().x_m, mean(z_m) - place().z_m);
    }

    VehicleLink& link_;
    bool replans_;
    Problem bridge_;  ///< as it is believed to be
    Planner planner_;
    Command following_;
    std::vector<Telemetry> rows_;
    std::vector<double> lower_m_;  ///< readings of how much lower than believed the deck is
    std::size_t target_ = 0;
    int attempts_ = 0;
    int deck_plans_ = 0;
};

}  // namespace

int main(int count, char** words) {
    const bool replans = !(count == 4 && std::string(words[3]) == "--no-replanning");
    if (count != 3 && replans) {
        std::fprintf(stderr, "usage: %s PROBLEM.yaml SOCKET [--no-replanning]\n", words[0]);
        return 2;
    }
    try {
        const Problem bridge = read_bridge(words[1]);
        VehicleLink link(words[2]);
        Mission(link, bridge, replans).run();
        return 0;
    } catch (const MissionFailed& error) {
        std::fprintf(stderr, "mission: broken off: %s\n", error.what());
        return 1;
    } catch (const FlightFailed& error) {
        std::fprintf(stderr, "mission: %s\n", error.what());
        return 3;
    } catch (const ConnectionLost& error) {
        std::fprintf(stderr, "mission: contact with the vehicle is lost: %s\n", error.what());
        return 4;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
