#pragma once

#include "downwash/simulation/surroundings.hpp"

namespace downwash::simulation {

/// The surface effect as a control law reads it: that of the flight's own source, tilt included, where everything is
/// believed to be. Of a world it knows nothing: neither how strong effects really are nor where the surfaces are.
/// @tparam Effect what a flight takes its effects from, see WorldSurroundings; one that knows what a law reads
/// elsewhere than at its rotors says so by `read(rotor, x_m, z_m)`
template <class T, class Effect>
class ReadEffect {
 public:
    ReadEffect(Effect& effect, const TiltLoss& tilt_loss) : effect_(effect), tilt_loss_(tilt_loss) {}

    /// K at a hub of a rotor, or of the body, in the plane.
    T operator()(int rotor, T x_m, T z_m, T sin_pitch) const {
        if constexpr (requires { effect_.read(rotor, x_m, z_m); }) {
            return effect_.read(rotor, x_m, z_m);
        } else if constexpr (requires { effect_.sided(rotor, x_m, z_m); }) {
            return TiltedEffect<T, Effect>(effect_, tilt_loss_)(rotor, x_m, z_m, sin_pitch);
        } else {
            return effect_(rotor, x_m, z_m);
        }
    }
    [[nodiscard]] int same_as(int rotor) const { return dynamics::rotor_with_factor_of(effect_, rotor); }

 private:
    Effect& effect_;
    const TiltLoss& tilt_loss_;
};

}  // namespace downwash::simulation
