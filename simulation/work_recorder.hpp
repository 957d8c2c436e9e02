#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// A piece of work that a search has done.
struct WorkPiece {
    enum class Kind : std::uint8_t {
        batch,     ///< flights that a FlightPool flew side by side
        parallel,  ///< items that any threads may take, each by itself
        step,      ///< of a task of a round; the pieces above lie in it, and the rest of it is serial
        round,     ///< of a search; steps lie in it
    };
    static constexpr std::size_t max_lanes = 8;

    Kind kind = Kind::batch;
    /// Processor time of the thread that began and ended it, from any moment on [s]: on one thread, pieces lie one
    /// after the other or one in the other.
    double begin_s = 0, end_s = 0;
    int task = 0;           ///< of a step: 0 the best plan's execution, 1 the tree, 2 the refinement
    bool goes_on = false;   ///< of a step: it was not the last one of its task
    std::size_t items = 0;  ///< of parallel work
    /// Of a batch: the control ticks that each job flew, in the order in which jobs are dealt out.
    std::vector<std::int64_t> job_ticks;
    /// Of a batch: for how many ticks so many lanes of a register were in use, by their number less one.
    std::array<std::int64_t, max_lanes> lane_ticks{};
    bool is_in_worlds = false, has_noise = false;  ///< of a batch: what some of its flights meet
};

/// Notes the pieces of a search's work as they end, from any thread. A search that has none notes nothing; one that has
/// plans the same.
class DOWNWASH_EXPORT WorkRecorder {
 public:
    /// A piece for which there is no memory is lost.
    void add(WorkPiece piece) noexcept;
    /// What was noted since the last call, in the order in which it ended.
    [[nodiscard]] std::vector<WorkPiece> take();

    /// As in a piece [s].
    [[nodiscard]] static double now_s();

 private:
    std::mutex mutex_;
    std::vector<WorkPiece> pieces_;
};

/// Notes work that is shared out item by item, as long as it goes on; without a recorder nothing.
class DOWNWASH_EXPORT ParallelScope {
 public:
    ParallelScope(WorkRecorder* recorder, std::size_t items)
        : recorder_(recorder), items_(items), begin_s_(recorder != nullptr ? WorkRecorder::now_s() : 0) {}
    ~ParallelScope();
    ParallelScope(const ParallelScope&) = delete;
    ParallelScope& operator=(const ParallelScope&) = delete;

 private:
    WorkRecorder* recorder_;
    std::size_t items_;
    double begin_s_;
};

}  // namespace downwash
