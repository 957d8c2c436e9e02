#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace downwash {

/// Does task(0), task(1), ... task(count - 1) on some threads, in any order, and waits for all; rethrows what a task
/// threw.
/// @param threads at least 1, the calling one included
/// @param on_progress called now and then with the share that is begun, from the calling thread
template <class Task>
void run_parallel(std::size_t count, int threads, const Task& task,
                  const std::function<void(double)>& on_progress = {}) {
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&](bool reports) {
        try {
            for (std::size_t i = next++; i < count; i = next++) {
                task(i);
                if (reports && on_progress) {
                    on_progress(static_cast<double>(i + 1) / static_cast<double>(count));
                }
            }
        } catch (...) {
            next = count;
            const std::scoped_lock lock(failure_mutex);
            failure = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        for (int t = 1; t < threads; ++t) {
            others.emplace_back(work, false);
        }
        work(true);
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

/// Work that is done piece by piece: does the next piece, or says that there is none left. Works on nothing that
/// another strand works on.
using Strand = std::function<bool()>;

/// Works on some strands side by side until none has a piece left: the pieces of one strand one after the other, those
/// of different strands on any threads. A thread that is free takes the strand that has had the least time, so that
/// strands of the same length end together. Rethrows what a piece threw.
/// @param threads at least 1, the calling one included
inline void run_side_by_side(std::span<const Strand> strands, int threads) {
    using Clock = std::chrono::steady_clock;
    struct Turn {
        Clock::duration spent{};
        bool is_taken = false;  ///< by a thread, or for good: it is at its end
    };
    std::vector<Turn> turns(strands.size());
    std::mutex mutex;
    const auto work = [&](std::size_t) {
        for (;;) {
            std::size_t mine = strands.size();
            {
                const std::scoped_lock lock(mutex);
                for (std::size_t i = 0; i < turns.size(); ++i) {
                    if (!turns[i].is_taken && (mine == strands.size() || turns[i].spent < turns[mine].spent)) {
                        mine = i;
                    }
                }
                if (mine == strands.size()) {
                    return;  // whoever has one of the others goes on with it to its end
                }
                turns[mine].is_taken = true;
            }
            const Clock::time_point began = Clock::now();
            const bool goes_on = strands[mine]();
            const Clock::time_point ended = Clock::now();
            const std::scoped_lock lock(mutex);
            turns[mine].spent += ended - began;
            turns[mine].is_taken = !goes_on;
        }
    };
    const int workers = std::min(threads, static_cast<int>(strands.size()));
    run_parallel(static_cast<std::size_t>(workers), workers, work);
}

}  // namespace downwash
