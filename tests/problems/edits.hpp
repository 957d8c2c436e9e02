#pragma once

#include <string>
#include <string_view>

#include "../support/test_files.hpp"

namespace downwash::test {

/// One change to a sound file and every error that it must lead to, line by line from the line's number on.
struct Edit {
    std::string_view from, to;
    std::string_view errors;

    /// The errors in a file.
    [[nodiscard]] std::string errors_in(const std::string& file) const {
        std::string text = file + ":";
        for (const char c : errors) {
            text += c == '\n' ? "\n" + file + ":" : std::string(1, c);
        }
        return text;
    }
};

/// What reading the sound problem says after a change to its own file.
inline std::string errors_after(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(edited(good_problem, from, to), good_robot);
}

/// What reading the sound problem says after a change to its robot's file.
inline std::string errors_after_robot(const TestFolder& folder, std::string_view from, std::string_view to) {
    return folder.errors_of(good_problem, edited(good_robot, from, to));
}

/// Checks every edit of a file.
template <std::size_t count, class ErrorsAfter>
void check(const Edit (&edits)[count], const std::string& file, const ErrorsAfter& errors_after) {
    for (const Edit& edit : edits) {
        CAPTURE(edit.from, edit.to);
        CHECK(errors_after(edit.from, edit.to) == edit.errors_in(file));
    }
}

}  // namespace downwash::test
