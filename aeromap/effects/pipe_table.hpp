#pragma once

#include "downwash/base/export.hpp"
#include "downwash/effects/effect_table.hpp"

namespace downwash {

/// K of a whole disc whose hub is over (or under) the axis of a level pipe, from K of a wide flat surface at each of
/// its points: the mean of docs/model.md 4.1 over the covered strip.
/// @param pipe_radii radius of the pipe over that of the rotor, > 0   @param z_over_r from the rotor plane to the
/// nearest line of the pipe, >= 0
[[nodiscard]] DOWNWASH_EXPORT double mean_over_pipe(const EffectTable::Curve& points, double pipe_radii,
                                                    double z_over_r);

/// The table whose mean over a disc is a measured one: measurements over a pipe hold for the whole disc, and averaging
/// them over the disc again would count the uncovered part of it twice. Solves mean_over_pipe() = measured at every
/// row.
/// @param measured K of a whole disc, hub over the axis of a pipe   @param pipe_radii as for mean_over_pipe()
/// @throws InputError when no table with K from 0 to 100 has this mean
[[nodiscard]] DOWNWASH_EXPORT EffectTable points_of_pipe(const EffectTable& measured, double pipe_radii);

}  // namespace downwash
