#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// Something a user wrote that cannot be used: where it stands and what to do about it.
struct KeyError {
    /// Key path within the problem, for example "start.x_m", "robot.rotors" or "environment.obstacles[2].box".
    std::string key;
    /// What is wrong, what was expected, and a remedy.
    std::string message;
};

/// Thrown at the edge of a module when input cannot be used; carries every error that was found in one reading.
class DOWNWASH_EXPORT InputError : public std::runtime_error {
 public:
    /// @pre there is at least one error
    explicit InputError(std::vector<KeyError> errors);
    [[nodiscard]] const std::vector<KeyError>& errors() const noexcept { return errors_; }

 private:
    std::vector<KeyError> errors_;
};

}  // namespace downwash
