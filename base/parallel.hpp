#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
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

}  // namespace downwash
