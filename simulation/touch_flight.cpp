#include "downwash/simulation/touch_flight.hpp"

#include <cmath>
#include <vector>

#include "downwash/controllers/control.hpp"
#include "downwash/simulation/flight_loop.hpp"

namespace downwash::simulation {
namespace {

/// Where the reference of a touch is: in front of the surface, against it, or on the way back.
class TouchReference {
 public:
    /// @param base reference from which the robot touches, at rest
    TouchReference(const FlightModel& model, const Touch& touch, const ReferencePoint& base)
        : touch_(touch), base_(base), tick_s_(model.tick().tick_s) {
        const double stiffness_1_s2 = std::visit(
            [axis = touch.normal.x == 0 ? 1 : 0](const auto& law) { return law.position_stiffness_1_s2(axis); },
            model.tick().law);
        const double rate_1_s = force_loop_share * std::sqrt(stiffness_1_s2);
        gain_m_n_s_ = rate_1_s / (model.tick().plant.total_mass_kg * stiffness_1_s2);
        settling_s_ = touch_settling_constants / rate_1_s;
    }

    [[nodiscard]] ReferencePoint point() const noexcept {
        ReferencePoint point = base_;
        const double along_m_s = phase_ == Phase::approach  ? touch_.speed_m_s
                                 : phase_ == Phase::leave   ? -touch_.speed_m_s
                                 : phase_ == Phase::go_back ? std::copysign(touch_.speed_m_s, -ahead_m_)
                                                            : 0;
        point.position[0] -= ahead_m_ * touch_.normal.x;
        point.position[1] -= ahead_m_ * touch_.normal.z;
        point.velocity[0] = -along_m_s * touch_.normal.x;
        point.velocity[1] = -along_m_s * touch_.normal.z;
        return point;
    }
    /// Goes on by a tick. @param force_n mean normal force over it
    void next(double force_n) {
        const double step_m = touch_.speed_m_s * tick_s_;
        ++ticks_;
        switch (phase_) {
            case Phase::approach:
                if (force_n > 0) {
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
    /// Whether the tick that follows belongs to the hold of the force.
    [[nodiscard]] bool is_holding() const noexcept { return phase_ == Phase::hold; }
    /// Whether it is between the first contact and the last: in between the vehicle may bounce.
    [[nodiscard]] bool is_at_surface() const noexcept {
        return phase_ == Phase::settle || phase_ == Phase::hold || phase_ == Phase::leave;
    }
    [[nodiscard]] bool is_over() const noexcept { return is_over_; }

 private:
    enum class Phase { approach, settle, hold, leave, go_back, wait };

    void go_to(Phase phase) {
        phase_ = phase;
        ticks_ = 0;
    }
    /// In this phase.
    [[nodiscard]] double seconds() const noexcept { return static_cast<double>(ticks_) * tick_s_ + 1e-9; }

    const Touch& touch_;
    ReferencePoint base_;
    double tick_s_;
    double gain_m_n_s_ = 0;  ///< how fast the reference goes on for a newton [m / (N s)]
    double settling_s_ = 0;
    Phase phase_ = Phase::approach;
    double ahead_m_ = 0;
    std::int64_t ticks_ = 0;
    std::int64_t free_ticks_ = 0;  ///< without contact
    bool is_over_ = false;
};

/// What a touch has come to, tick by tick.
class TouchObserver {
 public:
    TouchObserver(const Touch& touch, double tick_s) : touch_(touch), tick_s_(tick_s) {}

    /// @param end_s of the tick, from the start of the flight   @param energy_j spent in the tick
    void saw(const dynamics::ContactTickRecord& tick, double end_s, double energy_j, bool is_holding) {
        const double force_n = tick.normal_impulse_n_s / tick_s_;
        if (force_n > 0) {
            record_.touched_s = record_.touched_s > 0 ? record_.touched_s : end_s;
            record_.left_s = end_s;
        }
        record_.peak_force_n = std::max(record_.peak_force_n, force_n);
        record_.max_depth_m = std::max(record_.max_depth_m, tick.depth_m);
        last_depth_m_ = tick.depth_m;
        if (is_holding) {
            forces_n_.push_back(force_n);
            energy_j_ += energy_j;
        }
    }
    /// @param is_at_end nothing ended the flight before
    [[nodiscard]] TouchRecord record(bool is_at_end) const {
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

 private:
    const Touch& touch_;
    double tick_s_;
    TouchRecord record_;
    std::vector<double> forces_n_;
    double energy_j_ = 0;
    double last_depth_m_ = 0;
};

/// Lets integrals and an observer stand still over a tick: a surface that pushes is not what they are there for.
/// @param[in,out] next state after the tick
void stand_still(const TickModel& model, const FlightState& before, FlightState& next) {
    controllers::visit_flown(model.law, [&]<class Law>(const Law& law) {
        const auto kept = controllers::recalled<Law>(before.memory);
        auto memory = Law::with_integrals_of(kept, controllers::recalled<Law>(next.memory));
        if constexpr (controllers::is_aided<Law>) {
            const auto momentum_of = [&](const dynamics::PlantState<double>& plant, double p[4]) {
                dynamics::momentum(model.plant, dynamics::motion_at(model.plant, plant.q, plant.u).equations, plant.u,
                                   p);
            };
            double p[4];
            double change[4];
            momentum_of(before.plant, p);
            momentum_of(next.plant, change);
            for (int i = 0; i < 4; ++i) {
                change[i] -= p[i];
            }
            law.hold_estimate(kept, change, model.tick_s, memory);
        }
        controllers::remember(memory, next.memory);
    });
}

}  // namespace

Rejection fly_touch_ticks(const FlightModel& model, const FlownWorld* world, std::int64_t first_tick,
                          const Touch& touch, const ReferencePoint& base, FlightEffect& effect, FlightState& state,
                          TouchRecord& record, const AfterTouchTick& after) {
    const TickModel& tick_model = model.tick();
    dynamics::PlanarContact contact;
    contact.surface_m = {touch.surface_m.x, touch.surface_m.z};
    contact.normal = {touch.normal.x, touch.normal.z};
    contact.is_end_effector = touch.frame_points_m.empty();
    for (const PlaneVector& point : touch.frame_points_m) {
        contact.point_m[contact.point_count++] = {point.x, point.z};
    }
    dynamics::ContactTickRecord seen;
    dynamics::PlanePoint<double> center_of_mass_m{0, 0};
    if (world != nullptr) {
        contact.surface_m.x += world->numbers.scene_x_m;
        contact.surface_m.z += world->numbers.scene_z_m;
        center_of_mass_m = {world->numbers.center_of_mass_x_m, world->numbers.center_of_mass_z_m};
    }
    const dynamics::ContactStep step{contact, center_of_mass_m, seen};
    TouchReference reference(model, touch, base);
    TouchObserver observer(touch, tick_model.tick_s);
    Rejection rejection = Rejection::none;
    const FlightLoop loop(tick_model, world, effect);
    for (std::int64_t t = 0; !reference.is_over() && rejection == Rejection::none; ++t) {
        const ReferencePoint now = reference.point();
        const bool is_holding = reference.is_holding();
        controllers::Actuation<double> given{};
        FlightState next = loop.tick(first_tick + t, state, now, given, step);
        if (seen.normal_impulse_n_s > 0 || reference.is_at_surface()) {
            stand_still(tick_model, state, next);
        }
        const double end_s = static_cast<double>(first_tick + t + 1) * tick_model.tick_s;
        observer.saw(seen, end_s, next.plant.energy_j - state.plant.energy_j, is_holding);
        reference.next(seen.normal_impulse_n_s / tick_model.tick_s);
        rejection = seen.depth_m > max_touch_depth_m ? Rejection::collision : Rejection::none;
        const Rejection found = after(state, now, given, next, reference.point(), seen);
        rejection = found != Rejection::none ? found : rejection;
        state = next;
    }
    record = observer.record(rejection == Rejection::none);
    return rejection != Rejection::none || record.is_met ? rejection : Rejection::goal_missed;
}

}  // namespace downwash::simulation
