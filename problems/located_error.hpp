#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// Something wrong, or outdated, in a problem or robot file.
struct LocatedError {
    std::string file;     ///< The file as the caller or the problem file names it.
    int line = 1;         ///< Counted from 1.
    int column = 1;       ///< In bytes, counted from 1.
    std::string message;  ///< What is wrong, what was expected, and the nearest valid name or another remedy.
};

/// "file:line:column: message"
[[nodiscard]] DOWNWASH_EXPORT std::string to_text(const LocatedError& error);

/// A problem or robot file cannot be used; what() has one line for every error.
class DOWNWASH_EXPORT ProblemFileError : public std::runtime_error {
 public:
    /// @pre there is at least one error
    explicit ProblemFileError(std::vector<LocatedError> errors);
    [[nodiscard]] const std::vector<LocatedError>& errors() const noexcept { return errors_; }

 private:
    std::vector<LocatedError> errors_;
};

}  // namespace downwash
