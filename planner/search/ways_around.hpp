#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "downwash/base/vector3.hpp"
#include "downwash/search/space_search_space.hpp"

namespace downwash::planning {

/// Shortest ways of the level vehicle around obstacles, with its arm as at the start: on a grid of cells, from each to
/// all that touch it (Dijkstra 1959). A cell is open where the vehicle at its centre keeps the safety margin at some
/// heading. Where it does not keep some room more, surfaces and tracking make flights harder: there ways count longer
/// than they are. Coarse and without turns of the arm: it tells what is near to what, not what can be flown.
class WaysAround {
 public:
    using Corners = std::vector<Vector3>;

    /// The grid covers some places and the room around them within the bounds.
    /// @param transport with the arm of the vehicle   @param room_m beside the safety margin [m]   @param places_m not
    /// empty   @param most_cells about so many: cells are of 0.25 m or, where this would be more, larger   @param space
    /// must outlive it
    WaysAround(const SpaceSearchSpace& space, const SpaceConfiguration& transport, double room_m,
               std::span<const Vector3> places_m, double most_cells = 1 << 17);

    /// From the nearest of some places to each of others: the corners between the two, of which none can be left out;
    /// empty where the way is straight, nothing where there is none.
    /// @pre all are among the places of the grid
    [[nodiscard]] std::vector<std::optional<Corners>> from(std::span<const Vector3> from_m,
                                                           std::span<const std::vector<Vector3>> to_m);

 private:
    /// How far cells are apart that touch each other: their numbers, and their centres [m].
    struct Step {
        std::ptrdiff_t number;
        double length_m;
    };

    [[nodiscard]] std::size_t number_of(const std::array<int, 3>& cell) const noexcept;
    [[nodiscard]] std::array<int, 3> cell_of(const Vector3& at_m) const noexcept;
    [[nodiscard]] Vector3 centre_m(std::size_t cell) const noexcept;
    [[nodiscard]] double weight(std::size_t cell) {
        return weights_[cell] > 0 ? weights_[cell] : weights_[cell] = weight_at(centre_m(cell));
    }
    [[nodiscard]] double weight_at(const Vector3& at_m) const;
    [[nodiscard]] double straight_length_m(const Vector3& from_m, const Vector3& to_m);
    [[nodiscard]] std::optional<std::size_t> entry_of(const Vector3& place_m);
    void search(std::span<const Vector3> from_m);
    [[nodiscard]] Corners corners_to(std::size_t end);

    const SpaceSearchSpace& space_;
    SpaceConfiguration transport_;
    double room_m_;
    Vector3 low_m_{};
    double edge_m_ = 0;
    std::array<int, 3> counts_{};  ///< of cells; around them lies a layer that is closed
    std::vector<Step> steps_;
    std::vector<double> weights_;       ///< what a metre through each cell counts; infinite: closed, 0: not known yet
    std::vector<double> lengths_m_;     ///< weighted ones of the ways of the last search to every cell
    std::vector<std::size_t> befores_;  ///< the cell before on these ways; itself at their beginnings
};

}  // namespace downwash::planning
