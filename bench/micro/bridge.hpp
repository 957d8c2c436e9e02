#pragma once

#include <memory>

#include "downwash/aeromap/volume_map.hpp"
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

/// The volume under the deck of the bridge that bench_aero_map measures, too.
inline const VolumeMap& volume_under_deck() {
    static const VolumeMap map(std::make_shared<const DirectEffect>(Bridge::get().model->effect(0)),
                               Bridge::get().model->plane(), {-8, -2, 8, 10}, -1.25, 1.25);
    return map;
}

}  // namespace downwash::bench
