#pragma once

// Private to aeromap.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "downwash/aeromap/volume_map.hpp"

namespace downwash {

/// Halves the cells in one brick of a volume. What it looks at lies on one lattice, so that boxes share their samples.
class VolumeMap::Builder {
 public:
    /// The cells from `first` to before `last`.
    /// @param boxes of the whole volume, counted on
    Builder(const VolumeMap& volume, const Cell& first, const Cell& last, std::atomic<std::size_t>& boxes);

    /// @throws InputError when the volume has too many boxes
    void build();
    /// Frees what build() made.
    void clear() noexcept {
        nodes_ = {};
        polynomials_ = {};
    }

    [[nodiscard]] const Cell& first() const noexcept { return first_; }
    [[nodiscard]] const Cell& last() const noexcept { return last_; }
    /// First those of the cells, x running fastest; indices within the brick.
    [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
    /// The first one stays unused, as in the volume.
    [[nodiscard]] const std::vector<Coefficients>& polynomials() const noexcept { return polynomials_; }

 private:
    using Point = std::array<std::uint32_t, 3>;  ///< of the lattice, from the brick's low corner
    struct Box {
        Point low, edges;
        [[nodiscard]] Point at(std::uint32_t i, std::uint32_t j, std::uint32_t k, std::uint32_t parts) const {
            return {low[0] + i * (edges[0] / parts), low[1] + j * (edges[1] / parts), low[2] + k * (edges[2] / parts)};
        }
    };

    void fill(std::size_t node, const Box& box, bool is_flyable);
    [[nodiscard]] bool is_quiet(const Box& box) const;
    [[nodiscard]] std::size_t too_long(const Box& box) const;
    [[nodiscard]] std::size_t missed_axis(const Box& box, const Coefficients& polynomial);
    [[nodiscard]] double missed(const Box& box, const Coefficients& polynomial, const Point& eighths);
    [[nodiscard]] Coefficients polynomial(const Box& box);
    [[nodiscard]] double factor(const Point& point);
    [[nodiscard]] Vector3 hub_m(const Point& point) const;
    [[nodiscard]] Vector3 edges_m(const Box& box) const;

    const VolumeMap& volume_;
    const DirectEffect& effect_;
    Cell first_, last_;
    std::atomic<std::size_t>& boxes_;
    double longest_m_;
    std::vector<Node> nodes_;
    std::vector<Coefficients> polynomials_;
    std::unordered_map<std::uint64_t, double> known_;  ///< K at points of the lattice
};

}  // namespace downwash
