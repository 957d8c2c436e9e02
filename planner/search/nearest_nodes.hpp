#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "downwash/search/search_space.hpp"

namespace downwash::planning {

struct FlightNode;

/// The nodes of a tree, to be found by the place at which they are. Small trees are scanned; from `indexed_from` nodes
/// on OMPL's geometric near-neighbour access tree (GNAT, Brin 1995) answers, which then is faster (bench/micro). Both
/// give the same nodes in the same order.
class NearestNodes {
 public:
    /// @param space must outlive it
    explicit NearestNodes(const SearchSpace& space, std::size_t indexed_from = default_indexed_from);
    ~NearestNodes();
    NearestNodes(const NearestNodes&) = delete;
    NearestNodes& operator=(const NearestNodes&) = delete;

    static constexpr std::size_t default_indexed_from = 20000;

    /// @param node outlives it, and stays at its place
    void add(FlightNode& node);

    /// The `count` nodes nearest to a configuration, nearest first; of those equally far away the oldest.
    [[nodiscard]] std::vector<FlightNode*> nearest(const Configuration& to, std::size_t count) const;

 private:
    struct Index;
    /// Square of the distance, number of the node.
    using Found = std::pair<double, std::size_t>;
    [[nodiscard]] std::vector<Found> scanned(const Configuration& to, std::size_t count) const;
    [[nodiscard]] std::vector<Found> indexed(const Configuration& to, std::size_t count) const;

    const SearchSpace& space_;
    std::size_t indexed_from_;
    std::vector<FlightNode*> nodes_;
    std::vector<Configuration> places_;  ///< of the nodes, in one piece of memory
    std::unique_ptr<Index> index_;       ///< nothing below indexed_from nodes
};

}  // namespace downwash::planning
