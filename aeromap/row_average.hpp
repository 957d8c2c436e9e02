#pragma once

// Private to aeromap.

#include <optional>

#include "downwash/aeromap/disc_query.hpp"
#include "downwash/aeromap/row_columns.hpp"
#include "downwash/base/export.hpp"

namespace downwash {

/// disc_average among many parts, in a time that hardly depends on their number: over the rows that cross the disc,
/// with the first surface along each from `columns`. A row stands for its strip of the disc; along it every piece of
/// surface counts exactly. The more the rows differ from their neighbours, the more of them are taken: 6, 16 or 64.
///
/// Error: below 1e-3 where K differs by at most 1 over the disc, and that many times as much where it differs by more.
/// Empty where the rows leave more doubt than that or may pass something by, where a part reaches into the slab around
/// the hub over or under the disc (it is then closer than a quarter of a radius), and for hubs that are not finite:
/// disc_average then takes the parts one by one. Apart from that it depends on what is over and under the disc alone,
/// to rounding.
/// @param columns of the query's scene and radius
[[nodiscard]] DOWNWASH_EXPORT std::optional<double> row_average(const DiscQuery& query, const RowColumns& columns);

}  // namespace downwash
