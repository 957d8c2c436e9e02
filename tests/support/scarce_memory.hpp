#pragma once

#include <atomic>

namespace downwash::test {

/// While it holds, no piece of memory of 100 kB or more is to be had: the global operator new throws std::bad_alloc. A
/// program that uses it compiles scarce_memory.cpp too.
extern std::atomic<bool> memory_is_scarce;

}  // namespace downwash::test
