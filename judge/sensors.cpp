#include "downwash/judge/sensors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace downwash::judge {

bool has_noise(const World& world) noexcept {
    return world.position_noise_m > 0 || world.velocity_noise_m_s > 0 || world.gyro_noise_rad_s > 0 ||
           world.gust_m_s > 0;
}

Tape tape_at(const World& world, std::int64_t tick) {
    Tape tape{};
    if (has_noise(world)) {
        simulation::draw_noise(simulation::normal_levels(), world.tape, tick, tape.data(), 1);
    }
    return tape;
}

World without_noise(World world) noexcept {
    world.position_noise_m = world.velocity_noise_m_s = world.gyro_noise_rad_s = world.gust_m_s = 0;
    return world;
}

Sensors::Sensors(const World& world, const Robot& robot, const Motion& now)
    : world_(world),
      delay_ticks_((robot.controller.delay_s + world.delay_s) * robot.controller.rate_hz),
      past_(static_cast<std::size_t>(delay_ticks_) + 1, now) {}

Motion Sensors::seen(const Motion& now, const Tape& tape) const {
    const auto ago = [&](std::size_t ticks) -> const Motion& {
        return ticks == 0 ? now : past_[std::min(ticks, past_.size()) - 1];
    };
    const double whole = std::floor(delay_ticks_);
    const double share = delay_ticks_ - whole;
    const auto newer = static_cast<std::size_t>(whole);
    const Motion& a = ago(newer);
    const Motion& b = ago(newer + (share > 0 ? 1 : 0));
    const auto between = [&](double from, double to) { return from + share * (to - from); };
    const auto of = [&](Planar from, Planar to) { return Planar{between(from.x, to.x), between(from.z, to.z)}; };
    Motion seen{of(a.position_m, b.position_m),    of(a.velocity_m_s, b.velocity_m_s),
                between(a.pitch_rad, b.pitch_rad), between(a.pitch_rate_rad_s, b.pitch_rate_rad_s),
                between(a.arm_rad, b.arm_rad),     between(a.arm_rate_rad_s, b.arm_rate_rad_s)};
    seen.position_m = seen.position_m + Planar{world_.position_bias_x_m, world_.position_bias_z_m} +
                      world_.position_noise_m * Planar{tape[0], tape[1]};
    seen.velocity_m_s = seen.velocity_m_s + world_.velocity_noise_m_s * Planar{tape[2], tape[3]};
    seen.pitch_rad += world_.pitch_bias_rad;
    seen.pitch_rate_rad_s += world_.gyro_noise_rad_s * tape[4];
    return seen;
}

void Sensors::remember(const Motion& now) {
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    past_.front() = now;
}

Gusts::Gusts(const World& world, double tick_s) : world_(world) {
    if (!(world.gust_m_s > 0)) {
        return;
    }
    const double speed_m_s = std::max(1.0, std::hypot(world.wind_x_m_s, world.wind_z_m_s));
    x_decay_ = std::exp(-tick_s * speed_m_s / world.gust_length_x_m);
    x_noise_ = std::sqrt(1 - x_decay_ * x_decay_);
    // Two first-order filters in a row with the time constant Lz / V; `stationary` is the covariance of both when
    // root3 y1 + (1 - root3) y2 has unit variance and the spectrum of Dryden.
    const double h = tick_s * speed_m_s / world.gust_length_z_m;
    Eigen::Matrix2d step;
    step << 1, 0, h, 1;
    step *= std::exp(-h);
    Eigen::Matrix2d stationary;
    stationary << 0.5, 0.25, 0.25, 0.25;
    z_decay_ = step(0, 0);
    z_coupling_ = step(1, 0);
    const Eigen::Matrix2d added = stationary - step * stationary * step.transpose();
    const Eigen::Matrix2d factor = added.llt().matrixL();
    z_noise_ = {factor(0, 0), factor(1, 0), factor(1, 1)};
    // They blow already: the state is drawn from its stationary distribution, with the numbers before the first tick.
    const Tape tape = tape_at(world, -1);
    const Eigen::Matrix2d root = stationary.llt().matrixL();
    x_ = tape[0];
    z_first_ = root(0, 0) * tape[1];
    z_second_ = root(1, 0) * tape[1] + root(1, 1) * tape[2];
}

Planar Gusts::wind() const {
    const double root3 = std::sqrt(3.0);
    return Planar{world_.wind_x_m_s, world_.wind_z_m_s} +
           world_.gust_m_s * Planar{x_, root3 * z_first_ + (1 - root3) * z_second_};
}

void Gusts::next(const Tape& tape) {
    x_ = x_decay_ * x_ + x_noise_ * tape[5];
    z_second_ = z_decay_ * z_second_ + z_coupling_ * z_first_ + z_noise_[1] * tape[6] + z_noise_[2] * tape[7];
    z_first_ = z_decay_ * z_first_ + z_noise_[0] * tape[6];
}

}  // namespace downwash::judge
