#include "downwash/problems/located_error.hpp"

#include <utility>

namespace downwash {
namespace {

std::string joined(const std::vector<LocatedError>& errors) {
    std::string text;
    for (const LocatedError& error : errors) {
        text += (text.empty() ? "" : "\n") + to_text(error);
    }
    return text;
}

}  // namespace

std::string to_text(const LocatedError& error) {
    return error.file + ":" + std::to_string(error.line) + ":" + std::to_string(error.column) + ": " + error.message;
}

ProblemFileError::ProblemFileError(std::vector<LocatedError> errors)
    : std::runtime_error(joined(errors)), errors_(std::move(errors)) {}

}  // namespace downwash
