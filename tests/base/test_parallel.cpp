#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "../support/short_of_memory.hpp"
#include "downwash/base/parallel.hpp"

using namespace downwash;

TEST_CASE("the task that has had the least time goes on, the first one first, until all have ended") {
    std::string order;
    const auto task = [&order](char name, int steps, std::chrono::milliseconds each) -> SteppedTask {
        return [&order, name, steps, each, done = 0]() mutable {
            if (done == steps) {
                return false;
            }
            order += name;
            ++done;
            std::this_thread::sleep_for(each);
            return true;
        };
    };
    using std::chrono::milliseconds;
    const SteppedTask tasks[] = {task('a', 2, milliseconds(100)), task('b', 4, milliseconds(0)),
                                 task('c', 0, milliseconds(0))};
    run_side_by_side(tasks, 1);
    CHECK(order == "abbbba");
}

TEST_CASE("a task runs on one thread at a time, and all tasks run to their ends") {
    constexpr int steps = 200;
    for (const int threads : {2, 3, 8}) {
        struct Work {
            int done = 0;  // no lock: nobody else may touch it
            std::atomic<bool> is_busy{false};
        };
        Work work[3];
        std::atomic<int> overlaps{0};
        const auto task = [&](Work& mine) -> SteppedTask {
            return [&] {
                overlaps += mine.is_busy.exchange(true) ? 1 : 0;
                const bool goes_on = ++mine.done < steps;
                mine.is_busy = false;
                return goes_on;
            };
        };
        const SteppedTask tasks[] = {task(work[0]), task(work[1]), task(work[2])};
        run_side_by_side(tasks, threads);
        CHECK(overlaps == 0);
        for (const Work& w : work) {
            CHECK(w.done == steps);
        }
    }
}

TEST_CASE("two tasks on two threads really run side by side") {
    std::atomic<bool> first_is_there{false};
    std::atomic<bool> second_is_there{false};
    // Each waits for the other, which one after the other would never come.
    const auto meets = [](std::atomic<bool>& mine, const std::atomic<bool>& other) -> SteppedTask {
        return [&mine, &other] {
            mine = true;
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
            while (!other && std::chrono::steady_clock::now() < end) {
                std::this_thread::yield();
            }
            if (!other) {
                throw std::runtime_error("the other task did not come");
            }
            return false;
        };
    };
    const SteppedTask tasks[] = {meets(first_is_there, second_is_there), meets(second_is_there, first_is_there)};
    CHECK_NOTHROW(run_side_by_side(tasks, 2));
}

TEST_CASE("what a step throws reaches the caller") {
    for (const int threads : {1, 2}) {
        int others = 0;
        const SteppedTask tasks[] = {[]() -> bool { throw std::runtime_error("no way on"); },
                                     [&others] { return ++others < 50; }};
        CHECK_THROWS_WITH(run_side_by_side(tasks, threads), "no way on");
        CHECK(others <= 50);
    }
}

TEST_CASE("tasks are done on as many threads as there can be") {
    if (!test::can_limit_memory) {
        SUCCEED("not with sanitizers");
        return;
    }
    CHECK(test::succeeds_with_memory_left(100'000'000, [] {
        std::atomic<int> done{0};
        run_parallel(1000, 500, [&done](std::size_t) { ++done; });  // stacks for twelve
        return done == 1000;
    }));
}
