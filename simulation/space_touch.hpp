#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"
#include "downwash/simulation/contact_goal.hpp"

// A touch in space: what it is to be, and what became of it. space_touch_place.hpp finds it, a flight flies it.

namespace downwash {

/// A point of a robot that may touch.
struct SpaceTouchPoint {
    int link = -1;      ///< that it belongs to, -1: the multirotor
    Vector3 at_m = {};  ///< in the axes of the link, from its joint; of the multirotor from its centre of mass
};

/// How a robot that waits at a goal touches the surface in front of it. Places are those of the nominal scene: where a
/// world moves and turns obstacles, the touch goes with them.
struct SpaceTouch : TouchDemand {
    Vector3 surface_m = {};  ///< point of the surface; for a tip with a solid around it, as far in front of it
    Vector3 normal = {};     ///< unit vector out of the surface
    std::vector<SpaceTouchPoint> points;  ///< that touch, one at least
    Vector3 waiting_m = {};  ///< where the middle of the points waits, `standoff_m` in front of the surface
    TouchingPart part = TouchingPart::end_effector;
    double tolerance_m = 0;           ///< of the waiting, of the touched place where one is wanted, and of the slip
    std::optional<Vector3> wanted_m;  ///< point of the surface that it should touch; empty: wherever it does
};

/// How a touch ended.
enum class SpaceTouchEnd : std::uint8_t {
    met,
    missed,       ///< nothing was touched up to half a metre behind the place of the surface
    wrong_place,  ///< it was touched too far from the wanted place
    wrong_force,  ///< the mean force of a second of the hold was off by more than its tolerance, or there was none
    slipped,      ///< the part moved along the surface
    stuck,        ///< the part did not come free again
    too_deep,     ///< the part went in by more than max_touch_depth_m: the robot came too fast or pushes too hard
    cut_short,    ///< the flight ended meanwhile: something else was touched, the vehicle was lost
};

/// The end's name in files: "wrong_force".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(SpaceTouchEnd end) noexcept;

/// A touch in flight.
struct SpaceTouchRecord : TouchRecord {
    SpaceTouchEnd end = SpaceTouchEnd::cut_short;
    Vector3 place_m = {};  ///< middle of the points as the hold began, among obstacles in their nominal places
    double slip_m = 0;     ///< greatest way of the middle of the points along the surface over the hold
};

}  // namespace downwash
