#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "downwash/base/export.hpp"

namespace downwash {

/// Who computes collisions and clearances.
enum class CollisionCheckerKind : std::uint8_t {
    own,  ///< our own GJK, exact to 1e-8 m
    fcl,  ///< the Flexible Collision Library
};

/// Each once, in their order.
inline constexpr std::array all_collision_checkers{CollisionCheckerKind::own, CollisionCheckerKind::fcl};

/// Name as in problem files: "own".
[[nodiscard]] DOWNWASH_EXPORT std::string_view name_of(CollisionCheckerKind kind);

}  // namespace downwash
