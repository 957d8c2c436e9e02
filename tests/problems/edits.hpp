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
inline std::string errors_after(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(edited(good_problem, from, to), good_robot);
}

/// What reading the sound problem says after a change to its robot's file.
inline std::string errors_after_robot(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(good_problem, edited(good_robot, from, to));
}

template <std::size_t count>
void check(const Edit (&edits)[count],
           std::string (&errors_after)(const TestFolder&, std::string_view, std::string_view)) {
    const TestFolder folder;
    for (const Edit& edit : edits) {
        CAPTURE(edit.from, edit.to);
        CHECK(errors_after(folder, edit.from, edit.to) == edit.errors);
    }
}

}  // namespace downwash::test
