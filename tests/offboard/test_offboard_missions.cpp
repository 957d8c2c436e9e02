#include <catch2/catch.hpp>
#include <downwash/simulation/space_world_parameters.hpp>
#include <string>

#include "../../docs/examples/offboard/obstacles.hpp"
#include "../../docs/examples/offboard/px4.hpp"
#include "../../docs/examples/offboard/rehearsal.hpp"
#include "../support/repetitions.hpp"

using namespace downwash;

namespace {

constexpr double lower_m = 0.05;
const std::string lower = "bottom_flange";

/// One plan for all missions: planning takes longer than flying.
struct Planned {
    SpaceProblem drawing = read_px4_problem(DOWNWASH_EXAMPLE "/girder.yaml");
    SpaceProblem problem;
    SpacePlan plan;

    Planned() {
        drawing.planner.max_iterations = 200;
        drawing.planner.time_limit_s.reset();
        Streamer streamer(drawing, {.max_iterations = 200, .is_quiet = true});
        REQUIRE(streamer.plan());
        problem = streamer.problem();
        plan = streamer.flown_plan();
    }
    static const Planned& once() {
        static const Planned planned;
        return planned;
    }
};

/// @param replans whether an obstacle turns out lower in flight
Rehearsal mission(const LinkFaults& faults, std::uint64_t world, bool replans, unsigned seed) {
    const Planned& planned = Planned::once();
    SpaceProblem truth = planned.problem;
    StreamerOptions options{.max_iterations = 20, .is_quiet = true};
    if (replans) {
        options.lower = lower;
        options.lower_m = lower_m;
        box_in(truth, lower).center_world_m[2] -= lower_m;
    }
    Streamer streamer(planned.problem, options);
    streamer.adopt(planned.problem, planned.plan);
    OffboardVehicle vehicle(truth, draw_space_world(*truth.uncertainty, truth.robot, 1, world));
    FaultyLink link(faults, seed);
    return rehearse(streamer, vehicle, link);
}

}  // namespace

TEST_CASE(
    "the vehicle stays within 5 cm of the plan with 2 percent of set-points lost, and a link that falls silent ends in "
    "a "
    "hover") {
    const int flights = test::repetitions(1, 20);
    for (int i = 0; i < flights; ++i) {
        const Rehearsal flown = mission({.loss = 0.02, .jitter_s = 0.01}, 0, false, static_cast<unsigned>(i));
        CHECK(flown.outcome == Outcome::ok);
        CHECK(flown.has_arrived);
        CHECK(flown.max_distance_m < 0.05);
    }
    const int missions = test::repetitions(10, 500);
    for (int i = 0; i < missions; ++i) {
        const double share = (i + 0.5) / missions;
        const double begun_s = 1.2;  // of offboard mode
        LinkFaults faults{.loss = 0.02, .jitter_s = 0.02};
        faults.silent_from_s = begun_s + share * Planned::once().plan.duration_s();
        const Rehearsal flown = mission(faults, static_cast<std::uint64_t>(i), i % 5 == 3, static_cast<unsigned>(i));
        INFO("mission " << i << ", silent from " << faults.silent_from_s << " s");
        CHECK(flown.outcome == Outcome::ok);
        CHECK(flown.hovers);
        CHECK(flown.is_in_failsafe);
        CHECK(flown.min_clearance_m > 0);
    }
}
