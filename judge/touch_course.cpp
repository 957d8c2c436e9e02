#include "downwash/judge/touch_course.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace downwash::judge {
namespace {

// docs/model.md 7.5.
constexpr double settling_constants = 5;
constexpr double hover_s = 8;
constexpr double overshoot_m = 0.5;
constexpr double free_s = 0.1;
constexpr double pull_m = 2;
constexpr double force_loop_share = 0.4;

}  // namespace

TouchCourse::TouchCourse(const TouchDemand& touch, double mass_kg, double answer_1_s2, double tick_s)
    : touch_(touch), tick_s_(tick_s) {
    const double rate_1_s = force_loop_share * std::sqrt(answer_1_s2);
    metres_per_newton_ = rate_1_s / (mass_kg * answer_1_s2) * tick_s_;
    settling_s_ = settling_constants / rate_1_s;
}

double TouchCourse::speed_m_s() const {
    return stage_ == Stage::coming    ? touch_.speed_m_s
           : stage_ == Stage::pulling ? -touch_.speed_m_s
           : stage_ == Stage::going   ? beyond_m_ > 0 ? -touch_.speed_m_s : touch_.speed_m_s
                                      : 0.0;
}

double TouchCourse::pressed_m() const {
    return met_m_ ? std::max(0.0, beyond_m_ - *met_m_) : 0;
}

void TouchCourse::enter(Stage stage) {
    stage_ = stage;
    since_ = 0;
}

void TouchCourse::next(double force_n) {
    ++since_;
    const double way_m = touch_.speed_m_s * tick_s_;
    const auto lasts = [&](double duration_s) { return static_cast<double>(since_) * tick_s_ < duration_s - 1e-9; };
    if (stage_ == Stage::holding) {
        held_n_.push_back(force_n);
    }
    switch (stage_) {
        case Stage::coming:
            if (force_n > 0) {
                met_m_ = beyond_m_;
                enter(Stage::settling);
            } else if (beyond_m_ > touch_.standoff_m + overshoot_m) {
                enter(Stage::pulling);
            } else {
                beyond_m_ += way_m;
            }
            break;
        case Stage::settling:
        case Stage::holding:
            beyond_m_ += std::clamp(metres_per_newton_ * (touch_.force_n - force_n), -way_m, way_m);
            if (!lasts(stage_ == Stage::settling ? settling_s_ : touch_.hold_s)) {
                enter(stage_ == Stage::settling ? Stage::holding : Stage::pulling);
            }
            break;
        case Stage::pulling:
            beyond_m_ -= way_m;
            free_ = force_n > 0 ? 0 : free_ + 1;
            if (static_cast<double>(free_) * tick_s_ >= free_s) {
                enter(Stage::going);
            } else if (beyond_m_ < -pull_m) {
                enter(Stage::over);
            }
            break;
        case Stage::going:
            beyond_m_ -= std::clamp(beyond_m_, -way_m, way_m);
            if (beyond_m_ == 0) {
                enter(Stage::hovering);
            }
            break;
        case Stage::hovering:
            if (!lasts(hover_s)) {
                enter(Stage::over);
            }
            break;
        case Stage::over:
            break;
    }
}

std::optional<TouchCourse::Hold> TouchCourse::hold() const {
    const auto second = static_cast<std::size_t>(std::llround(1 / tick_s_));
    if (held_n_.size() < second) {
        return std::nullopt;
    }
    Hold hold{std::accumulate(held_n_.begin(), held_n_.end(), 0.0) / static_cast<double>(held_n_.size()), 0};
    for (auto first = held_n_.begin(); held_n_.end() - first >= static_cast<std::ptrdiff_t>(second); ++first) {
        const double mean_n =
            std::accumulate(first, first + static_cast<std::ptrdiff_t>(second), 0.0) / static_cast<double>(second);
        hold.worst_second_n = std::max(hold.worst_second_n, std::abs(mean_n - touch_.force_n));
    }
    return hold;
}

}  // namespace downwash::judge
