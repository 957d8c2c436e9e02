#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/fault.hpp"

namespace downwash {

/// Faults of one text file, each with its place; reading ends with the twentieth.
class DOWNWASH_EXPORT LineFaults {
 public:
    explicit LineFaults(std::string file) : file_(std::move(file)) {}

    /// @param line counted from 1; 0 for the file as a whole  @throws InputError with the twentieth
    void add(std::size_t line, const std::string& message);
    /// @param column of the line's bytes, counted from 1
    void add(std::size_t line, std::size_t column, const std::string& message);
    /// @throws InputError when there are any
    void throw_any() const;

 private:
    void add_at(const std::string& place, const std::string& message);

    std::string file_;
    std::vector<Fault> faults_;
};

}  // namespace downwash
