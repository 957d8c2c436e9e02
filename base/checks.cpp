#include "downwash/base/checks.hpp"

#include <algorithm>

namespace downwash {
namespace {

/// Whether `inner` is `outer` or a key within it.
bool is_within(std::string_view inner, std::string_view outer) {
    return outer.empty() || (inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '.' ||
                                                          inner[outer.size()] == '['));
}

}  // namespace

void WrongKeys::add(const std::vector<KeyError>& errors) {
    for (const KeyError& error : errors) {
        keys_.push_back(error.key);
    }
}

bool WrongKeys::touch(std::string_view key) const {
    return std::any_of(keys_.begin(), keys_.end(),
                       [&](const std::string& wrong) { return is_within(key, wrong) || is_within(wrong, key); });
}

}  // namespace downwash
