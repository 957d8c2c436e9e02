#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <span>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace downwash {

/// Starts threads that run function(1), function(2), ... function(count): as many of them as the system has left.
template <class Function>
[[nodiscard]] std::vector<std::jthread> start_threads(int count, const Function& function) {
    std::vector<std::jthread> threads;
    threads.reserve(static_cast<std::size_t>(std::max(count, 0)));
    try {
        for (int i = 1; i <= count; ++i) {
            threads.emplace_back(function, i);
        }
    } catch (const std::system_error&) {  // no more threads; those that there are do the work
    } catch (const std::bad_alloc&) {     // no memory for more
    }
    return threads;
}

/// Runs task(0), task(1), ... task(count - 1) on some threads, in any order, and waits for all of them. Rethrows what a
/// task throws.
/// @param threads at least 1, the calling one included
/// @param on_progress called from the calling thread with the share of tasks that have begun
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
        const std::vector<std::jthread> others = start_threads(threads - 1, [&work](int) { work(false); });
        work(true);
    }
    if (failure) {
        std::rethrow_exception(failure);
    }
}

/// A task that runs in steps: runs the next step; false if that was the last one. Tasks share no data.
using SteppedTask = std::function<bool()>;

/// Runs some tasks to their ends side by side: the steps of one task one after the other, those of different tasks on
/// any threads. A free thread takes the task that has had the least time, so that tasks of the same length end
/// together. Rethrows what a step throws.
/// @param threads at least 1, the calling one included
inline void run_side_by_side(std::span<const SteppedTask> tasks, int threads) {
    using Clock = std::chrono::steady_clock;
    struct Turn {
        Clock::duration spent{};
        bool is_taken = false;  ///< by a thread, or for good because the task has ended
    };
    std::vector<Turn> turns(tasks.size());
    std::mutex mutex;
    const auto work = [&](std::size_t) {
        for (;;) {
            std::size_t mine = tasks.size();
            {
                const std::scoped_lock lock(mutex);
                for (std::size_t i = 0; i < turns.size(); ++i) {
                    if (!turns[i].is_taken && (mine == tasks.size() || turns[i].spent < turns[mine].spent)) {
                        mine = i;
                    }
                }
                if (mine == tasks.size()) {
                    return;  // the threads that have the others run them to their ends
                }
                turns[mine].is_taken = true;
            }
            const Clock::time_point began = Clock::now();
            const bool goes_on = tasks[mine]();
            const Clock::time_point ended = Clock::now();
            const std::scoped_lock lock(mutex);
            turns[mine].spent += ended - began;
            turns[mine].is_taken = !goes_on;
        }
    };
    const int workers = std::min(threads, static_cast<int>(tasks.size()));
    run_parallel(static_cast<std::size_t>(workers), workers, work);
}

}  // namespace downwash
