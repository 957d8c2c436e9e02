#include "downwash/simulation/touch_course.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace downwash::simulation {

TouchCourse::TouchCourse(const TouchDemand& touch, double mass_kg, double stiffness_1_s2, double tick_s)
    : touch_(touch), tick_s_(tick_s) {
    const double rate_1_s = force_loop_share * std::sqrt(stiffness_1_s2);
    gain_m_n_s_ = rate_1_s / (mass_kg * stiffness_1_s2);
    settling_s_ = touch_settling_constants / rate_1_s;
}

double TouchCourse::along_m_s() const noexcept {
    switch (phase_) {
        case Phase::approach:
            return touch_.speed_m_s;
        case Phase::leave:
            return -touch_.speed_m_s;
        case Phase::go_back:
            return std::copysign(touch_.speed_m_s, -ahead_m_);
        default:
            return 0;
    }
}

void TouchCourse::next(double force_n) {
    const double step_m = touch_.speed_m_s * tick_s_;
    ++ticks_;
    switch (phase_) {
        case Phase::approach:
            if (force_n > 0) {
                contact_m_ = ahead_m_;
                go_to(Phase::settle);
            } else if (ahead_m_ > touch_.standoff_m + touch_overshoot_m) {
                go_to(Phase::leave);
            } else {
                ahead_m_ += step_m;
            }
            break;
        case Phase::settle:
        case Phase::hold:
            ahead_m_ += std::clamp(gain_m_n_s_ * (touch_.force_n - force_n) * tick_s_, -step_m, step_m);
            if (phase_ == Phase::settle && seconds() >= settling_s_) {
                go_to(Phase::hold);
            } else if (phase_ == Phase::hold && seconds() >= touch_.hold_s) {
                go_to(Phase::leave);
            }
            break;
        case Phase::leave:  // as far as it takes: suction holds the vehicle to a ceiling
            ahead_m_ -= step_m;
            free_ticks_ = force_n > 0 ? 0 : free_ticks_ + 1;
            if (static_cast<double>(free_ticks_) * tick_s_ >= touch_free_s) {
                go_to(Phase::go_back);
            } else if (ahead_m_ < -touch_pull_m) {
                is_over_ = true;
            }
            break;
        case Phase::go_back:
            ahead_m_ = std::abs(ahead_m_) > step_m ? ahead_m_ - std::copysign(step_m, ahead_m_) : 0;
            if (ahead_m_ == 0) {
                go_to(Phase::wait);
            }
            break;
        case Phase::wait:
            is_over_ = seconds() >= touch_leaving_s;
            break;
    }
}

void TouchForce::saw(double impulse_n_s, double depth_m, double end_s, double energy_j, bool is_holding) {
    const double force_n = impulse_n_s / tick_s_;
    if (force_n > 0) {
        record_.touched_s = record_.touched_s > 0 ? record_.touched_s : end_s;
        record_.left_s = end_s;
    }
    record_.peak_force_n = std::max(record_.peak_force_n, force_n);
    record_.max_depth_m = std::max(record_.max_depth_m, depth_m);
    last_depth_m_ = depth_m;
    if (is_holding) {
        forces_n_.push_back(force_n);
        energy_j_ += energy_j;
    }
}

TouchRecord TouchForce::record(bool is_at_end) const {
    TouchRecord record = record_;
    const auto second = static_cast<std::size_t>(std::llround(1 / tick_s_));
    record.force_error_n = touch_.force_n;
    if (forces_n_.size() >= second) {
        double sum_n = 0;
        double in_second_n = 0;
        record.force_error_n = 0;
        for (std::size_t i = 0; i < forces_n_.size(); ++i) {
            sum_n += forces_n_[i];
            in_second_n += forces_n_[i] - (i >= second ? forces_n_[i - second] : 0);
            if (i + 1 >= second) {
                const double mean_n = in_second_n / static_cast<double>(second);
                record.force_error_n = std::max(record.force_error_n, std::abs(mean_n - touch_.force_n));
            }
        }
        record.force_n = sum_n / static_cast<double>(forces_n_.size());
        record.power_w = energy_j_ / (static_cast<double>(forces_n_.size()) * tick_s_);
    }
    record.is_met = is_at_end && record.force_error_n <= touch_.force_tolerance_n && last_depth_m_ < 0;
    return record;
}

}  // namespace downwash::simulation
