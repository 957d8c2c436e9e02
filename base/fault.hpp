#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// Something a user wrote that cannot be used: where it stands and what to do about it.
struct Fault {
    /// Key path within the problem, for example "start.x_m", "robot.rotors" or "environment.obstacles[2].box".
    std::string key;
    /// What is wrong, what was expected, and a remedy.
    std::string message;
};

/// Thrown at the edge of a module when input cannot be used; carries every fault that was found in one reading.
class DOWNWASH_EXPORT InputError : public std::runtime_error {
 public:
    /// @pre there is at least one fault
    explicit InputError(std::vector<Fault> faults);
    [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

 private:
    std::vector<Fault> faults_;
};

}  // namespace downwash
