// A small mission planner on an installed Downwash. It commands a vehicle in another process through a list of targets:
// it plans to the next one, sends the reference, follows the telemetry, and plans again when the deck turns out to be
// elsewhere or the vehicle is not where it should be. README.md describes the messages; mission.py is the same in Python.
// Exit codes: 0 all targets held, 1 broken off, 2 bad input, 3 the vehicle's flight has failed, 4 the vehicle is gone.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <downwash/planner/planner.hpp>
#include <downwash/problems/problem_reader.hpp>

#include "bridge.hpp"
#include "line_socket.hpp"

using namespace downwash;
using nlohmann::json;

namespace {

constexpr double telemetry_timeout_s = 2;
constexpr double lead_in_flight_s = 1;   ///< from the telemetry that a new plan is made from to its first tick
constexpr double lead_in_hover_s = 3;    ///< the same where there is time
constexpr std::uint64_t iterations = 1000;  ///< of a search in lock step, where time does not count
constexpr std::size_t readings = 50;     ///< of the range finder, for a mean that is exact to some millimetres
constexpr double max_drift_m = 0.15;
constexpr int max_attempts = 8;  ///< plans for one target

struct MissionFailed : std::runtime_error {
    using runtime_error::runtime_error;
};
struct FlightFailed : std::runtime_error {
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

/// A plan as a message, with the names of solution.json.
json columns_of(const Plan& plan) {
    json columns;
    for (const ReferenceKnot& knot : plan.reference) {
        const auto& [at, velocity, acceleration] = knot.point;
        columns["t_s"].push_back(static_cast<double>(knot.tick) * plan.tick_s);
        const char* const names[3][3] = {{"x_m", "vx_m_s", "ax_m_s2"},
                                         {"z_m", "vz_m_s", "az_m_s2"},
                                         {"arm_rad", "arm_rate_rad_s", "arm_acceleration_rad_s2"}};
        for (int axis = 0; axis < 3; ++axis) {
            columns[names[axis][0]].push_back(at[axis]);
            columns[names[axis][1]].push_back(velocity[axis]);
            columns[names[axis][2]].push_back(acceleration[axis]);
        }
    }
    return columns;
}

class Mission {
 public:
    Mission(LineSocket& link, const Problem& bridge, bool replans)
        : link_(link),
          replans_(replans),
          bridge_(bridge),
          planner_(first_leg(bridge), {.threads = 2, .stop_at_first_solution = true}) {}

    void run() {
        const json hello = receive();
        if (hello.at("type") != "hello") {
            throw ConnectionLost("the vehicle does not say hello");
        }
        tick_s_ = hello.at("tick_s");
        is_lock_step_ = hello.at("lock_step");
        read_telemetry();
        for (target_ = 0; target_ < goals_of(bridge_).size(); ++target_) {
            attempts_ = 0;
            target_ == 0 ? plan_first() : replan("next target", {{}, {}, target()});
            fly_to_target();
        }
        link_.send(json{{"type", "end"}}.dump());
        std::printf("%8.2f s  all targets held, %d plans in flight because of the deck\n", now_s(), deck_replans_);
    }

 private:
    /// A reference that the vehicle follows, and the vehicle with which it begins.
    struct Command {
        std::int64_t from_tick = 0;
        Start start;
        Plan plan;
        Advice advice = Advice::follow;

        [[nodiscard]] bool leads_to_target() const { return advice == Advice::follow || advice == Advice::keep; }
        [[nodiscard]] std::int64_t end_tick() const { return from_tick + plan.reference.back().tick; }
    };

    static Problem first_leg(Problem bridge) {
        bridge.goal = goals_of(bridge).front();
        bridge.stops.clear();
        bridge.planner.max_iterations = iterations;
        return bridge;
    }

    [[nodiscard]] Goal target() const { return goals_of(bridge_)[target_]; }
    [[nodiscard]] double now_s() const { return static_cast<double>(tick_) * tick_s_; }
    [[nodiscard]] std::int64_t ticks(double time_s) const { return std::llround(time_s / tick_s_); }

    /// Flies until the target is held, and plans again whenever that is needed.
    void fly_to_target() {
        for (;;) {
            read_telemetry();
            const bool has_arrived = tick_ >= following_.end_tick() + ticks(target().hold_s);
            if (const auto lower_m = deck_is_lower_m(); lower_m != 0) {
                const Goal before = target();
                lower_deck(bridge_, lower_m);
                ++deck_replans_;
                char reason[80];
                std::snprintf(reason, sizeof(reason), "the deck is %.3f m lower than believed", lower_m);
                const bool has_moved = target().end_effector->z_m != before.end_effector->z_m;
                replan(reason, {{deck_of(bridge_)}, {}, has_moved ? std::optional(target()) : std::nullopt});
            } else if (replans_ && tick_ % 10 == 0 && drift_m() > max_drift_m) {
                replan("the vehicle has drifted", {});
            } else if (has_arrived && following_.leads_to_target()) {
                if (const double error_m = target_error_m(); error_m <= target().end_effector->tolerance_m) {
                    std::printf("%8.2f s  target %zu held, %.3f m off\n", now_s(), target_ + 1, error_m);
                    return;
                }
                replan("the target was missed", {{}, {}, target()});
            } else if (has_arrived) {
                replan("the vehicle has stopped", {{}, {}, target()});
            }
        }
    }

    void plan_first() {
        const Solution& solution = planner_.solve();
        if (solution.status != Status::solved) {
            throw MissionFailed("no plan to the first target");
        }
        const std::int64_t from_tick = tick_ + ticks(lead_in_flight_s);
        say("first plan", Advice::follow, *solution.plan);
        send({from_tick, planner_.problem().start, *solution.plan, Advice::follow});
        following_ = {tick_, planner_.problem().start,
                      Plan{{{0, at_rest(planner_.problem().start.configuration())}}, tick_s_}, Advice::stop};
        wait_until(from_tick);
    }

    /// Plans from where the vehicle will be a moment later, and sends each answer: first how to stop, then better ones.
    /// The vehicle follows the last that comes in time.
    void replan(const std::string& reason, SceneChange change) {
        if (++attempts_ > max_attempts) {
            throw MissionFailed("too many plans for one target");
        }
        const bool is_hovering = tick_ >= following_.end_tick();
        const double lead_s = is_hovering ? lead_in_hover_s : lead_in_flight_s;
        const std::int64_t from_tick = tick_ + ticks(lead_s);
        const Start start = predicted(from_tick);
        if (following_.leads_to_target()) {
            planner_.adopt(following_.plan);
        } else if (!change.goal) {
            change.goal = target();  // nothing is left of the way to it
        }
        ReplanOptions options;
        options.max_iterations = iterations;
        if (!is_lock_step_) {
            options.time_limit_s = 0.8 * lead_s;
        }
        options.on_answer = [&](const Answer& answer) { send({from_tick, start, answer.plan, answer.advice}); };
        const Answer answer = planner_.replan(start, from_tick - following_.from_tick, change, options);
        say(reason, answer.advice, answer.plan);
        wait_until(from_tick);
    }

    void say(const std::string& reason, Advice advice, const Plan& plan) const {
        std::printf("%8.2f s  target %zu, %s: %s, %.2f s to (%.3f, %.3f) m\n", now_s(), target_ + 1, reason.c_str(),
                    std::string(name_of(advice)).c_str(), plan.duration_s(), plan.last().x_m, plan.last().z_m);
        std::fflush(stdout);
    }

    /// The vehicle at a tick to come: as the model has it, moved by how far the real one is off now.
    [[nodiscard]] Start predicted(std::int64_t at_tick) const {
        Start start = planner_.predicted(following_.start, following_.plan, at_tick - following_.from_tick);
        const auto [x_m, z_m] = offset_m();
        start.x_m += x_m;
        start.z_m += z_m;
        return start;
    }

    /// How far the vehicle is from where the model has it, by the last telemetry.
    [[nodiscard]] std::pair<double, double> offset_m() const {
        const std::vector<json> rows = last_rows(10);
        std::vector<double> x_m, z_m;
        for (const json& row : rows) {
            x_m.push_back(row.at("x_m"));
            z_m.push_back(row.at("z_m"));
        }
        // Of the same time on average, as both move evenly within a tenth of a second.
        const std::int64_t seen_tick = tick_ - following_.from_tick - ticks(bridge_.robot.controller.delay_s);
        const auto model_at = [&](std::int64_t tick) {
            return planner_.predicted(following_.start, following_.plan, std::max<std::int64_t>(0, tick));
        };
        const Start last = model_at(seen_tick);
        const Start first = model_at(seen_tick + 1 - std::ssize(rows));
        return {rounded(mean(x_m) - 0.5 * (first.x_m + last.x_m)), rounded(mean(z_m) - 0.5 * (first.z_m + last.z_m))};
    }

    [[nodiscard]] double drift_m() const {
        const auto [x_m, z_m] = offset_m();
        return std::hypot(x_m, z_m);
    }

    /// By how much the deck is lower than believed, once the range finder has said so often enough; else 0.
    double deck_is_lower_m() {
        const json& row = rows_.back();
        if (!row.at("range_up_m").is_null()) {
            // The estimated height is as old as the estimator is late.
            const double z_m = row.at("z_m").get<double>() +
                               bridge_.robot.controller.delay_s * row.at("vz_m_s").get<double>();
            const double lower_m = underside_m(deck_of(bridge_)) - z_m - row.at("range_up_m").get<double>();
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
        const bool is_significant = std::abs(mean_m) > std::max(0.02, 4 * error_m);
        return replans_ && is_significant ? rounded(mean_m) : 0;
    }

    /// How far the end effector was from the target over the last second.
    [[nodiscard]] double target_error_m() const {
        std::vector<double> x_m, z_m;
        for (const json& row : last_rows(static_cast<std::size_t>(ticks(1)))) {
            const double angle = row.at("pitch_rad").get<double>() + row.at("arm_rad").get<double>();
            x_m.push_back(row.at("x_m").get<double>() + bridge_.robot.arm.length_m * std::cos(angle));
            z_m.push_back(row.at("z_m").get<double>() - bridge_.robot.arm.length_m * std::sin(angle));
        }
        const EndEffectorGoal at = *target().end_effector;
        return std::hypot(mean(x_m) - at.x_m, mean(z_m) - at.z_m);
    }

    [[nodiscard]] std::vector<json> last_rows(std::size_t count) const {
        return {rows_.end() - static_cast<std::ptrdiff_t>(std::min(count, rows_.size())), rows_.end()};
    }

    void send(const Command& command) {
        link_.send(json{{"type", "reference"},
                        {"id", sent_.size()},
                        {"from_tick", command.from_tick},
                        {"reference", columns_of(command.plan)}}
                       .dump());
        sent_[sent_.size()] = command;
    }

    void wait_until(std::int64_t tick) {
        while (tick_ < tick) {
            read_telemetry();
        }
        if (accepted_.from_tick == tick) {
            following_ = accepted_;
        }
    }

    json receive() {
        const auto line = link_.receive(telemetry_timeout_s);
        if (!line) {
            throw ConnectionLost("no telemetry for " + std::to_string(telemetry_timeout_s) + " s");
        }
        json message = json::parse(*line, nullptr, false);
        if (!message.is_object() || !message.contains("type")) {
            throw ConnectionLost("the vehicle sent what is no message: " + line->substr(0, 60));
        }
        return message;
    }

    /// Reads until the next row of telemetry.
    void read_telemetry() {
        if (is_lock_step_ && !rows_.empty()) {
            link_.send(json{{"type", "go"}}.dump());
        }
        for (;;) {
            json message = receive();
            const std::string type = message.at("type");
            if (type == "telemetry") {
                tick_ = message.at("tick");
                rows_.push_back(std::move(message));
                return;
            }
            if (type == "accepted") {
                accepted_ = sent_.at(message.at("id"));
            } else if (type == "rejected") {
                std::printf("%8.2f s  the vehicle rejects a reference: %s\n", now_s(),
                            message.at("reason").get<std::string>().c_str());
            } else if (type == "ended") {
                throw FlightFailed("the vehicle's flight has ended: " + message.at("outcome").get<std::string>());
            }
        }
    }

    LineSocket& link_;
    bool replans_;
    Problem bridge_;  ///< as it is believed to be
    Planner planner_;
    double tick_s_ = 0.01;
    bool is_lock_step_ = false;
    std::int64_t tick_ = 0;
    std::vector<json> rows_;  ///< of telemetry
    std::map<std::size_t, Command> sent_;
    Command accepted_, following_;
    std::size_t target_ = 0;
    int attempts_ = 0;
    int deck_replans_ = 0;
    std::vector<double> lower_m_;  ///< readings of how much lower than believed the deck is
};

}  // namespace

int main(int count, char** words) {
    const bool replans = !(count == 4 && std::string(words[3]) == "--no-replanning");
    if (count != 3 && replans) {
        std::fprintf(stderr, "usage: %s PROBLEM.yaml SOCKET [--no-replanning]\n", words[0]);
        return 2;
    }
    try {
        const Problem bridge = read_problem(words[1]);
        LineSocket link = LineSocket::connect_to(words[2], 10);
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
    } catch (const json::exception& error) {
        std::fprintf(stderr, "mission: contact with the vehicle is lost: it sent a message of another kind: %s\n",
                     error.what());
        return 4;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
