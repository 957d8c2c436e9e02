#include "scarce_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace downwash::test {

std::atomic<bool> memory_is_scarce = false;

}  // namespace downwash::test

void* operator new(std::size_t bytes, const std::nothrow_t& /*tag*/) noexcept {
    constexpr std::size_t large = 100'000;
    const bool is_denied = downwash::test::memory_is_scarce && bytes >= large;
    return is_denied ? nullptr : std::malloc(std::max<std::size_t>(bytes, 1));
}
void* operator new(std::size_t bytes) {
    void* const memory = operator new(bytes, std::nothrow);
    if (memory == nullptr) {
        throw std::bad_alloc();
    }
    return memory;
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*bytes*/) noexcept {
    std::free(memory);
}
