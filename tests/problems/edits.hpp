#pragma once

#include <string>
#include <string_view>

#include "../support/test_files.hpp"

namespace downwash::test {

/// One change to a sound file and every error that it must lead to.
struct Edit {
    std::string_view from, to;
    std::string_view errors;
};

/// What reading the sound problem says after a change to its own file.
inline std::string errors_after(const TestFolder& folder, const Edit& edit) {
    folder.write("problem.yaml", edited(good_problem, edit.from, edit.to));
    folder.write("robot.yaml", good_robot);
    return folder.errors_of("problem.yaml");
}

/// What reading the sound problem says after a change to its robot's file.
inline std::string errors_after_robot(const TestFolder& folder, const Edit& edit) {
    folder.write("problem.yaml", good_problem);
    folder.write("robot.yaml", edited(good_robot, edit.from, edit.to));
    return folder.errors_of("problem.yaml");
}

}  // namespace downwash::test
