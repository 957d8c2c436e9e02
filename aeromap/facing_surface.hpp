#pragma once

// Private to aeromap.

#include <memory_resource>
#include <vector>

#include "downwash/aeromap/chord_envelope.hpp"
#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/footprint.hpp"
#include "downwash/aeromap/outline_crossings.hpp"

namespace downwash {

/// The gap from the rotor plane to a part over or under (x, y); infinite when there is none.
[[nodiscard]] double gap_at(const DiscQuery& query, const Footprint& part, double x, double y);

/// Whether a part's surface is straight along the chords of a frame, between its creases: plane faces always are, that
/// of a cylinder is along its axis.
[[nodiscard]] bool is_straight(const Footprint& part, const ChordFrame& frame);

/// Adds what a part with plane faces shows to the chord v where its shadow is.
/// @return false, having added nothing, when the part has none or the rotor plane cuts them
[[nodiscard]] bool add_plane_stretches(const DiscQuery& query, const ChordFrame& frame, const Footprint& part, double v,
                                       const Interval& shadow, ChordEnvelope& envelope);

/// Appends the chords v at which a surface passes the model's cap all along the chord, or nearly so, as kinks in v.
void add_kinks(const DiscQuery& query, const ChordFrame& frame, const Footprint& part,
               std::pmr::vector<double>& breaks);

}  // namespace downwash
