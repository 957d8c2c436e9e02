#include <catch2/catch.hpp>
#include <cmath>

#include "../support/flight_fixture.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/search/passage_sampler.hpp"
#include "downwash/search/tree_growth.hpp"

using namespace downwash;
using planning::Passage;

namespace {

/// Dynobench's gap of 0.6 m, as wide as the level body is long.
Problem gap_problem() {
    return read_problem(std::string(DOWNWASH_BENCH) + "/dynobench/fall_through.yaml");
}

struct Fixture {
    Problem problem = gap_problem();
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    planning::SearchTask task{problem, *model, nullptr};
};

/// Draws from a space without OMPL.
class SpaceSampler : public planning::PlaceSampler {
 public:
    SpaceSampler(const planning::SearchSpace& space, planning::Random& random) : space_(space), random_(random) {}
    std::optional<Configuration> anywhere(double) override { return space_.sample(random_); }
    Configuration near(const Configuration& place, double radius_m) override {
        return space_.sample_near(place, radius_m, random_);
    }

 private:
    const planning::SearchSpace& space_;
    planning::Random& random_;
};

}  // namespace

TEST_CASE("passages lead through the gap both ways, tilted, within the limits and free of collision") {
    const Fixture f;
    planning::PassageSampler sampler(f.task);
    planning::Random random(1);
    int down = 0;
    int up = 0;
    for (int i = 0; i < 10000 && (down < 10 || up < 10); ++i) {
        std::optional<Passage> passage = sampler.sample(random, [](const Passage&) { return true; });
        if (!passage) {
            continue;
        }
        if (i % 2 == 1) {
            passage = reversed(*passage);
        }
        CHECK(is_at_rest(passage->run_up));
        CHECK(is_at_rest(passage->run_out));
        for (const auto& [from, to] :
             {std::pair(passage->run_up, passage->through), std::pair(passage->through, passage->run_out)}) {
            const ReferenceSegment segment(from, to, shortest_ticks(from, to, f.problem.motion, 0.01), 0.01);
            CHECK(keeps_limits(segment, f.problem.motion));
            for (std::int64_t tick = 0; 2 * tick <= segment.ticks(); tick += 3) {
                const ReferencePoint point = segment.at_tick(from == passage->through ? segment.ticks() - tick : tick);
                CHECK(f.task.space.rejection_at(configuration_of(point), pitch_along(point)) == Rejection::none);
            }
        }
        // A way that turns back is of no use, and a tree that knows one would go on looking beside it.
        CHECK((passage->run_up.position[1] > 3) != (passage->run_out.position[1] > 3));
        const double z = passage->through.position[1];
        const bool is_in_gap = z > 2.75 && z < 3.25;
        if (is_in_gap && passage->run_up.position[1] > 3.2 && passage->run_out.position[1] < 2.8) {
            CHECK(f.task.space.rejection_at(configuration_of(passage->through)) == Rejection::collision);
            ++down;
        }
        up += is_in_gap && passage->run_up.position[1] < 2.8 && passage->run_out.position[1] > 3.2 ? 1 : 0;
    }
    CHECK(down >= 10);
    CHECK(up >= 10);
}

TEST_CASE("without passages the tree does not come through a gap as wide as the body, with them it does") {
    Fixture f;
    const auto lowest_m = [&](double share) {
        f.problem.planner.parameters["passage_share"] = share;
        const planning::FlightTreeParameters parameters(f.problem.planner);
        planning::PlannedFlights flights(f.task);
        planning::Random random(6);
        SpaceSampler sampler(f.task.space, random);
        planning::TreeGrowth growth(planning::start_point(f.task), f.task.space, parameters, flights, random, sampler);
        double lowest = 10;
        for (int batch = 0; batch < 400 && !growth.has_plan(); ++batch) {
            static_cast<void>(growth.grow({}));
        }
        for (const planning::FlightNode* node : growth.tree().nodes()) {
            lowest = std::min(lowest, node->configuration[plane::z]);
        }
        return lowest;
    };
    CHECK(lowest_m(0) > 3);
    CHECK(lowest_m(0.3) < 2.8);
}
