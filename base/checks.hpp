#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/fault.hpp"

namespace downwash {

/// Keys whose values cannot be trusted, and with them everything above and below them.
class DOWNWASH_EXPORT FaultyKeys {
 public:
    /// Marks one key.
    void add(std::string key) { keys_.push_back(std::move(key)); }
    /// Marks the key of every fault.
    void add(const std::vector<Fault>& faults);

    /// Whether a faulty key is this one, stands below it, or above it. An index in a key path starts a new level.
    [[nodiscard]] bool touch(std::string_view key) const;

 private:
    std::vector<std::string> keys_;
};

/// Puts faults behind those that are known.
inline void append(std::vector<Fault>& faults, const std::vector<Fault>& more) {
    faults.insert(faults.end(), more.begin(), more.end());
}

/// A rule over several values of a Model.
template <class Model>
struct Check {
    std::vector<std::string_view> needs;  ///< key paths; the check makes no sense when one of them is faulty
    std::vector<Fault> (*find)(const Model&);
};

/// Runs every check whose needs are sound; what one finds is faulty for those after it.
/// @param prefix of the model's keys within a larger whole, for example "robot."
template <class Model>
std::vector<Fault> run_checks(std::span<const Check<Model>> checks, const Model& model, std::string_view prefix,
                              FaultyKeys& faulty) {
    std::vector<Fault> all;
    for (const Check<Model>& check : checks) {
        bool is_possible = true;
        for (const std::string_view need : check.needs) {
            is_possible = is_possible && !faulty.touch(std::string(prefix) + std::string(need));
        }
        if (!is_possible) {
            continue;
        }
        std::vector<Fault> found = check.find(model);
        for (Fault& fault : found) {
            fault.key.insert(0, prefix);
        }
        faulty.add(found);
        append(all, found);
    }
    return all;
}

}  // namespace downwash
