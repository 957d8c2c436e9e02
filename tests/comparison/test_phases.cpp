#include <catch2/catch.hpp>

#include "downwash/comparison/phases.hpp"

// The phases of a plan, by its reference.

using namespace downwash;

namespace {

/// So many ticks of 0.1 s at a velocity.
void add(PlannedFlight& planned, int ticks, const Vector3& velocity_m_s) {
    planned.tick_s = 0.1;
    for (int i = 0; i < ticks; ++i) {
        PlannedRow row;
        row.t_s = 0.1 * static_cast<double>(planned.rows.size());
        row.reference_velocity_m_s = velocity_m_s;
        planned.rows.push_back(row);
    }
}

}  // namespace

TEST_CASE("A plan climbs, crosses over with a short rest, approaches on its last metre and hovers") {
    PlannedFlight planned;
    add(planned, 10, {0, 0.1, 0.5});
    add(planned, 30, {0.5, 0, 0.1});  // 3 s
    add(planned, 3, {0, 0, 0});       // shorter than a hover
    add(planned, 40, {0.5, 0, 0});    // 2 m
    add(planned, 10, {0, 0, 0});
    const std::vector<FlightPhase> phases = phases_of(planned);
    const auto count = [&phases](FlightPhase phase) { return std::count(phases.begin(), phases.end(), phase); };
    CHECK(count(FlightPhase::climb) == 10);
    CHECK(count(FlightPhase::approach) == Approx(20).margin(1));
    CHECK(count(FlightPhase::hover) == 10);
    CHECK(count(FlightPhase::transit) == 93 - 10 - 10 - count(FlightPhase::approach));
    CHECK(phases[9] == FlightPhase::climb);
    CHECK(phases[41] == FlightPhase::transit);
    CHECK(phases[82] == FlightPhase::approach);
    CHECK(phases[83] == FlightPhase::hover);
}

TEST_CASE("A descent counts as a climb, and a plan without a hover has no approach") {
    PlannedFlight planned;
    add(planned, 5, {0, 0, -0.5});
    const std::vector<FlightPhase> phases = phases_of(planned);
    CHECK(std::count(phases.begin(), phases.end(), FlightPhase::climb) == 5);
}
