#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "downwash/aeromap/aero_map.hpp"
#include "scenes.hpp"

using namespace downwash;

namespace {
thread_local long allocations = 0;
}

void* operator new(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size)) {
        return memory;
    }
    throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

TEST_CASE("Neither the direct effect nor a look-up allocates") {
    test::Random random(41);
    const auto effect = std::make_shared<const DirectEffect>(test::scene_of(test::bridge()), AeroSettings{}, 0.15);
    const AeroMap map(effect, {}, {-1, 1, 3, 5}, {0}, 1);
    const long before = allocations;
    double sum = 0;
    for (int i = 0; i < 20000; ++i) {
        const double x = random.uniform(-12, 12);
        const double z = random.uniform(0, 12);
        sum += effect->factor({x, random.uniform(-1, 1), z}) + map.factor(0, random.uniform(-1, 1), z);
    }
    const long made = allocations - before;
    CHECK(made == 0);
    CHECK(sum > 40000);
}
