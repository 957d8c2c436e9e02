#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// An error in what a user wrote: where it is and what to do about it.
struct KeyError {
    /// Key path within the problem, for example "start.x_m", "robot.rotors" or "environment.obstacles[2].box".
    std::string key;
    /// What is wrong, what was expected, and a remedy.
    std::string message;
};

/// A module throws this if it cannot use its input. It carries every error that one reading found.
class DOWNWASH_EXPORT InputError : public std::runtime_error {
 public:
    /// @pre there is at least one error
    explicit InputError(std::vector<KeyError> errors);
    [[nodiscard]] const std::vector<KeyError>& errors() const noexcept { return errors_; }

 private:
    std::vector<KeyError> errors_;
};

/// Throws an InputError of one error. @param key may be empty
[[noreturn]] DOWNWASH_EXPORT void throw_input_error(std::string message, std::string key = "");

/// @throws InputError if there are errors
DOWNWASH_EXPORT void throw_if_any(std::vector<KeyError> errors);

}  // namespace downwash
