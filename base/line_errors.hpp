#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash {

/// Collects the errors of one text file with their places: twenty of them, and how many more there are.
class DOWNWASH_EXPORT LineErrors {
 public:
    /// @param file its name in messages
    explicit LineErrors(std::string file) : file_(std::move(file)) {}

    /// @param line from 1; 0 means the whole file
    void add(std::size_t line, const std::string& message);
    /// @param column from 1, in bytes of the line
    void add(std::size_t line, std::size_t column, const std::string& message);
    /// @throws InputError if there are errors
    void throw_any() const;
    /// The first twenty.
    [[nodiscard]] const std::vector<KeyError>& errors() const noexcept { return errors_; }

 private:
    void add_at(const std::string& place, const std::string& message);

    std::string file_;
    std::vector<KeyError> errors_;
    std::size_t more_ = 0;
};

}  // namespace downwash
