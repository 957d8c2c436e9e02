#include "downwash/base/key_error.hpp"

#include <utility>

namespace downwash {
namespace {

std::string joined(const std::vector<KeyError>& errors) {
    std::string text;
    for (const KeyError& error : errors) {
        if (!text.empty()) {
            text += '\n';
        }
        text += error.key.empty() ? error.message : error.key + ": " + error.message;
    }
    return text;
}

}  // namespace

InputError::InputError(std::vector<KeyError> errors) : std::runtime_error(joined(errors)), errors_(std::move(errors)) {}

void throw_input_error(std::string message, std::string key) {
    throw InputError(std::vector<KeyError>{{std::move(key), std::move(message)}});
}

void throw_if_any(std::vector<KeyError> errors) {
    if (!errors.empty()) {
        throw InputError(std::move(errors));
    }
}

}  // namespace downwash
