// A simulated vehicle in a process of its own: the judge's plant and controller, noisy sensors, and a deck that is
// lower than the mission planner was told. It listens on a socket, sends telemetry at every control tick, and follows
// the references that it is sent. README.md describes the messages. In the end it says how the flight truly went. Exit
// codes: 0 the flight was good, 2 bad input, 3 it was not, 4 the connection was lost.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <downwash/judge/simulated_vehicle.hpp>
#include <downwash/planner/planner.hpp>
#include <downwash/scene/scene.hpp>
#include <downwash/simulation/world_parameters.hpp>

#include "bridge.hpp"
#include "line_socket.hpp"

using namespace downwash;
using nlohmann::json;

namespace {

struct Options {
    std::string problem, socket;
    std::string log;  ///< file for the true flight; empty: none
    double deck_lower_m = 0.05;
    std::uint64_t world = 2;         ///< of the problem's uncertainty, that the vehicle flies in
    std::optional<double> gust_m_s;  ///< gusts other than the problem's
    bool is_lock_step = false;       ///< waits for the mission planner at every tick
    std::string failure;             ///< die, silence or garbage, to see what the mission planner does ...
    double failure_s = 3;            ///< ... so long after the start
    double min_clearance_m = 0.03;   ///< that the vehicle has to keep; the planner plans with 0.05 m
    double mission_timeout_s = 120;  ///< in lock step a search may take its time
};

/// References, each from a control tick on. They follow each other without jumps.
class Commands {
 public:
    /// Begins with a hover.
    Commands(const Configuration& start, double tick_s) { plans_[0] = Plan{{{0, at_rest(start)}}, tick_s}; }

    [[nodiscard]] ReferencePoint at(std::int64_t tick) const {
        const auto& [from, plan] = *std::prev(plans_.upper_bound(tick));
        return plan.at(tick - from);
    }

    /// Takes a reference in place of all that begin no earlier. @return why not; empty if it is taken
    std::string take(std::int64_t now, std::int64_t from, const Plan& plan) {
        if (from <= now) {
            return "it begins at tick " + std::to_string(from) + ", and that is over";
        }
        const ReferencePoint before = at(from);
        const ReferencePoint& first = plan.reference.front().point;
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(first.position[axis] - before.position[axis]) < 0.01) ||
                !(std::abs(first.velocity[axis] - before.velocity[axis]) < 0.05)) {
                return "it jumps";
            }
        }
        plans_.erase(plans_.lower_bound(from), plans_.end());
        plans_[from] = plan;
        return "";
    }

 private:
    std::map<std::int64_t, Plan> plans_;  ///< by their first ticks
};

/// The plan in a message, with the names of solution.json. @throws json::exception, std::runtime_error
Plan plan_of(const json& columns, double tick_s) {
    const auto column = [&](const char* name) { return columns.at(name).get<std::vector<double>>(); };
    const std::vector<double> number[] = {column("x_m"),     column("z_m"),     column("arm_rad"),
                                          column("vx_m_s"),  column("vz_m_s"),  column("arm_rate_rad_s"),
                                          column("ax_m_s2"), column("az_m_s2"), column("arm_acceleration_rad_s2")};
    Plan plan{{}, tick_s};
    for (const double t_s : column("t_s")) {
        const std::size_t row = plan.reference.size();
        constexpr double longest_s = 3600;
        const std::int64_t tick = t_s >= 0 && t_s <= longest_s ? std::llround(t_s / tick_s) : -1;
        if (row == 0 ? tick != 0 : tick <= plan.reference.back().tick) {
            throw std::runtime_error("its times do not rise from 0, or are longer than an hour");
        }
        const auto at = [&](std::size_t i) { return number[i].at(row); };
        plan.reference.push_back({tick, {{at(0), at(1), at(2)}, {at(3), at(4), at(5)}, {at(6), at(7), at(8)}}});
    }
    if (plan.reference.empty()) {
        throw std::runtime_error("it has no rows");
    }
    return plan;
}

/// The bridge as it is: its deck is lower.
Problem true_problem(const Options& options) {
    Problem problem = read_bridge(options.problem);
    lower_deck(problem, options.deck_lower_m);
    return plannable(problem).problem;
}

/// The world that the vehicle flies in; the one that is believed where the problem has no uncertainty.
judge::FlightConditions conditions_of(const Problem& problem, const Options& options) {
    judge::FlightConditions conditions;
    if (problem.uncertainty) {
        conditions.world = draw_world(*problem.uncertainty, problem.robot, problem.planner.seed, options.world);
        conditions.world->gust_m_s = options.gust_m_s.value_or(conditions.world->gust_m_s);
    }
    return conditions;
}

class Vehicle {
 public:
    explicit Vehicle(const Options& options)
        : options_(options),
          problem_(true_problem(options)),
          scene_(problem_.obstacles),
          vehicle_(problem_, conditions_of(problem_, options)),
          tick_s_(1 / problem_.robot.controller.rate_hz),
          commands_(problem_.start.at, tick_s_),
          held_(goals_of(problem_).size(), false) {}

    /// Flies until the mission planner ends the mission, or the flight ends by itself.
    void fly(LineSocket& link) {
        link_ = &link;
        link_->send(json{{"type", "hello"}, {"tick_s", tick_s_}, {"lock_step", options_.is_lock_step}}.dump());
        auto due = std::chrono::steady_clock::now();
        for (bool goes_on = true; goes_on; ++tick_) {
            fail();
            link_->send(telemetry().dump());
            if (is_ended_by_mission()) {
                break;
            }
            goes_on = vehicle_.follow(commands_.at(tick_), commands_.at(tick_ + 1));
            watch_targets();
            due += std::chrono::nanoseconds(std::llround(1e9 * tick_s_));
            if (!options_.is_lock_step) {
                std::this_thread::sleep_until(due);
            }
        }
        link_->send(json{{"type", "ended"}, {"outcome", judge::name_of(vehicle_.flight().outcome)}}.dump());
        link_->drain(5);
    }

    /// Writes the true flight, with the names of trajectory.csv.
    void write_log() const {
        std::FILE* const file = std::fopen(options_.log.c_str(), "w");
        if (file == nullptr) {
            throw std::runtime_error(options_.log + ": cannot be written");
        }
        std::fputs("t_s,ref_x_m,ref_z_m,ref_arm_rad,x_m,z_m,pitch_rad,arm_rad,clearance_m\n", file);
        for (const judge::JudgedRow& row : vehicle_.flight().rows) {
            std::fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", row.t_s, row.reference_x_m,
                         row.reference_z_m, row.reference_arm_rad, row.pose.x_m, row.pose.z_m, row.pose.pitch_rad,
                         row.pose.arm_rad, row.clearance_m);
        }
        if (std::fclose(file) != 0) {
            throw std::runtime_error(options_.log + ": cannot be written");
        }
    }

    /// Says how the flight went. @return whether it was good
    bool report() const {
        const judge::JudgedFlight& flight = vehicle_.flight();
        const bool is_safe = flight.outcome == judge::Outcome::ok && flight.min_clearance_m >= options_.min_clearance_m;
        std::printf("vehicle: %.1f s flown, outcome %s, least clearance %.3f m, targets held:", flight.duration_s,
                    std::string(judge::name_of(flight.outcome)).c_str(), flight.min_clearance_m);
        bool are_held = true;
        for (std::size_t i = 0; i < held_.size(); ++i) {
            are_held = are_held && held_[i];
            std::printf("%s", held_[i] ? (" " + std::to_string(i + 1)).c_str() : "");
        }
        std::printf("\nvehicle: %s\n", is_safe && are_held ? "a good flight" : "not a good flight");
        return is_safe && are_held;
    }

 private:
    /// What a vehicle can send: state estimate, rotor speeds as thrusts, and a range finder that looks up.
    json telemetry() {
        const judge::SensorReadings now = vehicle_.readings();
        json row{{"type", "telemetry"},
                 {"tick", tick_},
                 {"x_m", now.pose.x_m},
                 {"z_m", now.pose.z_m},
                 {"pitch_rad", now.pose.pitch_rad},
                 {"arm_rad", now.pose.arm_rad},
                 {"vx_m_s", now.vx_m_s},
                 {"vz_m_s", now.vz_m_s},
                 {"pitch_rate_rad_s", now.pitch_rate_rad_s},
                 {"arm_rate_rad_s", now.arm_rate_rad_s},
                 {"range_up_m", range_up()}};
        for (std::size_t i = 0; i < now.rotor_thrust_n.size(); ++i) {
            row["rotor_" + std::to_string(i + 1) + "_lag_n"] = now.rotor_thrust_n[i];
        }
        return row;
    }

    /// Distance from the centre of mass to the surface above, with noise; null farther than 3 m.
    json range_up() {
        constexpr double reach_m = 3;
        constexpr double noise_m = 0.02;
        const PlanarPose& pose = vehicle_.flight().rows.back().pose;
        const Vector3 here = problem_.plane.to_world(pose.x_m, 0, pose.z_m);
        double range_m = reach_m;
        for (std::size_t part = 0; part < scene_.part_count(); ++part) {
            const Interval solid = scene_.vertical_extent(part, here[0], here[1]);
            if (!solid.empty() && solid.low > here[2]) {
                range_m = std::min(range_m, solid.low - here[2]);
            }
        }
        const double noise = noise_m * normal_(random_);
        return range_m < reach_m ? json(range_m + noise) : json(nullptr);
    }

    /// Reads what the mission planner has sent; in lock step until it says go.
    bool is_ended_by_mission() {
        for (;;) {
            const auto line = link_->receive(options_.is_lock_step ? options_.mission_timeout_s : 0);
            if (!line) {
                if (options_.is_lock_step) {
                    throw ConnectionLost("no word from the mission planner");
                }
                return false;
            }
            const json message = json::parse(*line, nullptr, false);
            const bool has_type = message.is_object() && message.contains("type") && message["type"].is_string();
            const std::string type = has_type ? message["type"] : "";
            if (type == "end" || type == "go") {
                return type == "end";
            }
            const std::string why = type == "reference" ? taken(message) : "it is no message";
            const json id = message.is_object() && message.contains("id") ? message["id"] : json(nullptr);
            link_->send(why.empty() ? json{{"type", "accepted"}, {"id", id}}.dump()
                                    : json{{"type", "rejected"}, {"id", id}, {"reason", why}}.dump());
        }
    }

    std::string taken(const json& message) {
        try {
            return commands_.take(tick_, message.at("from_tick"), plan_of(message.at("reference"), tick_s_));
        } catch (const std::exception& error) {
            return error.what();
        }
    }

    /// A target is held when the vehicle has met it for a second, slowly, after all targets before it.
    void watch_targets() {
        const std::vector<Goal> goals = goals_of(problem_);
        const judge::JudgedRow& row = vehicle_.flight().rows.back();
        const auto next = static_cast<std::size_t>(std::count(held_.begin(), held_.end(), true));
        const bool is_met = next < goals.size() && vehicle_.used_share(goals[next], row.pose) <= 1 &&
                            std::hypot(row.vx_m_s, row.vz_m_s) < goal_max_speed_m_s;
        met_ticks_ = is_met ? met_ticks_ + 1 : 0;
        if (static_cast<double>(met_ticks_) * tick_s_ >= goal_settling_s) {
            held_[next] = true;
            met_ticks_ = 0;
        }
    }

    /// Fails as it was told.
    void fail() {
        if (options_.failure.empty() || static_cast<double>(tick_) * tick_s_ < options_.failure_s) {
            return;
        }
        if (options_.failure == "die") {
            std::_Exit(1);
        } else if (options_.failure == "garbage") {
            link_->send(R"({"type": "telemetry", "tick": )");
        } else {
            std::this_thread::sleep_for(std::chrono::seconds(5));
        }
    }

    const Options& options_;
    LineSocket* link_ = nullptr;  ///< of the flight
    Problem problem_;
    Scene scene_;
    judge::SimulatedVehicle vehicle_;
    double tick_s_;
    Commands commands_;
    std::int64_t tick_ = 0;
    std::mt19937 random_{1};
    std::normal_distribution<double> normal_;
    std::vector<bool> held_;
    std::int64_t met_ticks_ = 0;
};

bool read_options(int count, char** words, Options& options) {
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const char* value = i + 1 < count ? words[i + 1] : nullptr;
        if (word == "--lock-step") {
            options.is_lock_step = true;
            continue;
        }
        if (word.rfind("--", 0) != 0) {
            (options.problem.empty() ? options.problem : options.socket) = word;
            continue;
        }
        if (value == nullptr) {
            return false;
        }
        ++i;
        if (word == "--deck-lower") {
            options.deck_lower_m = std::atof(value);
        } else if (word == "--world") {
            options.world = std::strtoull(value, nullptr, 10);
        } else if (word == "--gust") {
            options.gust_m_s = std::atof(value);
        } else if (word == "--log") {
            options.log = value;
        } else if (word == "--fail") {
            options.failure = value;
        } else {
            return false;
        }
    }
    const bool can_fail = options.failure.empty() || options.failure == "die" || options.failure == "silence" ||
                          options.failure == "garbage";
    return !options.socket.empty() && options.world > 0 && can_fail;
}

/// Flies, and says how it went. @return the exit code
int run(const Options& options) {
    Vehicle vehicle(options);
    LineSocket link = LineSocket::accept_at(options.socket, 30);
    bool is_connected = true;
    try {
        vehicle.fly(link);
    } catch (const ConnectionLost& error) {
        std::fprintf(stderr, "vehicle: %s\n", error.what());
        is_connected = false;
    }
    if (!options.log.empty()) {
        vehicle.write_log();
    }
    const bool is_good = vehicle.report();
    return !is_connected ? 4 : is_good ? 0 : 3;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!read_options(count, words, options)) {
        std::fprintf(stderr,
                     "usage: %s PROBLEM.yaml SOCKET [--lock-step] [--world I] [--deck-lower METRES]\n"
                     "       [--gust M_S] [--log FLIGHT.csv] [--fail die|silence|garbage]\n",
                     words[0]);
        return 2;
    }
    try {
        return run(options);
    } catch (const ConnectionLost& error) {
        std::fprintf(stderr, "vehicle: %s\n", error.what());
        return 4;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 2;
    }
}
