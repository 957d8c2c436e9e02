#include "downwash/identification/gust_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "downwash/simulation/gusts.hpp"

namespace downwash::identification {
namespace {

using simulation::GustFilter;
using simulation::GustPairFilter;

constexpr int along = 0, left = 1, up = 3;  // where they begin in the state

void move_pair(const GustPairFilter& filter, const double before[2], double after[2]) {
    after[0] = filter.decay * before[0];
    after[1] = filter.decay * before[1] + filter.coupling * before[0];
}

Eigen::Matrix2d added_to_pair(const GustPairFilter& filter) {
    Eigen::Matrix2d root;
    root << filter.noise[0], 0, filter.noise[1], filter.noise[2];
    return root * root.transpose();
}

}  // namespace

GustModel::GustModel(const GustSettings& settings, const Eigen::Vector3d& steady_wind_m_s) {
    constexpr double least_speed_m_s = 1;
    const double speed_m_s = std::max(least_speed_m_s, steady_wind_m_s.norm());
    level_1_s_ = speed_m_s / settings.level_length_m;
    up_1_s_ = speed_m_s / settings.up_length_m;
    const Eigen::Vector3d level(steady_wind_m_s.x(), steady_wind_m_s.y(), 0);
    const Eigen::Vector3d ahead = level.norm() > 0 ? level.normalized() : Eigen::Vector3d::UnitX();
    const double first = simulation::gust_across(1.0, 0.0), second = simulation::gust_across(0.0, 1.0);
    to_gust_.col(along) = ahead;
    const Eigen::Vector3d to_left = Eigen::Vector3d::UnitZ().cross(ahead);
    to_gust_.col(left) = first * to_left;
    to_gust_.col(left + 1) = second * to_left;
    to_gust_.col(up) = first * Eigen::Vector3d::UnitZ();
    to_gust_.col(up + 1) = second * Eigen::Vector3d::UnitZ();
    to_gust_ *= settings.sd_m_s;
}

GustModel::State GustModel::after(const State& state, double time_s) const {
    State later;
    later[along] = simulation::gust_filter(time_s * level_1_s_).decay * state[along];
    move_pair(simulation::gust_pair_filter(time_s * level_1_s_), &state[left], &later[left]);
    move_pair(simulation::gust_pair_filter(time_s * up_1_s_), &state[up], &later[up]);
    return later;
}

GustModel::Matrix GustModel::covariance() {
    double columns[2][2];
    simulation::start_gust_pair(1, 0, columns[0]);
    simulation::start_gust_pair(0, 1, columns[1]);
    Eigen::Matrix2d root;
    root << columns[0][0], columns[1][0], columns[0][1], columns[1][1];
    Matrix all = Matrix::Zero();
    all(along, along) = 1;
    all.block<2, 2>(left, left) = all.block<2, 2>(up, up) = root * root.transpose();
    return all;
}

GustModel::Matrix GustModel::added(double time_s) const {
    Matrix all = Matrix::Zero();
    const double noise = simulation::gust_filter(time_s * level_1_s_).noise;
    all(along, along) = noise * noise;
    all.block<2, 2>(left, left) = added_to_pair(simulation::gust_pair_filter(time_s * level_1_s_));
    all.block<2, 2>(up, up) = added_to_pair(simulation::gust_pair_filter(time_s * up_1_s_));
    return all;
}

}  // namespace downwash::identification
