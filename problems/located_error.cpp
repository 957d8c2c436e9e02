#include "downwash/problems/located_error.hpp"

#include <utility>

#include "downwash/base/text.hpp"

namespace downwash {
std::string to_text(const LocatedError& error) {
    return error.file + ":" + std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.message;
}

ProblemFileError::ProblemFileError(std::vector<LocatedError> errors)
    : std::runtime_error(joined(errors, "\n", [](const LocatedError& each) { return to_text(each); })),
      errors_(std::move(errors)) {}

}  // namespace downwash
