#include "downwash/studies/ceiling_inspection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "downwash/controllers/lyapunov.hpp"
#include "downwash/dynamics/ceiling_tick.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash::studies {
namespace {

constexpr double inspection_tick_s = 0.01;
constexpr double degrees_per_rad = 180 / std::numbers::pi;

using Vector = dynamics::LaneVector<double>;
using controllers::LyapunovReference;

enum class Phase : std::uint8_t { travel, press, leave };

/// A straight line at constant speed and then a rest. The frame's place, of which z is its height below the ceiling.
struct Leg {
    Vector from_m, to_m;
    double moves_s, rests_s;
    Phase phase;
};

std::vector<Leg> legs_of(const CeilingInspection& mission) {
    std::vector<Leg> legs;
    Vector at{mission.points_m.front()[0], mission.points_m.front()[1], mission.travel_m};
    const auto add = [&](const Vector& to, double rests_s, Phase phase) {
        const Vector way = to - at;
        const double length_m = std::sqrt(dot(way, way));
        legs.push_back({at, to, length_m / mission.speed_m_s, rests_s, phase});
        at = to;
    };
    for (const auto& [x, y] : mission.points_m) {
        add({x, y, mission.travel_m}, mission.rest_s, Phase::travel);
        add({x, y, mission.press_m}, mission.contact_s, Phase::press);
        add({x, y, mission.travel_m}, mission.rest_s, Phase::leave);
    }
    return legs;
}

/// The reference of the frame `after_s` into a leg; it does not turn.
LyapunovReference<double> reference_on(const Leg& leg, double after_s) {
    if (after_s >= leg.moves_s) {
        return {{leg.to_m.x, 0, 0}, {leg.to_m.y, 0, 0}, {leg.to_m.z, 0, 0}, {0, 0, 0}};
    }
    const Vector velocity = (1 / leg.moves_s) * (leg.to_m - leg.from_m);
    const Vector at = leg.from_m + after_s * velocity;
    return {{at.x, velocity.x, 0}, {at.y, velocity.y, 0}, {at.z, velocity.z, 0}, {0, 0, 0}};
}

/// What a law sees: the state, or its position measured now and then with noise.
class Sensor {
 public:
    explicit Sensor(const CeilingInspection& mission)
        : per_sample_(std::max<std::int64_t>(1, std::lround(mission.sample_s / inspection_tick_s))),
          noise_m_(mission.position_noise_m) {}

    dynamics::SpaceState<double, 0> seen(const dynamics::SpaceState<double, 0>& state, std::int64_t tick) {
        if (tick % per_sample_ == 0) {
            double noise[simulation::noise_count];
            simulation::draw_noise(simulation::normal_levels(), 1, tick, noise, 1);
            for (int i = 0; i < 3; ++i) {
                position_m_[i] = state.q[i] + noise_m_ * noise[i];
            }
        }
        dynamics::SpaceState<double, 0> seen = state;
        std::copy(position_m_, position_m_ + 3, seen.q);
        return seen;
    }

 private:
    std::int64_t per_sample_;
    double noise_m_;
    double position_m_[3] = {};
};

void record(const dynamics::SpaceState<double, 0>& state, double frame_m, const LyapunovReference<double>& reference,
            const controllers::TiltDemand<double>& demand, CeilingInspectionFlight& flight) {
    const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(state.q + 3);
    const controllers::EulerAngles<double> angles = controllers::euler_angles(attitude);
    flight.x_m.push_back(state.q[0]);
    flight.y_m.push_back(state.q[1]);
    flight.height_m.push_back(state.q[2] + frame_m);
    flight.reference_x_m.push_back(reference.x.value);
    flight.reference_y_m.push_back(reference.y.value);
    flight.reference_height_m.push_back(reference.z.value);
    flight.roll_deg.push_back(angles.roll * degrees_per_rad);
    flight.pitch_deg.push_back(angles.pitch * degrees_per_rad);
    flight.yaw_deg.push_back(angles.yaw * degrees_per_rad);
    flight.demanded_roll_deg.push_back(demand.roll_rad * degrees_per_rad);
    flight.demanded_pitch_deg.push_back(demand.pitch_rad * degrees_per_rad);
    flight.max_tilt_deg =
        std::max(flight.max_tilt_deg, std::acos(std::clamp(attitude.third.z, -1.0, 1.0)) * degrees_per_rad);
}

/// The first of the ticks at which a height is at most `height_m`, or their end.
std::size_t first_below(const std::vector<double>& heights_m, std::size_t begin, std::size_t end, double height_m) {
    const auto at = [&](std::size_t tick) { return heights_m.begin() + static_cast<std::ptrdiff_t>(tick); };
    return static_cast<std::size_t>(std::find_if(at(begin), at(end), [&](double h) { return h <= height_m; }) -
                                    heights_m.begin());
}

/// What the ticks [begin, end) of a leg say of the mission.
void judge(const Leg& leg, std::size_t begin, std::size_t end, CeilingInspectionFlight& flight) {
    const std::size_t rest = begin + static_cast<std::size_t>(std::ceil(leg.moves_s / inspection_tick_s));
    for (std::size_t i = std::min(rest, end); i < end; ++i) {
        flight.max_aside_m =
            std::max(flight.max_aside_m, std::hypot(flight.x_m[i] - leg.to_m.x, flight.y_m[i] - leg.to_m.y));
    }
    if (leg.phase == Phase::press) {
        constexpr double touch_m = 1e-3;  // it trembles by less as it settles
        const auto from = flight.height_m.begin() + static_cast<std::ptrdiff_t>((rest + end) / 2);
        const auto to = flight.height_m.begin() + static_cast<std::ptrdiff_t>(end);
        flight.contacts_held += std::all_of(from, to, [](double height_m) { return height_m >= -touch_m; }) ? 1 : 0;
    }
    if (leg.phase == Phase::leave) {
        constexpr double below_m = -0.05;  // as in CeilingFlight::delay_s()
        const std::size_t left = first_below(flight.height_m, begin, end, below_m);
        const std::size_t asked = first_below(flight.reference_height_m, begin, end, below_m);
        flight.always_leaves = flight.always_leaves && left < end;
        flight.delay_s =
            std::max(flight.delay_s, (static_cast<double>(left) - static_cast<double>(asked)) * inspection_tick_s);
    }
}

}  // namespace

CeilingInspectionFlight fly(const CeilingInspection& mission) {
    const SpaceModel<0> model = make_space_model<0>(plant_of(mission.vehicle));
    const SpaceAllocation allocation = make_space_allocation(model);
    const dynamics::CeilingContact contact = frame_of(mission.vehicle);
    const UnderWideCeiling around(mission.vehicle);
    const double frame_m = mission.vehicle.rotor_height_m + mission.vehicle.guard_m;  // over the centre of mass
    const double weight_n = mission.vehicle.mass_kg * standard_gravity_m_s2;
    controllers::LyapunovLaw law;
    law.roll = law.pitch = {mission.attitude_gain_1_s, mission.attitude_gain_1_s};

    dynamics::SpaceState<double, 0> state{};
    state.q[0] = mission.points_m.front()[0];
    state.q[1] = mission.points_m.front()[1];
    state.q[2] = mission.travel_m - frame_m;
    state.q[3] = 1;
    std::fill(state.thrust_n, state.thrust_n + 4, weight_n / 4);
    Sensor sensor(mission);
    CeilingInspectionFlight flight;
    std::int64_t tick = 0;
    for (const Leg& leg : legs_of(mission)) {
        const auto ticks = static_cast<std::int64_t>(std::lround((leg.moves_s + leg.rests_s) / inspection_tick_s));
        const std::size_t begin = flight.time_s.size();
        for (std::int64_t i = 0; i < ticks; ++i, ++tick) {
            const LyapunovReference<double> frame = reference_on(leg, static_cast<double>(i) * inspection_tick_s);
            LyapunovReference<double> centre = frame;
            centre.z.value -= frame_m;
            const dynamics::SpaceState<double, 0> seen = sensor.seen(state, tick);
            const double k_c = mission.knows_ceiling
                                   ? ceiling_factor_at(mission.vehicle, -seen.q[2] - mission.vehicle.rotor_height_m)
                                   : 1.0;
            dynamics::SpaceCommand<double, 0> command{};
            const controllers::TiltDemand<double> demand =
                controllers::lyapunov_commands(model, allocation, law, seen, centre, k_c, command.thrust_n);
            for (int rotor = 0; rotor < model.rotor_count; ++rotor) {
                command.thrust_n[rotor] = std::clamp(command.thrust_n[rotor], 0.0, weight_n / 2);
            }
            flight.time_s.push_back(static_cast<double>(tick) * inspection_tick_s);
            flight.ceiling_factor.push_back(
                ceiling_factor_at(mission.vehicle, -(state.q[2] + mission.vehicle.rotor_height_m)));
            record(state, frame_m, frame, demand, flight);
            state = dynamics::contact_tick(model, contact, state, command, inspection_tick_s, around).state;
        }
        judge(leg, begin, flight.time_s.size(), flight);
    }
    flight.below_travel_m = mission.travel_m - *std::min_element(flight.height_m.begin(), flight.height_m.end());
    return flight;
}

}  // namespace downwash::studies
