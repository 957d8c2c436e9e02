#include "downwash/base/line_errors.hpp"

namespace downwash {

void LineErrors::add(std::size_t line, const std::string& message) {
    add_at(line > 0 ? ":" + std::to_string(line) : "", message);
}

void LineErrors::add(std::size_t line, std::size_t column, const std::string& message) {
    add_at(":" + std::to_string(line) + ":" + std::to_string(column), message);
}

void LineErrors::throw_any() const {
    throw_if_any(errors_);
}

void LineErrors::add_at(const std::string& place, const std::string& message) {
    constexpr std::size_t max_errors = 20;
    errors_.push_back({"", file_ + place + ": " + message});
    if (errors_.size() == max_errors) {
        throw_any();
    }
}

}  // namespace downwash
