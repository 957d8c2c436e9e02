#pragma once

// Private to aeromap.

#include <memory_resource>
#include <vector>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/scene/shadow_outline.hpp"

namespace downwash {

/// Coordinates on a disc: u along its chords, v across them, from the hub, in metres. (du_x, du_y) is a unit vector.
struct ChordFrame {
    double hub_x_m, hub_y_m;
    double radius_m;
    double du_x, du_y;

    [[nodiscard]] double u_of(double x, double y) const { return (x - hub_x_m) * du_x + (y - hub_y_m) * du_y; }
    [[nodiscard]] double v_of(double x, double y) const { return (y - hub_y_m) * du_x - (x - hub_x_m) * du_y; }
    [[nodiscard]] double x_of(double u, double v) const { return hub_x_m + u * du_x - v * du_y; }
    [[nodiscard]] double y_of(double u, double v) const { return hub_y_m + u * du_y + v * du_x; }
};

/// Appends the chords v at which the outline begins, ends, has a corner, or leaves the disc.
void add_breaks(const ChordFrame& frame, Side side, const ShadowOutline& outline, std::pmr::vector<double>& breaks);

/// Appends the chords v at which straight lines of two outlines cross each other inside the disc.
void add_crossings(const ChordFrame& frame, const ShadowOutline& one, const ShadowOutline& other,
                   std::pmr::vector<double>& breaks);

/// Appends the positions u inside `stretch` of the chord v where an edge crosses it that creases the surface seen from
/// the rotor.
void add_creases(const ChordFrame& frame, Side side, const ShadowOutline& outline, double v, const Interval& stretch,
                 std::pmr::vector<double>& cuts);

}  // namespace downwash
