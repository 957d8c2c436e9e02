#include "downwash/studies/bench_flight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "downwash/dynamics/pitch_bench.hpp"
#include "downwash/dynamics/quadrotor.hpp"
#include "downwash/dynamics/space_allocation.hpp"
#include "downwash/effects/effect_curve.hpp"

namespace downwash::studies {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double tick_s = 0.01;
constexpr int front_rotor = 1;  // see make_quadrotor()

/// Only one of the rotors may have a plate below.
struct PlateUnderOne : dynamics::CalmSpace {
    PlateUnderOne(const EffectCurve& the_curve, double plate_at_m, double rotor_radius_m, bool is_plate_there)
        : curve(the_curve), plate_m(plate_at_m), radius_m(rotor_radius_m), is_there(is_plate_there) {}

    const EffectCurve& curve;
    double plate_m, radius_m;
    bool is_there;
    [[nodiscard]] double factor(int rotor, double z_m) const {
        return is_there && rotor == front_rotor ? curve(std::max(0.0, z_m - plate_m) / radius_m) : 1.0;
    }
    [[nodiscard]] double thrust_ratio(int rotor, const dynamics::LaneVector<double>& hub_m,
                                      const dynamics::LaneVector<double>& /*axis*/) const {
        return factor(rotor, hub_m.z);
    }
};

}  // namespace

double BenchFlight::pitch_at(double at_s) const {
    return pitch_deg[static_cast<std::size_t>(std::lround(at_s / tick_s))];
}

double BenchFlight::peak_deg(double from_s, double to_s) const {
    double peak = 0;
    for (std::size_t i = 0; i < time_s.size(); ++i) {
        if (time_s[i] >= from_s && time_s[i] < to_s) {
            peak = std::max(peak, std::abs(pitch_deg[i]));
        }
    }
    return peak;
}

BenchFlight fly(const BenchExperiment& e) {
    QuadrotorParameters quadrotor;
    quadrotor.mass_kg = e.vehicle.mass_kg;
    quadrotor.inertia_kg_m2 = {e.vehicle.pitch_inertia_kg_m2, e.vehicle.pitch_inertia_kg_m2, 0.035};
    quadrotor.arm_m = e.vehicle.arm_m;
    quadrotor.drag_torque_m = 0.016;
    quadrotor.layout = QuadrotorLayout::plus;
    const SpaceModel<0> model = make_space_model<0>(make_quadrotor(quadrotor));
    const SpaceAllocation allocation = make_space_allocation(model);
    const EffectCurve curve(e.ground, 2);
    dynamics::PitchBench bench{};
    bench.friction_nm_s_rad = e.friction_nm_s_rad;
    const double weight_n = e.vehicle.mass_kg * standard_gravity_m_s2;

    dynamics::PitchBenchState<double> state{};
    std::fill(state.thrust_n, state.thrust_n + 4, weight_n / 4);
    BenchFlight flight;
    double integral_rad = 0;
    double disturbance_nm = 0;     // as the observer has it
    double expected_momentum = 0;  // of the observer [N m s]
    const auto ticks = static_cast<std::int64_t>(std::lround(e.end_s / tick_s));
    for (std::int64_t tick = 0; tick <= ticks; ++tick) {
        const double time_s = static_cast<double>(tick) * tick_s;
        flight.time_s.push_back(time_s);
        flight.pitch_deg.push_back(state.pitch_rad / degree);
        const PlateUnderOne plate(curve, -e.z_over_r * e.vehicle.radius_m, e.vehicle.radius_m,
                                  time_s >= e.plate_from_s && time_s < e.plate_to_s);
        // Momentum form of thesis (3.9): the estimate follows what the momentum has beyond the torques given.
        const double momentum = e.vehicle.pitch_inertia_kg_m2 * state.pitch_rate_rad_s;
        if (e.aid == BenchAid::observer) {
            disturbance_nm = e.observer_gain_1_s * (momentum - expected_momentum);
        }
        const double rate_error = -e.control.pitch_kp * state.pitch_rad - state.pitch_rate_rad_s;
        const double wanted_nm =
            e.vehicle.pitch_inertia_kg_m2 * (e.control.rate_kp * rate_error + e.rate_ki * integral_rad) -
            disturbance_nm;
        integral_rad += rate_error * tick_s;
        expected_momentum += (wanted_nm + disturbance_nm) * tick_s;
        const double demand[4] = {weight_n, 0, wanted_nm, 0};
        double thrust_n[max_rotors];
        dynamics::allocate(allocation, demand, thrust_n);
        for (int i = 0; i < 4; ++i) {
            if (e.aid == BenchAid::feed_forward) {
                const double rise_m = i == front_rotor ? -e.vehicle.arm_m * std::sin(state.pitch_rad) : 0;
                thrust_n[i] /= plate.factor(i, rise_m);
            }
            thrust_n[i] = std::clamp(thrust_n[i], 0.0, weight_n / 2);
        }
        state = dynamics::pitch_bench_step(model, bench, state, thrust_n, tick_s, plate);
    }
    return flight;
}

}  // namespace downwash::studies
