#pragma once

namespace downwash {

/// What walls beside a vehicle do to it (docs/model.md 4.8): shares of the rotors' free-air thrust T that fade with the
/// gap between the wall and the nearest rotor's edge, as exp(-gap / (decay_radii R)). Both shares 0: nothing.
struct WallEffect {
    double force = 0;          ///< horizontal force over T where a rotor touches the wall; positive: away from it
    double moment = 0;         ///< pitch moment over T R there; positive: the side towards the wall sinks
    double decay_radii = 0.7;  ///< > 0; over this gap both fall to 1/e

    [[nodiscard]] bool is_any() const noexcept { return force != 0 || moment != 0; }
    friend bool operator==(const WallEffect&, const WallEffect&) = default;
};

}  // namespace downwash
