#pragma once

// Private to scene/.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/vector3.hpp"

namespace downwash {

/// Faces that are not convex have at most so many corners: cutting takes time with the square of their number.
inline constexpr std::size_t max_concave_corners = 10'000;
/// Cutting a face takes at most so many comparisons of corners and edges: some seconds.
inline constexpr std::size_t max_face_comparisons = 500'000'000;

/// Why a face cannot be cut into triangles.
enum class FaceFault {
    none,
    bent,       ///< some corner lies farther from the face's plane than 0.05 of the face's size
    crossing,   ///< its outline crosses itself
    too_large,  ///< it is not convex and has more than max_concave_corners, or winds so much that cutting takes too
                ///< long
};

/// A face as triangles that fill it without overlap and turn the way the face turns.
struct FaceCut {
    FaceFault fault = FaceFault::none;
    /// Distance of the farthest corner from the face's plane over the face's size, the diagonal of its bounding box.
    double bend = 0;
    std::size_t comparisons = 0;                          ///< how many it took; none for a convex face
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< numbers of corners in the face; empty with a fault
};

/// Cuts a face, given by its corners in order around it. The face's plane goes through the mean of its corners; its
/// normal is the sum of the cross products of neighbours (Newell's method).
///
/// A convex face becomes a fan. For any other one the code clips ears in the face's plane (Meisters 1975, "Polygons
/// have ears"). The outline may touch itself, as that of a face with a hole does, which a bridge joins to the outer
/// edge. The triangles do not depend on which corner comes first; of a plane convex face only their number does not.
/// Triangles without area occur where corners lie on a line: they keep the edges of neighbours together.
/// @param max_comparisons with more of them the face is too large
/// @pre there are at least three corners, and they are finite
[[nodiscard]] DOWNWASH_EXPORT FaceCut cut_face(std::span<const Vector3> corners,
                                               std::size_t max_comparisons = max_face_comparisons);

}  // namespace downwash
