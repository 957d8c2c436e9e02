#pragma once

#include <string>

#include "downwash/problems/problem.hpp"
#include "downwash/problems/problem_reader.hpp"

namespace downwash::test {

inline constexpr const char* shipped_names[] = {"along_the_deck", "box_girder_bay", "bridge_inspection", "culvert",
                                                "girder_mesh",    "open_air",       "pipe_rack",         "window"};

/// A shipped problem.
inline Problem shipped(const std::string& name) {
    return read_problem(DOWNWASH_PROBLEMS "/" + name + ".yaml");
}

}  // namespace downwash::test
