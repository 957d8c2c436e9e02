#include <atomic>
#include <catch2/catch.hpp>
#include <latch>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "downwash/aeromap/block_store.hpp"

using namespace downwash;

namespace {

using Numbers = std::vector<int>;

std::shared_ptr<const Numbers> digits_of(std::size_t number) {
    return std::make_shared<const Numbers>(Numbers{static_cast<int>(number / 10), static_cast<int>(number % 10)});
}

}  // namespace

TEST_CASE("a block is made at the first question, and stays where it is") {
    BlockStore<Numbers> store(100);
    CHECK(store.find(42) == nullptr);
    int made = 0;
    const auto make = [&made](std::size_t number) {
        ++made;
        return digits_of(number);
    };
    const Numbers& first = store.get(42, make);
    CHECK(first == Numbers{4, 2});
    CHECK(&store.get(42, make) == &first);
    CHECK(store.find(42) == &first);
    CHECK(store.slots()[42] == &first);
    CHECK(store.share(42).get() == &first);
    CHECK(store.share(43) == nullptr);
    CHECK(made == 1);
    CHECK_FALSE(store.try_make(42, make));
    CHECK(store.try_make(7, make));
    CHECK(store.made() == std::vector<std::size_t>{7, 42});
}

TEST_CASE("many threads that ask for the same blocks make each of them once") {
    constexpr int threads = 4;
    constexpr std::size_t blocks = 200;
    BlockStore<Numbers> store(blocks);
    std::atomic<int> made{0};
    std::atomic<int> wrong{0};
    {
        std::latch start(threads);
        std::vector<std::jthread> all;
        for (int thread = 0; thread < threads; ++thread) {
            all.emplace_back([&, thread] {
                start.arrive_and_wait();
                for (std::size_t i = 0; i < blocks; ++i) {
                    const std::size_t number = thread % 2 == 0 ? i : blocks - 1 - i;
                    const Numbers& block = store.get(number, [&made](std::size_t which) {
                        ++made;
                        return digits_of(which);
                    });
                    wrong += block == *digits_of(number) ? 0 : 1;
                }
            });
        }
    }
    CHECK(made == static_cast<int>(blocks));
    CHECK(wrong == 0);
}

TEST_CASE("while one thread makes a block another one knows it, and can make another block") {
    BlockStore<Numbers> store(3);
    std::latch is_begun(1);
    std::latch may_end(1);
    std::jthread maker([&] {
        store.get(1, [&](std::size_t number) {
            is_begun.count_down();
            may_end.wait();
            return digits_of(number);
        });
    });
    is_begun.wait();
    CHECK(store.is_in_the_making(1));
    CHECK_FALSE(store.is_in_the_making(2));
    CHECK_FALSE(store.try_make(1, digits_of));
    CHECK(store.try_make(2, digits_of));
    CHECK(store.find(1) == nullptr);
    may_end.count_down();
    const Numbers& block =
        store.get(1, [](std::size_t) -> std::shared_ptr<const Numbers> { throw std::logic_error("made twice"); });
    CHECK(block == Numbers{0, 1});
    maker.join();
    CHECK_FALSE(store.is_in_the_making(1));
}

TEST_CASE("a block whose making failed can be asked for again, also by a thread that waited") {
    BlockStore<Numbers> store(2);
    const auto fail = [](std::size_t) -> std::shared_ptr<const Numbers> { throw std::runtime_error("no memory"); };
    CHECK_THROWS_AS(store.get(0, fail), std::runtime_error);
    CHECK_THROWS_AS(store.try_make(0, fail), std::runtime_error);
    CHECK_FALSE(store.is_in_the_making(0));
    CHECK(store.get(0, digits_of) == Numbers{0, 0});

    std::latch is_begun(1);
    std::latch may_fail(1);
    std::jthread failing([&] {
        try {
            store.get(1, [&](std::size_t) -> std::shared_ptr<const Numbers> {
                is_begun.count_down();
                may_fail.wait();
                throw std::runtime_error("no memory");
            });
        } catch (const std::runtime_error&) {  // as it should
        }
    });
    is_begun.wait();
    std::jthread waiting([&] { CHECK(store.get(1, digits_of) == Numbers{0, 1}); });
    may_fail.count_down();
    waiting.join();
    CHECK(store.find(1) != nullptr);
}

TEST_CASE("equal twins are kept as one block, unequal ones and others are not") {
    BlockStore<Numbers> store(4);
    const auto same = [](std::size_t) { return digits_of(5); };
    const std::vector<std::size_t> twins{0, 1, 2};
    const Numbers& first = store.get(0, same, twins);
    CHECK(&store.get(1, same, twins) == &first);
    CHECK(&store.get(2, digits_of, twins) != &first);
    CHECK(&store.get(3, same) != &first);
    CHECK(store.get(3, same) == first);
}

TEST_CASE("new blocks are those that were made since the last question, and not put there") {
    BlockStore<Numbers> store(5);
    CHECK(store.take_new().empty());
    store.put(3, digits_of(3));
    store.put(3, digits_of(4));
    CHECK(*store.find(3) == Numbers{0, 3});
    store.get(4, digits_of);
    store.get(1, digits_of);
    store.get(3, digits_of);
    CHECK(store.take_new() == std::vector<std::size_t>{1, 4});
    CHECK(store.take_new().empty());
    store.get(0, digits_of);
    CHECK(store.take_new() == std::vector<std::size_t>{0});
}
