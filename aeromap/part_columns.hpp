#pragma once

// Private to aeromap.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "downwash/scene/scene.hpp"

namespace downwash {

/// Finds the parts over and under level discs that move little from one query to the next, as rotors in a flight do.
/// The ground is divided into squares; what stands over or under the discs around one square is found once, when a
/// thread asks for it the second time in a row. Each thread keeps the last squares that it asked for: answers do not
/// depend on what was asked before, only their time does.
class PartColumns {
 public:
    /// @param scene must live as long as this   @param radius_m of the discs, above 0
    PartColumns(const Scene& scene, double radius_m);

    /// Appends, in ascending order, the parts that have a shadow and whose bounding boxes meet a box.
    /// @param box the column of a disc: no wider than two radii, of any height
    void add_parts_meeting(const BoundingBox& box, std::pmr::vector<std::size_t>& parts) const;

 private:
    struct Part {
        std::size_t index;
        BoundingBox bounds;
    };
    struct Square {
        std::uint64_t owner = 0;  ///< the columns that it belongs to; 0 for none
        double x = 0, y = 0;      ///< its number along each axis
        bool is_filled = false;
        std::vector<Part> parts;
    };
    /// Squares side by side have different places, up to sixteen in each direction.
    static constexpr std::size_t side = 16;
    using Squares = std::array<Square, side * side>;

    [[nodiscard]] Square& place_of(double x, double y) const;
    void fill(Square& square) const;

    const Scene& scene_;
    double radius_m_;
    std::uint64_t id_;  ///< differs from that of all other objects of this process, those that are gone included
};

}  // namespace downwash
