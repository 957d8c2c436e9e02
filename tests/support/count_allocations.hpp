#pragma once

// Replaces the global operator new of a test program by one that counts. Include it in one source of a program only.

#include <cstdlib>
#include <new>

namespace downwash::test {

/// Allocations of this thread so far.
inline thread_local long allocations = 0;

}  // namespace downwash::test

// Where they are inlined, GCC takes what delete frees for memory of another allocator.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
    ++downwash::test::allocations;
    return std::malloc(size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* memory = operator new(size, std::nothrow)) {
        return memory;
    }
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*unused*/) noexcept {
    std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t& /*unused*/) noexcept {
    std::free(memory);
}
