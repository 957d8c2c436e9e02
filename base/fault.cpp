#include "downwash/base/fault.hpp"

#include <utility>

namespace downwash {
namespace {

std::string joined(const std::vector<Fault>& faults) {
    std::string text;
    for (const Fault& fault : faults) {
        if (!text.empty()) {
            text += '\n';
        }
        text += fault.key.empty() ? fault.message : fault.key + ": " + fault.message;
    }
    return text;
}

}  // namespace

InputError::InputError(std::vector<Fault> faults) : std::runtime_error(joined(faults)), faults_(std::move(faults)) {}

}  // namespace downwash
