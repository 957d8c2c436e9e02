#pragma once

#include <memory>
#include <span>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight_job.hpp"
#include "downwash/simulation/instructions.hpp"

namespace downwash {

/// A thread pool that flies jobs side by side, in the lanes of wide registers. Every job ends exactly as if fly() flew
/// its legs one after the other, whatever the instructions and the number of threads. A lane whose flight ends takes
/// the next job.
class DOWNWASH_EXPORT FlightPool {
 public:
    /// @param map,rules as for fly(); all threads call rules.is_over
    /// @param goal of jobs with judged_ticks and no goal of their own; may be nullptr when there are none
    /// @param threads at least 1, the calling one included; the others wait between batches
    /// @pre model, map and goal outlive the pool, and the processor has the `instructions`
    FlightPool(const FlightModel& model, const AeroMap* map, FlightRules rules, const Goal* goal, int threads = 1,
               Instructions instructions = best_instructions());
    ~FlightPool();
    FlightPool(const FlightPool&) = delete;
    FlightPool& operator=(const FlightPool&) = delete;

    /// Flies the jobs. No two threads may call this at once.
    void fly(std::span<FlightJob> jobs);
    /// Flies the chains to their ends. A lane goes on with the next job of its chain at once, so that no lane waits for
    /// jobs that others still fly.
    void fly(std::span<FlightChain* const> chains);

    /// Sets how many of its threads the next batches use: at least 1, the calling one included. You may call this from
    /// any thread, also during a batch.
    void use_threads(int threads);

    /// The rules given to the constructor.
    [[nodiscard]] const FlightRules& rules() const noexcept;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace downwash
