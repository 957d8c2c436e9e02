#include <cstddef>
#include <cstdint>
#include <string_view>

#include "downwash/base/key_error.hpp"
#include "downwash/exports/setpoint_check.hpp"
#include "downwash/problems/space_problem_reader.hpp"

using namespace downwash;

namespace {

/// A flight from rest to rest with a turn, of a robot with three joints.
SpaceRunRecord straight_run() {
    SpaceRunRecord run;
    run.problem = read_space_problem(DOWNWASH_PROBLEMS "/space/around_a_girder.yaml");
    SpaceKnot end{400, {}};
    end.point.position[space::x] = 2;
    end.point.position[space::yaw] = 4;
    run.plan = SpacePlan{{{}, end}, 0.01, 3};
    return run;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const SpaceRunRecord run = straight_run();
    try {
        static_cast<void>(check_setpoints(run, {reinterpret_cast<const char*>(data), size}, "set-points", 30));
    } catch (const InputError&) {
    }
    return 0;
}
