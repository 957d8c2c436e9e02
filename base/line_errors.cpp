#include "downwash/base/line_errors.hpp"

namespace downwash {

void LineErrors::add(std::size_t line, const std::string& message) {
    add_at(line > 0 ? ":" + std::to_string(line) : "", message);
}

void LineErrors::add(std::size_t line, std::size_t column, const std::string& message) {
    add_at(":" + std::to_string(line) + ":" + std::to_string(column), message);
}

void LineErrors::throw_any() const {
    std::vector<KeyError> errors = errors_;
    if (more_ > 0) {
        errors.push_back(
            {"", file_ + ": and " + std::to_string(more_) + (more_ == 1 ? " more error" : " more errors")});
    }
    throw_if_any(std::move(errors));
}

void LineErrors::add_at(const std::string& place, const std::string& message) {
    constexpr std::size_t max_errors = 20;
    if (errors_.size() == max_errors) {
        ++more_;
        return;
    }
    errors_.push_back({"", file_ + place + ": " + message});
}

}  // namespace downwash
