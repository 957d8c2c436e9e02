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

void FaultyKeys::add(const std::vector<Fault>& faults) {
    for (const Fault& fault : faults) {
        keys_.push_back(fault.key);
    }
}

bool FaultyKeys::touch(std::string_view key) const {
    return std::any_of(keys_.begin(), keys_.end(),
                       [&](const std::string& faulty) { return is_within(key, faulty) || is_within(faulty, key); });
}

}  // namespace downwash
