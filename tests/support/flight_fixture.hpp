#pragma once

#include <memory>
#include <utility>

#include "downwash/planner/solve.hpp"
#include "downwash/search/planned_flights.hpp"
#include "test_problem.hpp"

namespace downwash::test {

/// What the flights of a search need: a problem with its model and its map.
struct FlightFixture {
    explicit FlightFixture(Problem given = ceiling_problem()) : problem(std::move(given)) {}

    Problem problem;
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map = model->make_map(problem.bounds);
    planning::SearchTask task{problem, *model, map.get()};
    planning::PlannedFlights flights{task};
};

}  // namespace downwash::test
