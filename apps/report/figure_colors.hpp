#pragma once

#include "downwash/report/picture.hpp"

namespace downwash {

/// The colours of what figures show, the same in all of them.
inline constexpr Color flown_color = color_of(0xd55e00);         ///< a vehicle that flies
inline constexpr Color planned_color = color_of(0x555555);       ///< what is planned
inline constexpr Color end_effector_color = color_of(0x00805e);  ///< its way
inline constexpr Color goal_color = color_of(0xa3397a);          ///< where it is to get
inline constexpr Color obstacle_color = color_of(0x6e6e6e);      ///< an obstacle's cross section
inline constexpr Color outline_color = color_of(0x303030);       ///< its edge

/// The font of all figures.
inline constexpr char figure_font[] = "DejaVu Sans";

}  // namespace downwash
