#include "downwash/judge/position_loop.hpp"

#include <cmath>
#include <variant>

namespace downwash::judge {
namespace {

/// Whether a steady force along x leaves no error in the end.
struct Integrates {
    bool operator()(const ModelInversion& law) const { return law.position_ki > 0 || law.aids.observer.has_value(); }
    bool operator()(const CascadedPid& law) const {
        return law.horizontal_velocity_ki > 0 || law.aids.observer.has_value();
    }
    bool operator()(const PlanarLyapunov& law) const { return law.aids.observer.has_value(); }
};

}  // namespace

double answer_1_s2(const ::downwash::ControlLaw& law, bool is_height) {
    if (const auto* inversion = std::get_if<ModelInversion>(&law)) {
        return is_height ? inversion->height_kp.value_or(inversion->position_kp) : inversion->position_kp;
    }
    if (const auto* lyapunov = std::get_if<PlanarLyapunov>(&law)) {
        return 1 + (is_height ? lyapunov->vertical_k * lyapunov->vertical_k_rate
                              : lyapunov->horizontal_k * lyapunov->horizontal_k_rate);
    }
    const auto& cascade = std::get<CascadedPid>(law);
    return is_height ? cascade.vertical_position_kp * cascade.vertical_velocity_kp
                     : cascade.horizontal_position_kp * cascade.horizontal_velocity_kp;
}

double lateral_m(const World& world, const Robot& robot) {
    const ::downwash::ControlLaw& law = robot.controller.law;
    double wind_m_s = world.gust_y_m_s;
    if (!std::visit(Integrates{}, law)) {
        wind_m_s += world.wind_y_m_s;
    }
    const DragParameters& body = robot.multirotor.drag;
    const DragParameters& arm = robot.arm.drag;
    const double drag_n_s_m =
        body.linear_n_s_m + arm.linear_n_s_m + (body.quadratic_n_s2_m2 + arm.quadratic_n_s2_m2) * std::abs(wind_m_s);
    // The vehicle stands where what its loop answers balances the drag.
    const double held_n_m = (robot.multirotor.mass_kg + robot.arm.mass_kg) * answer_1_s2(law, false);
    const double blown_m = wind_m_s == 0 ? 0 : drag_n_s_m * wind_m_s / held_n_m;
    const double believed_m = world.lateral_error_m + blown_m;
    return believed_m - world.position_bias_y_m - world.scene_y_m;
}

}  // namespace downwash::judge
