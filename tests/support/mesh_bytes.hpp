#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "downwash/base/vector3.hpp"

namespace downwash::test {

using Triangle = std::array<Vector3, 3>;

/// Four bytes, the lowest first.
inline std::string little_endian(std::uint32_t value) {
    std::string bytes;
    for (unsigned i = 0; i < 4; ++i) {
        bytes += static_cast<char>(value >> (8 * i) & 255U);
    }
    return bytes;
}

/// A binary STL file of some triangles, whose coordinates are rounded to floats; `header` becomes its first 80 bytes.
inline std::string binary_stl(const std::vector<Triangle>& triangles, std::string header = "") {
    header.resize(80, ' ');
    std::string bytes = header + little_endian(static_cast<std::uint32_t>(triangles.size()));
    for (const Triangle& triangle : triangles) {
        bytes += std::string(12, '\0');  // no normal
        for (const Vector3& corner : triangle) {
            for (const double number : corner) {
                bytes += little_endian(std::bit_cast<std::uint32_t>(static_cast<float>(number)));
            }
        }
        bytes += std::string(2, '\0');
    }
    return bytes;
}

/// The twelve triangles of a box, counter-clockwise seen from outside.
inline std::vector<Triangle> box_triangles(const Vector3& low, const Vector3& high) {
    std::vector<Triangle> triangles;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        for (const bool is_high : {false, true}) {
            std::array<Vector3, 4> corners{low, low, low, low};
            for (std::size_t i = 0; i < 4; ++i) {
                corners[i][axis] = is_high ? high[axis] : low[axis];
                corners[i][u] = i == 1 || i == 2 ? high[u] : low[u];
                corners[i][v] = i >= 2 ? high[v] : low[v];
            }
            if (is_high) {
                triangles.push_back({corners[0], corners[1], corners[2]});
                triangles.push_back({corners[0], corners[2], corners[3]});
            } else {
                triangles.push_back({corners[0], corners[2], corners[1]});
                triangles.push_back({corners[0], corners[3], corners[2]});
            }
        }
    }
    return triangles;
}

}  // namespace downwash::test
