#pragma once

#include "../support/random.hpp"
#include "downwash/grids/factor_grid.hpp"

namespace downwash::test {

/// A small grid with everything that a grid can have: planar with and without offsets or a volume, any frame, awkward
/// numbers.
inline FactorGrid any_grid(Random& random) {
    const auto axis = [&random] {
        const double low_m = random.uniform(-20, 20);
        return GridAxis{low_m, low_m + random.uniform(0.1, 9), static_cast<std::size_t>(random.integer(2, 6))};
    };
    FactorGridParts parts;
    parts.frame =
        PlaneOfMotion({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)}, random.uniform(-4, 4));
    parts.x = axis();
    parts.z = axis();
    std::size_t layers = 1;
    switch (random.integer(0, 2)) {
        case 0:
            parts.y = axis();
            break;
        case 1:
            parts.lateral_offsets_m = {random.uniform(-1, -0.5), random.uniform(-0.1, 0.1), random.uniform(0.5, 1)};
            layers = 3;
            break;
        default:
            break;
    }
    const std::size_t nodes = layers * parts.x.count * parts.y.count * parts.z.count;
    for (const char* name : {"factor", "ground", "ceiling", "flyable"}) {
        GridField field{name, std::vector<double>(nodes)};
        for (double& value : field.values) {
            value = field.name == "flyable" ? random.integer(0, 1) : random.uniform(0, 3);
        }
        parts.fields.push_back(std::move(field));
    }
    parts.provenance = {{"program", "downwash 0.1.0"}, {"problem", "a <b> & \"c\": d"}, {"note", ""}};
    return FactorGrid(std::move(parts));
}

/// x from 0 to 1 m and z from 0 to 2 m with K = 1 + x + 10 z at the corners.
inline FactorGridParts two_by_two() {
    FactorGridParts parts;
    parts.x = {0, 1, 2};
    parts.z = {0, 2, 2};
    parts.fields = {{"factor", {1, 2, 21, 22}}};
    return parts;
}

/// Two layers in a turned frame, with a history.
inline FactorGrid layered() {
    FactorGridParts parts = two_by_two();
    parts.frame = PlaneOfMotion({3, -4, 0.1}, 0.3);
    parts.x = {-0.1, 0.2, 2};
    parts.lateral_offsets_m = {-0.25, 0.25};
    parts.fields = {{"factor", {1, 1.1, 1.2, 1.3, 2.1, 2.2, 2.3, 2.4}}, {"flyable", {1, 1, 0, 0, 1, 1, 1, 1}}};
    parts.provenance = {{"program", "downwash 0.1.0"}, {"note", "caf\xc3\xa9: <&>"}};
    return FactorGrid(std::move(parts));
}

/// Whether two grids are the same to the last bit.
inline bool is_same(const FactorGrid& a, const FactorGrid& b) {
    return a.frame().origin_m() == b.frame().origin_m() && a.frame().heading_rad() == b.frame().heading_rad() &&
           a.x() == b.x() && a.y() == b.y() && a.z() == b.z() && a.lateral_offsets_m() == b.lateral_offsets_m() &&
           a.fields() == b.fields() && a.provenance() == b.provenance();
}

/// Whether any grid comes back from its text to the bit, and its text to the byte.
template <class Write, class Read>
bool comes_back(const Write& text_of, const Read& parsed) {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        const FactorGrid grid = any_grid(random);
        const FactorGrid read = parsed(text_of(grid));
        if (!is_same(read, grid) || text_of(read) != text_of(grid)) {
            return false;
        }
    }
    return true;
}

}  // namespace downwash::test
