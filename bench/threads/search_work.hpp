#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/simulation/work_recorder.hpp"

namespace downwash::bench {

/// The time of a tick of one thread, by how many lanes of its register are in use.
struct TickTime {
    double few_s = 0;   ///< time of a tick of the kernel for few lanes
    double many_s = 0;  ///< time of a tick of the kernel for many lanes
    double lane_s = 0;  ///< time of a lane's checks, beside the kernel

    static constexpr int few_lanes = 4;
    [[nodiscard]] double at(int lanes) const noexcept { return (lanes > few_lanes ? many_s : few_s) + lane_s * lanes; }
};

/// A piece of work as the simulated schedule deals it out.
struct WorkItem {
    enum class Kind : std::uint8_t { serial, parallel, batch };
    Kind kind = Kind::serial;
    double work_s = 0;                ///< on one thread
    std::size_t items = 0;            ///< items of parallel work, of equal length
    std::vector<std::int64_t> ticks;  ///< ticks of each job of a batch
    TickTime tick;                    ///< time of a tick of a batch
};

using WorkChain = std::vector<WorkItem>;

/// A round: what its tasks (execution, tree, refinement) do in steps, one after the other.
struct WorkRound {
    std::array<std::vector<WorkChain>, 3> tasks;
};

/// A part of a search: work outside rounds, then a round, which may be empty.
struct WorkStage {
    WorkChain before;
    WorkRound round;
};

/// A whole search.
struct SearchWork {
    std::vector<WorkStage> stages;
};

/// The least-squares fit, with no negative time, of the ticks and times of batches of the same kind.
[[nodiscard]] TickTime fitted_tick_time(std::span<const WorkPiece* const> batches);

/// How long a batch takes on one thread whose jobs are taken up in their order [s].
[[nodiscard]] double one_thread_time_s(std::span<const std::int64_t> job_ticks, const TickTime& tick);

/// The work of a search from its record on one thread. Tick times are fitted by kind of batch, then scaled so that each
/// batch takes as long on one thread as it took.
/// @param end_s when the search ended, by the clock of the pieces   @param begin_s when it began
[[nodiscard]] SearchWork search_work(std::span<const WorkPiece> pieces, double begin_s, double end_s);

/// Processor time by what it was spent on [s].
struct WorkShares {
    double outside_serial_s = 0, outside_flights_s = 0;       ///< before the first plan and between rounds
    std::array<double, 3> task_serial_s{}, task_flights_s{};  ///< time of rounds, by task
    std::size_t rounds = 0, steps = 0, batches = 0, jobs = 0;

    [[nodiscard]] double all_s() const noexcept;
};
[[nodiscard]] WorkShares shares_of(const SearchWork& work);

}  // namespace downwash::bench
