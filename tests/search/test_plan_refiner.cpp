#include <algorithm>
#include <catch2/catch.hpp>

#include "../support/flight_fixture.hpp"
#include "../support/same_bytes.hpp"
#include "downwash/search/plan_refiner.hpp"
#include "downwash/simulation/execution.hpp"

using namespace downwash;

namespace {

/// The ceiling problem and a plan for it that stops at every corner of a detour.
struct Fixture : test::FlightFixture {
    explicit Fixture(std::uint32_t seed = 4, bool in_worlds = false)
        : FlightFixture(test::ceiling_problem(), in_worlds), random(seed) {}

    planning::Random random;
    planning::PlanRefiner refiner{planning::start_point(task), flights, random};

    [[nodiscard]] Plan stop_and_go(const Configuration& first = {-2, 1, 0}) const {
        Plan plan;
        plan.tick_s = model->tick().tick_s;
        plan.reference.push_back({0, planning::reference_at(problem.start)});
        // In the end the arm points up, from a vehicle 1.2 m below the goal.
        for (const Configuration& corner : {first, {0, 3, -0.5}, {3, 3.6, -test::quarter_turn}}) {
            const ReferenceKnot& last = plan.reference.back();
            const ReferenceSegment segment = flights.fastest_segment(last.point, at_rest(corner));
            plan.reference.push_back({last.tick + segment.ticks(), segment.to()});
        }
        return plan;
    }
};

}  // namespace

TEST_CASE("refining a plan makes it cheaper step by step, and it passes corners without a stop") {
    Fixture f;
    f.refiner.work_on({f.stop_and_go()});
    REQUIRE(f.refiner.best() != nullptr);
    const double before = f.refiner.best()->cost;
    double last = before;
    for (int batch = 0; batch < 150; ++batch) {
        f.refiner.improve();
        REQUIRE(f.refiner.best()->cost <= last);
        last = f.refiner.best()->cost;
    }
    CHECK(last < 0.8 * before);
    const planning::FlownPlan& plan = *f.refiner.best();
    for (std::size_t i = 1; i + 1 < plan.points.size(); ++i) {
        const double* v = plan.points[i].velocity;
        CHECK(v[0] * v[0] + v[1] * v[1] > 1e-4);
    }
    CHECK(at_rest(configuration_of(plan.points.back())) == plan.points.back());
}

TEST_CASE(
    "what the refiner says of a plan is what flying it from the start gives, and its reference keeps the limits") {
    Fixture f;
    f.refiner.work_on({f.stop_and_go()});
    for (int batch = 0; batch < 60; ++batch) {
        f.refiner.improve();
    }
    const planning::FlownPlan& flown = *f.refiner.best();
    const Plan plan = planning::plan_through(f.refiner.moments_of(flown), f.task.blank_plan);
    FlightState state = start_state(*f.model, f.problem.start);
    for (std::size_t i = 1; i < plan.reference.size(); ++i) {
        const ReferenceSegment segment(plan.reference[i - 1].point, plan.reference[i].point,
                                       plan.reference[i].tick - plan.reference[i - 1].tick, plan.tick_s);
        CHECK(keeps_limits(segment, f.flights.limits()));
        CHECK(fly(*f.model, f.map.get(), planning::planning_rules(f.problem, true, {}), segment, state).rejection ==
              Rejection::none);
        CHECK(is_same(state, flown.fleets[i][0]));
    }
    const FlightLeg hold = f.flights.hold_leg(plan.reference.back().point);
    CHECK(fly(*f.model, f.map.get(), planning::planning_rules(f.problem, true, {}), hold.segment, state).rejection ==
          Rejection::none);
    CHECK(state.plant.energy_j == flown.cost);
    CHECK(meets_goal(f.problem.goal, f.model->tick().plant, state));
}

TEST_CASE("a plan that cannot be flown is not taken on, and one that was dropped is gone") {
    Fixture f;
    Plan through_the_ground = f.stop_and_go();
    through_the_ground.reference[1].point.position[1] = -1;
    f.refiner.work_on({through_the_ground});
    CHECK(f.refiner.best() == nullptr);
    f.refiner.improve();  // nothing to work on
    f.refiner.work_on({f.stop_and_go()});
    REQUIRE(f.refiner.best() != nullptr);
    CHECK(f.refiner.wants_plan());
    f.refiner.work_on({f.stop_and_go()});
    CHECK_FALSE(f.refiner.wants_plan());
    const int first = f.refiner.best_number();
    f.refiner.drop(first);
    REQUIRE(f.refiner.best() != nullptr);
    CHECK(f.refiner.best_number() != first);
    f.refiner.drop(first);  // it is gone already
    REQUIRE(f.refiner.best() != nullptr);
    f.refiner.drop(f.refiner.best_number());
    CHECK(f.refiner.best() == nullptr);
}

TEST_CASE("every segment of a refined plan keeps the limits, however the number of corners changes") {
    std::size_t least_corners = 100;
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        Fixture f(seed);
        f.refiner.work_on({f.stop_and_go()});
        REQUIRE(f.refiner.best() != nullptr);
        for (int batch = 0; batch < 60; ++batch) {
            f.refiner.improve();
            const planning::FlownPlan& plan = *f.refiner.best();
            REQUIRE(plan.points.size() == plan.ticks.size() + 1);
            for (std::size_t i = 0; i < plan.ticks.size(); ++i) {
                INFO("seed " << seed << ", batch " << batch << ", segment " << i);
                const ReferenceSegment segment(plan.points[i], plan.points[i + 1], plan.ticks[i],
                                               f.model->tick().tick_s);
                REQUIRE(keeps_limits(segment, f.flights.limits()));
                // Nor does it dawdle: each segment is as short as one between its ends can be.
                REQUIRE(plan.ticks[i] == f.flights.fastest_segment(plan.points[i], plan.points[i + 1]).ticks());
            }
            least_corners = std::min(least_corners, plan.points.size());
        }
    }
    CHECK(least_corners < 4);  // which the plan began with
}

TEST_CASE("batches that are flown ahead change neither plans nor counts") {
    const bool in_worlds = GENERATE(false, true);
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        CAPTURE(in_worlds, seed);
        Fixture ahead(seed, in_worlds);
        Fixture one_by_one(seed, in_worlds);
        // An objective that is not the flights' own, although the same, has every batch flown when its turn comes.
        const planning::ProblemObjective objective(one_by_one.task);
        one_by_one.flights.pay_by(&objective);
        REQUIRE(ahead.flights.can_fly_chains());
        REQUIRE(!one_by_one.flights.can_fly_chains());
        int improvements = 0;
        double last = HUGE_VAL;
        for (int batch = 0; batch < 120; ++batch) {
            for (Fixture* f : {&ahead, &one_by_one}) {
                if (batch % 40 == 0) {  // another plan in between
                    f->refiner.work_on({f->stop_and_go({-2.0 + 0.02 * batch, 1, 0})});
                }
                if (batch == 70) {
                    f->refiner.drop(f->refiner.best_number());
                    f->refiner.work_on({f->stop_and_go()});
                }
                f->refiner.improve();
            }
            CAPTURE(batch);
            const planning::FlownPlan& a = *ahead.refiner.best();
            const planning::FlownPlan& b = *one_by_one.refiner.best();
            REQUIRE(a.cost == b.cost);
            REQUIRE(a.points == b.points);
            REQUIRE(a.ticks == b.ticks);
            REQUIRE(a.costs == b.costs);
            REQUIRE(is_same(a.fleets.back().front(), b.fleets.back().front()));
            const planning::FlightStatistics& counts = ahead.flights.statistics();
            const planning::FlightStatistics& other = one_by_one.flights.statistics();
            REQUIRE(counts.edges == other.edges);
            REQUIRE(counts.ticks == other.ticks);
            REQUIRE(counts.states_checked == other.states_checked);
            REQUIRE(counts.rejected == other.rejected);
            REQUIRE(counts.rejections == other.rejections);
            REQUIRE(counts.obstruction.has_value() == other.obstruction.has_value());
            if (counts.obstruction) {
                REQUIRE(counts.obstruction->at == other.obstruction->at);
                REQUIRE(counts.obstruction->cause == other.obstruction->cause);
            }
            REQUIRE(ahead.random == one_by_one.random);
            improvements += a.cost < last ? 1 : 0;
            last = a.cost;
        }
        CHECK(improvements > 10);
        CHECK(improvements < 110);  // or nothing was flown ahead
    }
}

TEST_CASE("a plan that a counterexample rejects is changed until it flies there, too") {
    Fixture f(4, true);
    f.refiner.work_on({f.stop_and_go()});
    REQUIRE(f.refiner.best() != nullptr);
    CHECK(f.refiner.best()->fleets.front().size() == 1);

    World raised;  // the ground comes up to the corner at 1 m
    raised.scene_z_m = 0.65;
    f.flights.join({{make_world(f.problem.robot, raised), f.task.start}});
    const std::vector<planning::Lineage> lineages = f.refiner.release();
    CHECK(f.refiner.best() == nullptr);
    REQUIRE(lineages.size() == 1);
    const Plan& rejected = lineages[0].back();
    CHECK(rejected.reference.size() == f.stop_and_go().reference.size());
    f.refiner.work_on(lineages[0]);
    REQUIRE(f.refiner.best() != nullptr);
    const planning::FlownPlan& repaired = *f.refiner.best();
    CHECK(repaired.fleets.front().size() == 2);
    CHECK(repaired.points[1].position[1] > rejected.reference[1].point.position[1]);
    for (int batch = 0; batch < 10; ++batch) {
        f.refiner.improve();
    }
    // What came of it flies in the counterexample.
    std::vector<FlightLeg> legs;
    for (std::size_t i = 0; i + 1 < repaired.points.size(); ++i) {
        legs.push_back({{repaired.points[i], repaired.points[i + 1], repaired.ticks[i], f.model->tick().tick_s}});
    }
    const planning::Fleet start = f.flights.fleet_at_start(f.task.start);
    std::vector<planning::FleetJob> jobs{f.flights.job(start, 0, legs)};
    f.flights.fly(jobs);
    CHECK(jobs[0].is_accepted());
}

TEST_CASE("a plan that is known to fail is not taken on as it is") {
    Fixture f(4, true);
    f.flights.join({{make_world(f.problem.robot, World{}), f.task.start}});
    f.refiner.work_on({f.stop_and_go()}, 1);
    REQUIRE(f.refiner.best() != nullptr);
    const std::vector<planning::Lineage> taken = f.refiner.release();
    CHECK_FALSE(test::same_bytes(taken.at(0).back(), f.stop_and_go()));
}

TEST_CASE("where a counterexample rejects a plan and not those from which it came, the refiner goes back to the last") {
    Fixture f(4, true);
    World raised;  // the ground comes up to a corner at 1 m
    raised.scene_z_m = 0.65;
    f.flights.join({{make_world(f.problem.robot, raised), f.task.start}});
    const auto with_corner_at = [&f](double z_m) { return f.stop_and_go(Configuration{-2, z_m, 0}); };
    f.refiner.work_on({with_corner_at(1.8)});
    REQUIRE(f.refiner.best() != nullptr);
    const double cost = f.refiner.best()->cost;
    CHECK(f.refiner.release().size() == 1);
    f.refiner.work_on({with_corner_at(1.9), with_corner_at(1.8), with_corner_at(1.1), with_corner_at(1)});
    REQUIRE(f.refiner.best() != nullptr);
    CHECK(f.refiner.best()->cost <= cost);
    const planning::Lineage lineage = f.refiner.release().at(0);
    REQUIRE(lineage.size() >= 2);
    CHECK(lineage.size() <= 3);  // a change of the last may have been cheaper
    CHECK(test::same_bytes(lineage[0], with_corner_at(1.9)));
    CHECK(test::same_bytes(lineage[1], with_corner_at(1.8)));
}
