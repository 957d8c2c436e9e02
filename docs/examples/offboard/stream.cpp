// Plans a flight and streams it to a vehicle under PX4, as MAVLink over UDP. stream.py is the same in Python. Usage:
// stream PROBLEM.yaml
//   [--lower OBSTACLE METRES]   it turns out lower in flight: the streamer plans again
//   [--iterations N]            of each search, which makes a mission repeatable; default: 60 s before a flight, 1.2 s
//   in flight
//   [--instance N]              adds N to both ports: 14540, on which it listens, and 14580, to which it sends
//   [--stop-after S]            stops sending that long after offboard mode began, as if it had crashed
// Exit codes: 0 the vehicle hovers at the goal, 1 it does not, 2 bad input, 3 no vehicle answers.

#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include "command_line.hpp"
#include "px4.hpp"
#include "streamer.hpp"
#include "udp.hpp"

using namespace downwash;

namespace {

constexpr double on_ground_s = 60;    ///< for the plan of a flight
constexpr double max_silence_s = 10;  ///< of the vehicle

struct Options {
    std::string problem;
    StreamerOptions streamer;
    int instance = 0;
    double stop_after_s = 1e9;
};

Options options_of(int count, char** words) {
    Options options;
    StreamerOptions& streamer = options.streamer;
    options.problem = read_command_line(
        count, words,
        {{"--lower", [&](const NextWord& next) { streamer.lower = next(), streamer.lower_m = std::stod(next()); }},
         {"--iterations", [&](const NextWord& next) { streamer.max_iterations = std::stoull(next()); }},
         {"--instance", [&](const NextWord& next) { options.instance = std::stoi(next()); }},
         {"--stop-after", [&](const NextWord& next) { options.stop_after_s = std::stod(next()); }}});
    return options;
}

/// @return whether a vehicle answers
bool greet(UdpSocket& socket, Streamer& streamer) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(max_silence_s);
    while (std::chrono::steady_clock::now() < deadline) {
        socket.send(streamer.greeting());
        const auto datagram = socket.receive(0.2);
        if (datagram && !datagram->empty()) {
            socket.send(streamer.answer(*datagram));
            return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
}

int run(const Options& options) {
    SpaceProblem drawing = read_px4_problem(options.problem);
    drawing.planner.max_iterations = options.streamer.max_iterations;
    drawing.planner.time_limit_s.reset();
    if (!drawing.planner.max_iterations) {
        drawing.planner.time_limit_s = on_ground_s;
    }
    Streamer streamer(drawing, options.streamer);
    if (!streamer.plan()) {
        return 1;
    }
    UdpSocket socket(14540 + options.instance, 14580 + options.instance);
    if (!greet(socket, streamer)) {
        std::fprintf(stderr, "no vehicle answers\n");
        return 3;
    }
    while (!streamer.is_over() && streamer.flown_s() < options.stop_after_s) {
        const auto datagram = socket.receive(max_silence_s);
        if (!datagram || datagram->empty()) {
            std::fprintf(stderr, "the vehicle is silent\n");
            return 3;
        }
        if (const std::string answer = streamer.answer(*datagram); !answer.empty()) {
            socket.send(answer);
        }
    }
    return streamer.has_arrived() ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
    try {
        return run(options_of(count, words));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\nusage: stream PROBLEM.yaml [options], as stream.cpp says\n", error.what());
        return 2;
    }
}
