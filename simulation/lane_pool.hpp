#pragma once

// Threads that fly jobs side by side, in lanes: the one seam between families of vehicles and all above. Private: not
// installed.

#include <algorithm>
#include <atomic>
#include <concepts>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "downwash/base/parallel.hpp"
#include "downwash/simulation/lane_rows.hpp"

namespace downwash::simulation {

/// The flight of one job in one lane.
/// - `is_free()`: whether it has no job; `begin(job)`: takes one, which may end before its first tick
/// - `look(is_interrupted)`: decides how the flight goes on where the kernel stopped
/// - `move_from(other)`: goes on with another lane's job, and leaves that one free
/// - `can_fly()`, `idle_like(other)`: a lane without a job computes with ordinary numbers, those of another lane
/// - `chain()`, `follow(chain)`: the chain whose jobs it flies; nullptr for jobs that stand for themselves
template <class Lane, class Job, class Chain>
concept LaneOf = requires(Lane& lane, Lane& other, Job& job, Chain* chain) {
    { lane.is_free() } -> std::same_as<bool>;
    { lane.can_fly() } -> std::same_as<bool>;
    { lane.chain() } -> std::same_as<Chain*>;
    { chain->next() } -> std::same_as<Job*>;
    lane.begin(job);
    lane.look(true);
    lane.move_from(other);
    lane.idle_like(other);
    lane.follow(chain);
};

/// A family of vehicles: what its jobs, chains and lanes are.
/// - `Lanes(family)`: the lane_count lanes of one thread; `flights()`: they as a vector; `fly(busy)`: calls the kernel,
///   while the first so many have a job
/// - `is_over()`: whether flights end as interrupted; all threads ask
template <class Family>
concept FlightFamily = requires(const Family& family, typename Family::Lanes& lanes) {
    requires LaneOf < typename std::remove_cvref_t<decltype(lanes.flights())>::value_type,
    typename Family::Job, typename Family::Chain > ;
    requires std::constructible_from<typename Family::Lanes, const Family&>;
    { family.is_over() } -> std::same_as<bool>;
    lanes.fly(1);
};

/// The threads of a pool, and how they share out jobs. A lane whose flight ends takes the next job. What a job comes to
/// does not depend on threads and lanes, as long as it does not in the kernel.
template <FlightFamily Family>
class LanePool {
 public:
    using Job = typename Family::Job;
    using Chain = typename Family::Chain;

    /// @param family outlives the pool   @param threads at least 1, the calling one included
    LanePool(const Family& family, int threads) : family_(family) {
        others_ = start_threads(threads - 1, [this](int i) { stand_by(static_cast<std::size_t>(i)); });
        use_threads(threads);
    }
    ~LanePool() {
        {
            const std::scoped_lock lock(mutex_);
            is_closed_ = true;
        }
        called_.notify_all();
        others_.clear();  // joins
    }
    LanePool(const LanePool&) = delete;
    LanePool& operator=(const LanePool&) = delete;

    void use_threads(int threads) { allowed_ = std::min(static_cast<std::size_t>(threads - 1), others_.size()); }

    /// Flies jobs and chains to their ends. No two threads may call this at once.
    void fly(std::span<Job> jobs, std::span<Chain* const> chains) {
        jobs_ = jobs;
        chains_ = chains;
        next_job_ = 0;
        // One lane takes as long as two: two flights are not worth waking other threads.
        const std::size_t count = jobs.size() + chains.size();
        const std::size_t asked = count <= 2 ? 0 : allowed_.load();
        lanes_used_ = std::clamp<std::size_t>((count + asked) / (asked + 1), 1, lane_count);
        if (asked == 0) {
            work();
            return;
        }
        {
            const std::scoped_lock lock(mutex_);
            ++batch_;
            helpers_ = asked;
            working_ = asked;
        }
        called_.notify_all();
        std::exception_ptr own;
        try {
            work();
        } catch (...) {
            own = std::current_exception();  // the others still fly the jobs
        }
        std::unique_lock lock(mutex_);
        done_.wait(lock, [this] { return working_ == 0; });
        if (std::exception_ptr other = std::exchange(failure_, nullptr); other && !own) {
            own = std::move(other);
        }
        if (own) {
            std::rethrow_exception(own);
        }
    }

 private:
    /// Flies jobs until none is left. Several threads may call it at once.
    void work() {
        typename Family::Lanes lanes(family_);
        auto& flights = lanes.flights();
        for (;;) {
            for (auto& lane : std::span(flights).first(lanes_used_)) {
                while (lane.is_free() && go_on(lane)) {
                }
            }
            const int busy = move_together(flights);
            if (busy == 0) {
                return;
            }
            for (auto& lane : flights) {
                if (!lane.can_fly()) {
                    lane.idle_like(flights.front());
                }
            }
            lanes.fly(busy);
            const bool is_interrupted = family_.is_over();
            for (auto& lane : flights) {
                if (!lane.is_free()) {
                    lane.look(is_interrupted);
                }
            }
        }
    }

    /// Gives a free lane the next job: of its chain or, once that has ended, of those that nobody has begun.
    /// @return false if there is none
    template <class Lane>
    bool go_on(Lane& lane) {
        for (;;) {
            if (Chain* const chain = lane.chain()) {
                if (Job* const job = chain->next()) {
                    lane.begin(*job);
                    return true;
                }
                lane.follow(nullptr);
            }
            const std::size_t next = next_job_++;
            if (next < jobs_.size()) {
                lane.begin(jobs_[next]);
                return true;
            }
            if (next - jobs_.size() >= chains_.size()) {
                return false;
            }
            lane.follow(chains_[next - jobs_.size()]);
        }
    }

    /// Moves the flights into the first lanes, and says how many there are.
    template <class Flights>
    static int move_together(Flights& flights) {
        int busy = 0;
        for (auto& lane : flights) {
            if (lane.is_free()) {
                continue;
            }
            auto& first_free = flights[static_cast<std::size_t>(busy++)];
            if (first_free.is_free()) {
                first_free.move_from(lane);
            }
        }
        return busy;
    }

    /// Waits for batches until the pool is closed.
    /// @param number of the thread, 1 for the first beside the calling one
    void stand_by(std::size_t number) {
        std::uint64_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex_);
                called_.wait(lock, [&] { return is_closed_ || batch_ != seen; });
                if (is_closed_) {
                    return;
                }
                seen = batch_;
                if (number > helpers_) {
                    continue;
                }
            }
            std::exception_ptr thrown;
            try {
                work();
            } catch (...) {
                thrown = std::current_exception();
            }
            const std::scoped_lock lock(mutex_);
            if (thrown) {
                failure_ = thrown;
            }
            if (--working_ == 0) {
                done_.notify_one();
            }
        }
    }

    const Family& family_;
    std::span<Job> jobs_;
    std::span<Chain* const> chains_;
    std::size_t lanes_used_ = lane_count;   ///< of every thread: few jobs are shared out evenly
    std::atomic<std::size_t> next_job_{0};  ///< or chain, behind all jobs

    std::mutex mutex_;
    std::condition_variable called_, done_;
    std::uint64_t batch_ = 0;
    std::atomic<std::size_t> allowed_{0};  ///< threads beside the calling one that may fly
    std::size_t helpers_ = 0;              ///< that fly this batch
    std::size_t working_ = 0;              ///< of them, still at it
    std::exception_ptr failure_;           ///< of a thread beside the calling one
    bool is_closed_ = false;
    std::vector<std::jthread> others_;
};

}  // namespace downwash::simulation
