#pragma once

#include <memory>
#include <span>

#include "downwash/base/export.hpp"
#include "downwash/simulation/instructions.hpp"
#include "downwash/simulation/space_flight_job.hpp"
#include "downwash/simulation/space_pool_setup.hpp"

namespace downwash {

/// A thread pool that flies jobs in space side by side, in the lanes of wide registers. Every job ends exactly as if
/// SpaceLoop with equal steps flew it tick by tick, whatever the instructions, the number of threads and the other
/// jobs. FlightPool is that of the plane.
class DOWNWASH_EXPORT SpacePool {
 public:
    /// @param threads at least 1, the calling one included; the others wait between batches
    /// @throws InputError if the robot has more joints than this library was built for
    /// @pre space_robot_errors(robot) is empty, robot, volumes and checker outlive the pool, and the processor has the
    /// `instructions`
    explicit SpacePool(const SpacePoolSetup& setup, int threads = 1, Instructions instructions = best_instructions());
    ~SpacePool();
    SpacePool(const SpacePool&) = delete;
    SpacePool& operator=(const SpacePool&) = delete;

    /// The vehicle in a motion, as SpaceLoop::start() has it.
    /// @param world in which it begins; nullptr: the nominal one
    [[nodiscard]] AnySpaceState state_at(const SpaceMotion& motion, const SpaceWorld* world = nullptr,
                                         const SpaceCarry& carry = {}) const;

    /// Flies the jobs. No two threads may call this at once.
    void fly(std::span<SpaceFlightJob> jobs);
    /// Flies the chains to their ends; see FlightPool.
    void fly(std::span<SpaceFlightChain* const> chains);

    /// Sets how many of its threads the next batches use; see FlightPool.
    void use_threads(int threads);

    /// The pool of one number of joints.
    struct Impl;

 private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash
