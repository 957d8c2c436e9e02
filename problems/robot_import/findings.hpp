#pragma once

#include <string>
#include <utility>
#include <vector>

#include "downwash/problems/located_error.hpp"

namespace downwash::robot_import {

/// A place in the file that is imported, counted from 1.
struct Place {
    int line = 1, column = 1;
};

/// What is wrong in a file and what is likely not meant, each with its place.
class Findings {
 public:
    /// @param file as messages name it
    explicit Findings(std::string file) : file_(std::move(file)) {}

    void error(const Place& place, std::string message) { errors_.push_back(located(place, std::move(message))); }
    void warn(const Place& place, std::string message) { warnings_.push_back(located(place, std::move(message))); }
    [[nodiscard]] bool has_errors() const noexcept { return !errors_.empty(); }
    [[nodiscard]] const std::vector<LocatedError>& warnings() const noexcept { return warnings_; }
    [[nodiscard]] const std::string& file() const noexcept { return file_; }

    /// @throws ProblemFileError if there are errors
    void throw_if_any() const {
        if (!errors_.empty()) {
            throw ProblemFileError(errors_);
        }
    }
    /// @throws ProblemFileError with this error and all before
    [[noreturn]] void fail(const Place& place, std::string message) {
        error(place, std::move(message));
        throw ProblemFileError(errors_);
    }

 private:
    [[nodiscard]] LocatedError located(const Place& place, std::string message) const {
        return {file_, place.line, place.column, std::move(message)};
    }

    std::string file_;
    std::vector<LocatedError> errors_, warnings_;
};

}  // namespace downwash::robot_import
