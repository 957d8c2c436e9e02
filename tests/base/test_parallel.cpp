#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "downwash/base/parallel.hpp"

using namespace downwash;

TEST_CASE("the strand that has had the least time goes on, the first one first, until none has a piece left") {
    std::string order;
    const auto strand = [&order](char name, int pieces, std::chrono::milliseconds each) -> Strand {
        return [&order, name, pieces, each, done = 0]() mutable {
            if (done == pieces) {
                return false;
            }
            order += name;
            ++done;
            std::this_thread::sleep_for(each);
            return true;
        };
    };
    using std::chrono::milliseconds;
    const Strand strands[] = {strand('a', 2, milliseconds(100)), strand('b', 4, milliseconds(0)),
                              strand('c', 0, milliseconds(0))};
    run_side_by_side(strands, 1);
    CHECK(order == "abbbba");
}

TEST_CASE("a strand is worked on by one thread at a time, and all of them to their ends") {
    constexpr int pieces = 200;
    for (const int threads : {2, 3, 8}) {
        struct Work {
            int done = 0;  // no lock: nobody else may touch it
            std::atomic<bool> is_busy{false};
        };
        Work work[3];
        std::atomic<int> overlaps{0};
        const auto strand = [&](Work& mine) -> Strand {
            return [&] {
                overlaps += mine.is_busy.exchange(true) ? 1 : 0;
                const bool goes_on = ++mine.done < pieces;
                mine.is_busy = false;
                return goes_on;
            };
        };
        const Strand strands[] = {strand(work[0]), strand(work[1]), strand(work[2])};
        run_side_by_side(strands, threads);
        CHECK(overlaps == 0);
        for (const Work& w : work) {
            CHECK(w.done == pieces);
        }
    }
}

TEST_CASE("two strands on two threads really go on side by side") {
    std::atomic<bool> first_is_there{false};
    std::atomic<bool> second_is_there{false};
    // Each waits for the other, which one after the other would never come.
    const auto meets = [](std::atomic<bool>& mine, const std::atomic<bool>& other) -> Strand {
        return [&mine, &other] {
            mine = true;
            const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
            while (!other && std::chrono::steady_clock::now() < end) {
                std::this_thread::yield();
            }
            if (!other) {
                throw std::runtime_error("the other strand did not come");
            }
            return false;
        };
    };
    const Strand strands[] = {meets(first_is_there, second_is_there), meets(second_is_there, first_is_there)};
    CHECK_NOTHROW(run_side_by_side(strands, 2));
}

TEST_CASE("what a piece throws reaches the caller") {
    for (const int threads : {1, 2}) {
        int others = 0;
        const Strand strands[] = {[]() -> bool { throw std::runtime_error("no way on"); },
                                  [&others] { return ++others < 50; }};
        CHECK_THROWS_WITH(run_side_by_side(strands, threads), "no way on");
        CHECK(others <= 50);
    }
}
