#include "downwash/base/key_error.hpp"

#include <utility>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

std::string text_of(const KeyError& error) {
    return error.key.empty() ? error.message : error.key + ": " + error.message;
}

}  // namespace

InputError::InputError(std::vector<KeyError> errors)
    : std::runtime_error(joined(errors, "\n", text_of)), errors_(std::move(errors)) {}

void throw_input_error(std::string message, std::string key) {
    throw InputError(std::vector<KeyError>{{std::move(key), std::move(message)}});
}

void throw_if_any(std::vector<KeyError> errors) {
    if (!errors.empty()) {
        throw InputError(std::move(errors));
    }
}

}  // namespace downwash
