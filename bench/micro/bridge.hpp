#pragma once

#include <memory>

#include "downwash/planner/solve.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::bench {

/// The bridge with its map, made once.
struct Bridge {
    Problem problem = read_problem(DOWNWASH_PROBLEMS "/bridge_inspection.yaml");
    std::shared_ptr<const FlightModel> model = make_flight_model(problem);
    std::shared_ptr<const AeroMap> map = model->make_whole_map(problem.bounds);

    static const Bridge& get() {
        static const Bridge bridge;
        return bridge;
    }
};

}  // namespace downwash::bench
