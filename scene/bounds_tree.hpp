#pragma once

// Private to scene/.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "downwash/scene/bounding_box.hpp"

namespace downwash {

/// A hierarchy of bounding boxes over numbered parts. It finds the few relevant ones among millions without visiting
/// all. It visits a small number of parts one after the other, in their order.
class BoundsTree {
 public:
    BoundsTree() = default;
    explicit BoundsTree(std::span<const BoundingBox> parts);

    /// Calls `visit(part)` for every part whose own box may have a gap of at most `limit`, nearer boxes first, until it
    /// returns true; whether it did. `limit` may shrink meanwhile.
    /// @param gap of a box; no box within another has a smaller one than that other
    template <class Gap, class Visit>
    bool any(const Gap& gap, const double& limit, const Visit& visit) const {
        if (nodes_.size() <= 1) {
            for (std::size_t part = 0; part < order_.size(); ++part) {
                if (visit(part)) {
                    return true;
                }
            }
            return false;
        }
        std::array<Entry, max_levels> open;
        std::size_t count = 0;
        open[count++] = {0, gap(nodes_[0].bounds)};
        while (count > 0) {
            const Entry entry = open[--count];
            if (entry.gap > limit) {
                continue;
            }
            const Node& node = nodes_[entry.node];
            if (node.count > 0) {
                for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
                    if (visit(static_cast<std::size_t>(order_[i]))) {
                        return true;
                    }
                }
                continue;
            }
            const Entry left{entry.node + 1, gap(nodes_[entry.node + 1].bounds)};
            const Entry right{node.first, gap(nodes_[node.first].bounds)};
            const bool is_left_nearer = left.gap <= right.gap;
            open[count++] = is_left_nearer ? right : left;
            open[count++] = is_left_nearer ? left : right;
        }
        return false;
    }

 private:
    /// A leaf holds `count` parts from `first` on in order_; an inner node (count 0) has its children at the next
    /// index and at `first`.
    struct Node {
        BoundingBox bounds;
        std::uint32_t first, count;
    };
    struct Entry {
        std::uint32_t node;
        double gap;
    };
    /// Halving two thousand million parts takes 31 steps, and each leaves at most one node open.
    static constexpr std::size_t max_levels = 40;

    void build(std::span<const BoundingBox> parts, std::uint32_t first, std::uint32_t last);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace downwash
