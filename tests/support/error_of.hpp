#pragma once

#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"

namespace downwash::test {

/// The errors in the input of an action; none if it accepts it.
template <class Action>
std::vector<KeyError> errors_of(const Action& action) {
    try {
        static_cast<void>(action());
    } catch (const InputError& error) {
        return error.errors();
    }
    return {};
}

/// The same as a user reads them, "none" for none.
template <class Action>
std::string error_of(const Action& action) {
    const std::vector<KeyError> errors = errors_of(action);
    return errors.empty() ? "none" : InputError(errors).what();
}

/// The same as their keys.
template <class Action>
std::vector<std::string> wrong_keys(const Action& action) {
    std::vector<std::string> keys;
    for (const KeyError& error : errors_of(action)) {
        keys.push_back(error.key);
    }
    return keys;
}

}  // namespace downwash::test
