#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash {

/// Errors of one text file, each with its place; reading ends with the twentieth.
class DOWNWASH_EXPORT LineErrors {
 public:
    /// @param file its name in messages
    explicit LineErrors(std::string file) : file_(std::move(file)) {}

    /// In a line, counted from 1; 0 stands for the file as a whole. @throws InputError with the twentieth
    void add(std::size_t line, const std::string& message);
    /// At a column, counted from 1 in bytes of the line. @throws InputError with the twentieth
    void add(std::size_t line, std::size_t column, const std::string& message);
    /// @throws InputError when there are any
    void throw_any() const;

 private:
    void add_at(const std::string& place, const std::string& message);

    std::string file_;
    std::vector<KeyError> errors_;
};

}  // namespace downwash
