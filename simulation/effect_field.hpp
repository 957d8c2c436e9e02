#pragma once

#include <concepts>

#include "downwash/dynamics/plant.hpp"
#include "downwash/effects/sided_factor.hpp"

// Where a flight takes the effects of surfaces from. One concept over the lane type, and any model of it for one flight
// at a time, chosen at run time.

namespace downwash::simulation {

/// The effects of surfaces in their nominal places on a level vehicle: a field over the plane of motion [m].
/// - `at_rotor(rotor, x_m, z_m)`: K by side of a rotor with its hub there
/// - `same_as(rotor)`: the earliest rotor that is known to have the same K, perhaps that rotor itself; where the
///   earlier rotors were asked for last
/// - `at_body(x_m, z_m)`: K by side of the body with the centre between its rotors there, where there is a fountain
/// - `wall_nearness(x_m, z_m)`: how near walls are to that centre, from -1 (behind) to 1 (ahead)
/// - `as_read()`: the field that a control law reads
template <class F, class T>
concept EffectField = requires(F& field, int rotor, const T& x_m, const T& z_m) {
    { field.at_rotor(rotor, x_m, z_m) } -> std::same_as<SidedFactor<T>>;
    { field.same_as(rotor) } -> std::same_as<int>;
    { field.at_body(x_m, z_m) } -> std::same_as<SidedFactor<T>>;
    { field.wall_nearness(x_m, z_m) } -> std::same_as<T>;
    field.as_read();
};

/// No surface effect anywhere.
struct NoEffect {
    template <class T>
    SidedFactor<T> at_rotor(int /*rotor*/, const T& /*x_m*/, const T& /*z_m*/) const {
        return {T(1), T(1)};
    }
    /// All rotors share the first one's.
    [[nodiscard, gnu::always_inline]] int same_as(int /*rotor*/) const noexcept { return 0; }
    template <class T>
    SidedFactor<T> at_body(const T& /*x_m*/, const T& /*z_m*/) const {
        return {T(1), T(1)};
    }
    template <class T>
    T wall_nearness(const T& /*x_m*/, const T& /*z_m*/) const {
        return T(0);
    }
    [[gnu::always_inline]] NoEffect& as_read() noexcept { return *this; }
};

/// Any EffectField, chosen at run time, for one flight at a time.
class FlightEffect {
 public:
    virtual ~FlightEffect() = default;
    FlightEffect(const FlightEffect&) = delete;
    FlightEffect& operator=(const FlightEffect&) = delete;

    virtual SidedFactor<double> at_rotor(int rotor, double x_m, double z_m) = 0;
    [[nodiscard]] int same_as(int rotor) const noexcept { return same_as_[rotor]; }
    virtual SidedFactor<double> at_body(double x_m, double z_m) = 0;
    virtual double wall_nearness(double x_m, double z_m) = 0;
    virtual FlightEffect& as_read() { return *this; }

 protected:
    /// Every rotor has a K of its own.
    FlightEffect() noexcept {
        for (int i = 0; i < max_rotors; ++i) {
            same_as_[i] = i;
        }
    }
    int same_as_[max_rotors];
};

/// A field as a FlightEffect. A control law reads what acts.
template <EffectField<double> Field>
class FlightEffectOf final : public FlightEffect {
 public:
    explicit FlightEffectOf(const Field& field) : field_(field) { note_equal_rotors(); }

    SidedFactor<double> at_rotor(int rotor, double x_m, double z_m) override {
        const SidedFactor<double> k = field_.at_rotor(rotor, x_m, z_m);
        note_equal_rotors();
        return k;
    }
    SidedFactor<double> at_body(double x_m, double z_m) override { return field_.at_body(x_m, z_m); }
    double wall_nearness(double x_m, double z_m) override { return field_.wall_nearness(x_m, z_m); }

 private:
    void note_equal_rotors() {
        for (int i = 0; i < max_rotors; ++i) {
            same_as_[i] = field_.same_as(i);
        }
    }

    Field field_;
};

}  // namespace downwash::simulation
