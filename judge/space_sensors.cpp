#include "downwash/judge/space_sensors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/judge/placement.hpp"

namespace downwash::judge {
namespace {

using Eigen::Vector3d;

bool has_noise(const SpaceWorld& world) {
    return world.position_noise_m > 0 || world.velocity_noise_m_s > 0 || world.gyro_noise_rad_s > 0 ||
           world.gust_m_s > 0;
}

}  // namespace

SpaceTape tape_at(const SpaceWorld& world, std::int64_t tick) {
    SpaceTape tape{};
    if (has_noise(world)) {
        simulation::draw_space_noise(simulation::normal_levels(), world.tape, tick, tape.data(), 1);
    }
    return tape;
}

SpaceWorld without_noise(SpaceWorld world) noexcept {
    world.position_noise_m = world.velocity_noise_m_s = world.gyro_noise_rad_s = world.gust_m_s = 0;
    return world;
}

SpaceSensors::SpaceSensors(const SpaceWorld& world, const SpaceRobot& robot, const SpaceCoordinates& now)
    : world_(world),
      delay_ticks_((robot.controller.delay_s + world.delay_s) * robot.controller.rate_hz),
      past_(static_cast<std::size_t>(delay_ticks_) + 1, now) {}

SpaceCoordinates SpaceSensors::seen(const SpaceCoordinates& now, const SpaceTape& tape) const {
    const auto ago = [&](std::size_t ticks) -> const SpaceCoordinates& {
        return ticks == 0 ? now : past_[std::min(ticks, past_.size()) - 1];
    };
    const double whole = std::floor(delay_ticks_);
    const double share = delay_ticks_ - whole;
    const SpaceCoordinates& a = ago(static_cast<std::size_t>(whole));
    const SpaceCoordinates& b = ago(static_cast<std::size_t>(whole) + (share > 0 ? 1 : 0));
    const auto mixed = [&](const auto& from, const auto& to) { return ((1 - share) * from + share * to).eval(); };
    SpaceCoordinates seen;
    seen.position_m = mixed(a.position_m, b.position_m);
    const double side = a.attitude.coeffs().dot(b.attitude.coeffs()) < 0 ? -1 : 1;  // of one turn, two quaternions
    seen.attitude.coeffs() = mixed(a.attitude.coeffs(), (side * b.attitude.coeffs()).eval());
    seen.velocity_m_s = mixed(a.velocity_m_s, b.velocity_m_s);
    seen.body_rate_rad_s = mixed(a.body_rate_rad_s, b.body_rate_rad_s);
    seen.joints_rad = mixed(a.joints_rad, b.joints_rad);
    seen.joint_rates_rad_s = mixed(a.joint_rates_rad_s, b.joint_rates_rad_s);

    seen.position_m +=
        vector_of(world_.position_bias_m) + world_.position_noise_m * Vector3d(tape[0], tape[1], tape[2]);
    seen.velocity_m_s += world_.velocity_noise_m_s * Vector3d(tape[3], tape[4], tape[5]);
    seen.body_rate_rad_s += world_.gyro_noise_rad_s * Vector3d(tape[6], tape[7], tape[8]);
    const Vector3d bias = vector_of(world_.attitude_bias_rad);
    if (bias.norm() > 0) {
        seen.attitude = seen.attitude.normalized() * Eigen::AngleAxisd(bias.norm(), bias.normalized());
    }
    for (Eigen::Index i = 0; i < seen.joints_rad.size(); ++i) {
        seen.joints_rad[i] += world_.joint_offset_rad[i];
    }
    return seen;
}

void SpaceSensors::remember(const SpaceCoordinates& now) {
    past_.pop_back();
    past_.push_front(now);
}

void SpaceGusts::Across::start(double passed, const Eigen::Vector2d& first) {
    // The covariance of both filters when root3 y1 + (1 - root3) y2 has unit variance and the spectrum of Dryden.
    Eigen::Matrix2d stationary;
    stationary << 0.5, 0.25, 0.25, 0.25;
    step << 1, 0, passed, 1;
    step *= std::exp(-passed);
    const Eigen::Matrix2d added = stationary - step * stationary * step.transpose();
    noise = added.llt().matrixL();
    const Eigen::Matrix2d root = stationary.llt().matrixL();
    state = root * first;
}

double SpaceGusts::Across::gust() const {
    const double root3 = std::sqrt(3.0);
    return root3 * state[0] + (1 - root3) * state[1];
}

SpaceGusts::SpaceGusts(const SpaceWorld& world, double tick_s) : world_(world) {
    Vector3d level = vector_of(world.wind_m_s);
    level.z() = 0;
    ahead_ = level.norm() > 0 ? level.normalized() : Vector3d::UnitX();
    left_ = Vector3d::UnitZ().cross(ahead_);
    if (!(world.gust_m_s > 0)) {
        return;
    }
    const double passed_m = tick_s * std::max(1.0, vector_of(world.wind_m_s).norm());
    decay_ = std::exp(-passed_m / world.gust_length_level_m);
    noise_ = std::sqrt(1 - decay_ * decay_);
    const SpaceTape tape = tape_at(world, -1);
    along_ = tape[0];
    to_left_.start(passed_m / world.gust_length_level_m, {tape[1], tape[2]});
    upward_.start(passed_m / world.gust_length_up_m, {tape[3], tape[4]});
}

Vector3d SpaceGusts::wind() const {
    return vector_of(world_.wind_m_s) +
           world_.gust_m_s * (along_ * ahead_ + to_left_.gust() * left_ + upward_.gust() * Vector3d::UnitZ());
}

void SpaceGusts::next(const SpaceTape& tape) {
    along_ = decay_ * along_ + noise_ * tape[9];
    to_left_.state = to_left_.step * to_left_.state + to_left_.noise * Eigen::Vector2d(tape[10], tape[11]);
    upward_.state = upward_.step * upward_.state + upward_.noise * Eigen::Vector2d(tape[12], tape[13]);
}

}  // namespace downwash::judge
