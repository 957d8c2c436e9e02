#include <catch2/catch.hpp>

#include "../support/test_problem.hpp"
#include "downwash/judge/disagreements.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

/// A straight plan through free space to a goal, and what the judge says about its flight.
struct Case {
    Problem problem = ceiling_problem();
    Claims claims;

    Case() {
        problem.goal = configuration_goal(0, 2);
        claims.plan.tick_s = 0.01;
        claims.plan.reference = {{0, at_rest({-4, 2, quarter_turn})}, {1000, at_rest({0, 2, quarter_turn})}};
        for (const ReferenceKnot& knot : claims.plan.reference) {
            claims.waypoints.push_back(configuration_of(knot.point));
        }
    }

    [[nodiscard]] judge::JudgedFlight flight() const { return judge::PlanJudge(problem).fly(claims.plan, {}); }

    [[nodiscard]] FlightClaims honest() const {
        const judge::JudgedFlight f = flight();
        FlightClaims said;
        said.outcome = name_of(f.outcome);
        said.min_clearance_m = f.min_clearance_m;
        said.energy_j = f.energy_j;
        said.duration_s = f.duration_s;
        said.goal_error_m = f.goal_error_m;
        said.cost = f.cost(claims.objective);
        return said;
    }

    [[nodiscard]] std::vector<std::string> in_plan() const {
        return names(judge::disagreements_in_plan(claims, problem));
    }
    [[nodiscard]] std::vector<std::string> about(const FlightClaims& said) const {
        return names(judge::disagreements_about_flight(said, claims.objective, flight(), 0.01));
    }

    static std::vector<std::string> names(const std::vector<judge::Disagreement>& all) {
        std::vector<std::string> list;
        for (const judge::Disagreement& each : all) {
            list.push_back(each.what);
        }
        return list;
    }
};

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("A plan that contradicts nothing is not contradicted") {
    const Case good;
    CHECK(good.in_plan().empty());
    CHECK(good.about(good.honest()).empty());
}

TEST_CASE("A plan that contradicts itself or its problem is found out") {
    Case bad;
    SECTION("by a waypoint that is not where the reference is") {
        bad.claims.waypoints[1][plane::z] += 1e-6;
        CHECK(bad.in_plan() == Names{"plan.waypoints[1].z_m"});
    }
    SECTION("by a missing waypoint") {
        bad.claims.waypoints.pop_back();
        CHECK(bad.in_plan() == Names{"plan.waypoints: their number"});
    }
    SECTION("by a knot that stands elsewhere") {
        bad.claims.plan.reference[1].point.position[0] += 0.05;
        CHECK(bad.in_plan() == Names{"plan.waypoints[1].x_m"});
    }
    SECTION("by a start that is not the problem's") {
        bad.problem.start.at[plane::arm] = 1.5;
        CHECK(bad.in_plan() == Names{"plan.reference[0].arm_rad"});
    }
    SECTION("by speed and acceleration beyond the limits") {
        bad.claims.plan.reference[1].tick = 600;  // 4 m in 6 s: peak 1.25 m/s, 0.64 m/s2
        CHECK(bad.in_plan() ==
              Names{"plan.reference[0] to [1]: speed_m_s", "plan.reference[0] to [1]: acceleration_m_s2"});
        const auto all = judge::disagreements_in_plan(bad.claims, bad.problem);
        CHECK(std::get<double>(all[0].file) == Approx(15.0 / 8 * 4 / 6).epsilon(1e-4));
        CHECK(std::get<double>(all[0].judge) == 1);
    }
    SECTION("by an end outside of the goal") {
        bad.problem.goal = configuration_goal(0.5, 2);
        CHECK(bad.in_plan() == Names{"plan.reference, its end: share of the goal's tolerance"});
    }
    SECTION("by an end that moves") {
        bad.claims.plan.reference[1].point.velocity[0] = 0.1;
        CHECK(bad.in_plan() == Names{"plan.reference, its end: speed"});
    }
}

TEST_CASE("A file that says something else about its flight is found out") {
    const Case good;
    FlightClaims said = good.honest();
    SECTION("cost by more than 1 %") {
        said.cost *= 0.985;
        CHECK(good.about(said) == Names{"execution.cost"});
    }
    SECTION("clearance by more than 1 cm") {
        said.min_clearance_m = *said.min_clearance_m + 0.011;
        CHECK(good.about(said) == Names{"execution.min_clearance_m"});
    }
    SECTION("no obstacles where there are some") {
        said.min_clearance_m.reset();
        CHECK(good.about(said) == Names{"execution.min_clearance_m"});
    }
    SECTION("duration by two ticks") {
        said.duration_s += 0.02;
        CHECK(good.about(said) == Names{"execution.duration_s"});
    }
    SECTION("goal error by more than 1 cm") {
        said.goal_error_m += 0.011;
        CHECK(good.about(said) == Names{"execution.goal_error_m"});
    }
    SECTION("energy by more than 1 %") {
        said.energy_j *= 1.02;
        CHECK(good.about(said) == Names{"execution.energy_j"});
    }
    SECTION("outcome") {
        said.outcome = "collision";
        CHECK(good.about(said) == Names{"execution.outcome"});
    }
    SECTION("but not by a tick, half a centimetre and half a percent") {
        said.duration_s += 0.01;
        said.goal_error_m += 0.005;
        said.min_clearance_m = *said.min_clearance_m - 0.005;
        said.cost *= 1.005;
        CHECK(good.about(said).empty());
    }
}

TEST_CASE("Every objective is derived anew") {
    Case good;
    for (const Objective objective : all_objectives) {
        good.claims.objective = objective;
        FlightClaims said = good.honest();
        CHECK(good.about(said).empty());
        said.cost *= 1.02;
        CHECK(good.about(said) == Names{"execution.cost"});
    }
    const judge::JudgedFlight flight = good.flight();
    CHECK(flight.cost(Objective::time) == Approx(15));  // 10 s and a hover of 5 s
    CHECK(flight.length_m == Approx(4).margin(0.2));    // the way, and a little more for the tracking error
}

TEST_CASE("A plan begins with the reference that the vehicle follows, wherever the vehicle is") {
    Case good;
    good.problem.start.at[plane::x] += 0.03;
    CHECK(good.in_plan() == Names{"plan.reference[0].x_m"});
    good.problem.start.reference = good.claims.plan.reference.front().point;
    CHECK(good.in_plan().empty());
}
