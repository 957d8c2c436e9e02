// A simulated vehicle under PX4, for those who fly it by MAVLink over UDP (README.md). Usage: vehicle PROBLEM.yaml
//   [--lower OBSTACLE METRES]   it is really lower than in the problem
//   [--world I]                 flies in that world of the problem's uncertainty; default: the nominal one
//   [--loss SHARE] [--jitter S] [--silent S] [--seed N]   faults of the link to it: lost datagrams, their greatest
//   delay,
//                               silence from that second on; seed of their luck
//   [--lock-step]               the clock waits for a set-point with the time of the last telemetry; default: real time
//   [--instance N]              adds N to both ports: 14580, on which it listens, and 14540, to which it sends
//   [--log FILE.csv]            writes the true flight
// Exit codes: 0 it ends in a hover, 1 it does not, 2 bad input, 3 nobody came.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include <downwash/simulation/space_world_parameters.hpp>

#include "command_line.hpp"
#include "faulty_link.hpp"
#include "obstacles.hpp"
#include "offboard_vehicle.hpp"
#include "px4.hpp"
#include "udp.hpp"

using namespace downwash;

namespace {

constexpr double wait_for_somebody_s = 120;  ///< who may plan first, or again
constexpr double heartbeat_period_s = 1;     ///< on the wall, while the clock of lock step stands still
constexpr double hover_at_end_s = 5;

struct Options {
    std::string problem, lower, log;
    double lower_m = 0;
    std::uint64_t world = 0;
    LinkFaults faults;
    unsigned seed = 1;
    int instance = 0;
    bool is_lock_step = false;
};

Options options_of(int count, char** words) {
    Options options;
    LinkFaults& faults = options.faults;
    options.problem = read_command_line(
        count, words,
        {{"--lower", [&](const NextWord& next) { options.lower = next(), options.lower_m = std::stod(next()); }},
         {"--world", [&](const NextWord& next) { options.world = std::stoull(next()); }},
         {"--loss", [&](const NextWord& next) { faults.loss = std::stod(next()); }},
         {"--jitter", [&](const NextWord& next) { faults.jitter_s = std::stod(next()); }},
         {"--silent", [&](const NextWord& next) { faults.silent_from_s = std::stod(next()); }},
         {"--seed", [&](const NextWord& next) { options.seed = static_cast<unsigned>(std::stoul(next())); }},
         {"--instance", [&](const NextWord& next) { options.instance = std::stoi(next()); }},
         {"--log", [&](const NextWord& next) { options.log = next(); }},
         {"--lock-step", [&](const NextWord&) { options.is_lock_step = true; }}});
    return options;
}

SpaceProblem truth_of(const Options& options) {
    SpaceProblem problem = read_px4_problem(options.problem);
    if (!options.lower.empty()) {
        box_in(problem, options.lower).center_world_m[2] -= options.lower_m;
    }
    return problem;
}

SpaceWorld world_of(const SpaceProblem& problem, std::uint64_t index) {
    return problem.uncertainty ? draw_space_world(*problem.uncertainty, problem.robot, problem.planner.seed, index)
                               : SpaceWorld{};
}

/// Whether a datagram has a set-point with the time of the vehicle.
bool is_answer(const std::string& datagram, double now_s) {
    const auto frames = mavlink::FrameReader().take(datagram);
    return std::ranges::any_of(frames, [&](const mavlink::Frame& frame) {
        const auto setpoint = mavlink::message_in<mavlink::SetPositionTargetLocalNed>(frame);
        return setpoint && setpoint->time_boot_ms == static_cast<std::uint32_t>(std::llround(1e3 * now_s));
    });
}

class Simulation {
 public:
    explicit Simulation(const Options& options)
        : options_(options),
          problem_(truth_of(options)),
          vehicle_(problem_, world_of(problem_, options.world)),
          link_(options.faults, options.seed),
          socket_(14580 + options.instance, 14540 + options.instance) {
        if (!options.log.empty()) {
            log_.open(options.log);
            log_ << "t_s,is_offboard,ref_x_m,ref_y_m,ref_z_m,x_m,y_m,z_m\n";
        }
    }

    /// @return whether somebody came
    bool run() {
        if (!socket_.receive(wait_for_somebody_s)) {
            return false;
        }
        started_ = std::chrono::steady_clock::now();
        while (!is_over()) {
            if (const std::string datagram = vehicle_.sent(); !datagram.empty()) {
                socket_.send(datagram);
            }
            receive();
            for (const std::string& datagram : link_.arrived(vehicle_.time_s())) {
                vehicle_.take(datagram);
            }
            write_log();
            vehicle_.tick();
        }
        return true;
    }

    /// Says how the flight went. @return whether it ends in a hover
    bool report() const {
        const std::string ends = vehicle_.is_offboard()      ? "offboard"
                                 : vehicle_.is_in_failsafe() ? "hold, since set-points did not come"
                                                             : "hold";
        std::printf("vehicle: %.1f s flown, outcome %s, least clearance %.3f m, ends in %s\n", vehicle_.time_s(),
                    std::string(name_of(vehicle_.outcome())).c_str(), vehicle_.min_clearance_m(), ends.c_str());
        return vehicle_.outcome() == Outcome::ok && !vehicle_.is_offboard();
    }

 private:
    /// What has come until the next tick begins; in lock step until the answer to telemetry.
    void receive() {
        if (options_.is_lock_step) {
            while (vehicle_.is_telemetry_due() && !is_alone_) {
                const auto datagram = next_in_lock_step();
                is_alone_ = !datagram;
                if (datagram) {
                    link_.put(vehicle_.time_s(), *datagram);
                    if (is_answer(*datagram, vehicle_.time_s())) {
                        return;
                    }
                }
            }
            return;
        }
        while (const auto datagram = socket_.receive(0)) {
            if (!datagram->empty()) {
                link_.put(vehicle_.time_s(), *datagram);
            }
        }
        std::this_thread::sleep_until(started_ + std::chrono::duration<double>(vehicle_.time_s()));
    }

    /// The next datagram; nothing if nobody is there any more. Who has gone may have read the last telemetry, so the
    /// system only tells of it when something else is sent: a heartbeat, which asks for no answer.
    std::optional<std::string> next_in_lock_step() {
        for (double waited_s = 0; waited_s < wait_for_somebody_s; waited_s += heartbeat_period_s) {
            if (const auto datagram = socket_.receive(heartbeat_period_s)) {
                return datagram->empty() ? std::nullopt : datagram;
            }
            socket_.send(vehicle_.heartbeat());
        }
        return std::nullopt;
    }

    /// Whether it is lost, or has hovered for a while after it was flown.
    bool is_over() {
        was_offboard_ = was_offboard_ || vehicle_.is_offboard();
        if (vehicle_.is_offboard() || !(was_offboard_ || is_alone_)) {
            in_hold_since_s_ = vehicle_.time_s();
        }
        return vehicle_.outcome() != Outcome::ok || vehicle_.time_s() - in_hold_since_s_ > hover_at_end_s;
    }

    void write_log() {
        if (log_.is_open()) {
            const SpacePoint& reference = vehicle_.reference();
            const Vector3 at = vehicle_.motion().position_m;
            log_ << vehicle_.time_s() << ',' << vehicle_.is_offboard() << ',' << reference.position[space::x] << ','
                 << reference.position[space::y] << ',' << reference.position[space::z] << ',' << at[0] << ',' << at[1]
                 << ',' << at[2] << '\n';
        }
    }

    const Options& options_;
    SpaceProblem problem_;
    OffboardVehicle vehicle_;
    FaultyLink link_;
    UdpSocket socket_;
    std::ofstream log_;
    std::chrono::steady_clock::time_point started_;
    bool is_alone_ = false;  ///< nobody answers in lock step
    bool was_offboard_ = false;
    double in_hold_since_s_ = 0;
};

}  // namespace

int main(int count, char** words) {
    try {
        const Options options = options_of(count, words);
        Simulation simulation(options);
        if (!simulation.run()) {
            std::fprintf(stderr, "vehicle: nobody came\n");
            return 3;
        }
        return simulation.report() ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\nusage: vehicle PROBLEM.yaml [options], as vehicle.cpp says\n", error.what());
        return 2;
    }
}
