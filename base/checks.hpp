#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/key_error.hpp"

namespace downwash {

/// Keys whose values cannot be trusted, and with them everything above and below them.
class DOWNWASH_EXPORT WrongKeys {
 public:
    /// Marks one key.
    void add(std::string key) { keys_.push_back(std::move(key)); }
    /// Marks the key of every error.
    void add(const std::vector<KeyError>& errors);

    /// Whether a wrong key is this one, stands below it, or above it. An index in a key path starts a new level.
    [[nodiscard]] bool touch(std::string_view key) const;

 private:
    std::vector<std::string> keys_;
};

/// Puts errors behind those that are known.
inline void append(std::vector<KeyError>& errors, const std::vector<KeyError>& more) {
    errors.insert(errors.end(), more.begin(), more.end());
}

/// A rule over several values of a Model.
template <class Model>
struct Check {
    std::vector<std::string_view> needs;  ///< key paths; the check makes no sense when one of them is wrong
    std::function<std::vector<KeyError>(const Model&)> find;
};

/// Runs every check whose needs are sound; what one finds is wrong for those after it.
/// @param prefix of the model's keys within a larger whole, for example "robot."
template <class Model>
std::vector<KeyError> run_checks(std::span<const Check<Model>> checks, const Model& model, std::string_view prefix,
                                 WrongKeys& wrong) {
    std::vector<KeyError> all;
    for (const Check<Model>& check : checks) {
        bool is_possible = true;
        for (const std::string_view need : check.needs) {
            is_possible = is_possible && !wrong.touch(std::string(prefix) + std::string(need));
        }
        if (!is_possible) {
            continue;
        }
        std::vector<KeyError> found = check.find(model);
        for (KeyError& error : found) {
            error.key.insert(0, prefix);
        }
        wrong.add(found);
        append(all, found);
    }
    return all;
}

}  // namespace downwash
