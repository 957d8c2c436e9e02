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
    /// empty   @param space must outlive it
    WaysAround(const SpaceSearchSpace& space, const SpaceConfiguration& transport, double room_m,
               std::span<const Vector3> places_m);

    /// From the nearest of some places to each of others: the corners between the two, of which none can be left out;
    /// empty where the way is straight, nothing where there is none.
    /// @pre all are among the places of the grid
    [[nodiscard]] std::vector<std::optional<Corners>> from(std::span<const Vector3> from_m,
                                                           std::span<const std::vector<Vector3>> to_m);

 private:
    using Cell = std::array<int, 3>;
    enum class Room : std::uint8_t { unknown, wide, tight, none };

    [[nodiscard]] std::size_t number_of(const Cell& cell) const noexcept;
    [[nodiscard]] Cell cell_at(std::size_t number) const noexcept;
    [[nodiscard]] Cell cell_of(const Vector3& at_m) const noexcept;
    [[nodiscard]] Vector3 centre_m(const Cell& cell) const noexcept;
    [[nodiscard]] bool is_within(const Cell& cell) const noexcept;
    [[nodiscard]] Room room_at(const Cell& cell);
    [[nodiscard]] double weight(const Cell& cell);
    [[nodiscard]] double straight_length_m(const Vector3& from_m, const Vector3& to_m);
    [[nodiscard]] std::optional<std::size_t> entry_of(const Vector3& place_m);
    void search(std::span<const Vector3> from_m);
    [[nodiscard]] Corners corners_to(std::size_t end);

    const SpaceSearchSpace& space_;
    SpaceConfiguration transport_;
    Vector3 low_m_{};
    double room_m_;
    double edge_m_ = 0;
    Cell counts_{};
    std::vector<Room> rooms_;
    std::vector<double> lengths_m_;     ///< weighted ones of the ways of the last search to every cell
    std::vector<std::size_t> befores_;  ///< the cell before on these ways; itself at their beginnings
};

}  // namespace downwash::planning
