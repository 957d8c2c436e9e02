#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "downwash/search/search_space.hpp"

namespace downwash::planning {

/// Places of the nodes of a tree, to be found by distance. Few of them are scanned; from `indexed_from` places
/// on OMPL's geometric near-neighbour access tree (GNAT, Brin 1995) answers, which then is faster (bench/micro). Both
/// give the same places in the same order.
template <class Family>
class NearestPlacesOf {
 public:
    using Configuration = typename Family::Configuration;
    using SearchSpace = typename Family::SearchSpace;

    /// @param space must outlive it
    explicit NearestPlacesOf(const SearchSpace& space, std::size_t indexed_from = default_indexed_from);
    ~NearestPlacesOf();
    NearestPlacesOf(const NearestPlacesOf&) = delete;
    NearestPlacesOf& operator=(const NearestPlacesOf&) = delete;

    static constexpr std::size_t default_indexed_from = 1000;

    /// Adds a place; the first has the number 0.
    void add(const Configuration& place);

    /// The numbers of the `count` places nearest to a configuration, nearest first; of those equally far away the
    /// oldest.
    [[nodiscard]] std::vector<std::size_t> nearest(const Configuration& to, std::size_t count) const;

 private:
    struct Index;
    /// Square of the distance, number of the place.
    using Found = std::pair<double, std::size_t>;
    [[nodiscard]] std::vector<Found> scanned(const Configuration& to, std::size_t count) const;
    [[nodiscard]] std::vector<Found> indexed(const Configuration& to, std::size_t count) const;

    const SearchSpace& space_;
    std::size_t indexed_from_;
    std::vector<Configuration> places_;
    std::unique_ptr<Index> index_;  ///< nothing below indexed_from places
};
using NearestPlaces = NearestPlacesOf<Plane>;

}  // namespace downwash::planning
