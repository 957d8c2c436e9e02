#pragma once

#include <cstdlib>

namespace downwash::test {

/// How often a test repeats what is random or alike: a few times, or often where DOWNWASH_LONG_TESTS is set, as in
/// .ci/full.
inline int repetitions(int few, int often) {
    return std::getenv("DOWNWASH_LONG_TESTS") != nullptr ? often : few;
}

}  // namespace downwash::test
