#pragma once

#include "search_work.hpp"

namespace downwash::bench {

/// How work is dealt out to threads. The defaults are the planner's own rule.
struct SchedulePolicy {
    int threads = 1;           ///< threads of the search, as in SolveOptions; as many processors run them
    double wake_s = 0;         ///< until a thread that waited for a batch works on it
    int max_workers = 3;       ///< that run the tasks of a round
    bool flies_ahead = true;   ///< certificates fly as many chunks of worlds at once as keep the threads busy
    bool flies_beside = true;  ///< a plan's direct flight goes on beside its certificate
    int steps_in_flight = 1;   ///< steps of the tree, and of the refinement, that may run at a time
    int steps_merged = 1;      ///< whose batches are flown as one: the first of each step together, then the second ...
    int rounds_merged = 1;     ///< whose tasks do not wait for each other
    /// The share of the serial work of tree and refinement that their threads do side by side.
    double divided_share = 0;
};

/// What became of the processors' time in a simulated search [s]; all sums are over processors.
struct Schedule {
    double wall_s = 0;
    double work_s = 0;    ///< on one thread
    double narrow_s = 0;  ///< what flights take longer because fewer lanes of a register are in use
    /// Processors without work, by where in the search and by what goes on meanwhile; where both go on, by their share.
    struct Idle {
        double serial_s = 0, flights_s = 0;
    };
    Idle outside;    ///< before the first plan and between rounds
    Idle inside;     ///< in a round while both tree and refinement go on
    Idle round_end;  ///< in a round after one of them has ended
    [[nodiscard]] double idle_s() const noexcept {
        return outside.serial_s + outside.flights_s + inside.serial_s + inside.flights_s + round_end.serial_s +
               round_end.flights_s;
    }
};

/// Runs a recorded search again under a policy, in simulated time. A batch goes to lanes as FlightPool deals it out, a
/// round to workers as run_side_by_side() does. Where more threads want to run than there are processors, all get the
/// same share.
[[nodiscard]] Schedule simulate(const SearchWork& work, const SchedulePolicy& policy);

}  // namespace downwash::bench
