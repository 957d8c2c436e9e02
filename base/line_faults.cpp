#include "downwash/base/line_faults.hpp"

namespace downwash {

void LineFaults::add(std::size_t line, const std::string& message) {
    add_at(line > 0 ? ":" + std::to_string(line) : "", message);
}

void LineFaults::add(std::size_t line, std::size_t column, const std::string& message) {
    add_at(":" + std::to_string(line) + ":" + std::to_string(column), message);
}

void LineFaults::throw_any() const {
    if (!faults_.empty()) {
        throw InputError(faults_);
    }
}

void LineFaults::add_at(const std::string& place, const std::string& message) {
    constexpr std::size_t most_faults = 20;
    faults_.push_back({"", file_ + place + ": " + message});
    if (faults_.size() == most_faults) {
        throw_any();
    }
}

}  // namespace downwash
