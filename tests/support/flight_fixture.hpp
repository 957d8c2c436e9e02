#pragma once

#include <memory>
#include <utility>

#include "downwash/planner/solve.hpp"
#include "downwash/search/planned_flights.hpp"
#include "test_problem.hpp"

namespace downwash::test {

/// What the flights of a search need: a problem with its model and its map.
struct FlightFixture {
    /// @param in_worlds whether the search may learn of worlds; it knows of none at first
    explicit FlightFixture(Problem given = ceiling_problem(), bool in_worlds = false)
        : problem(std::move(given)), task{problem, *model, map.get(), {}, in_worlds ? &worlds : nullptr} {}

    Problem problem;
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map = model->make_map(problem.bounds);
    planning::SearchWorlds worlds;
    planning::SearchTask task;
    planning::PlannedFlights flights{task};
};

}  // namespace downwash::test
