#pragma once

#include <memory>
#include <optional>

#include "downwash/base/export.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash {

/// Where a vehicle that has hovered for long is in each world: at the fixed point of the tick without noise and gusts
/// (docs/model.md 9, "Start"). Found by Newton's method with the Jacobian of the nominal world, in some ten ticks
/// instead of the two thousand of a hover.
class DOWNWASH_EXPORT HoverEquilibria {
 public:
    /// @param map whose surfaces act; nullptr: none do
    /// @param start at rest, nominal. Its place is the reference of the hover
    /// @pre model and map outlive the object
    HoverEquilibria(const FlightModel& model, const AeroMap* map, const FlightState& start);
    ~HoverEquilibria();
    HoverEquilibria(const HoverEquilibria&) = delete;
    HoverEquilibria& operator=(const HoverEquilibria&) = delete;

    /// The equilibrium in a world, to some micrometres, with the memory of a world without gusts and no energy spent.
    /// Nothing where none was found, where small disturbances of it are not known to decay, or where the controller
    /// sees more than simulation::recent_ticks late: fly the hover there. May be called from several threads.
    [[nodiscard]] std::optional<FlightState> in(const FlownWorld& world) const;

 private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace downwash
