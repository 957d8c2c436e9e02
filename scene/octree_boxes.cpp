#include "downwash/scene/octree_boxes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>

#include "downwash/scene/bounds_tree.hpp"
#include "downwash/scene/convex.hpp"
#include "downwash/scene/scene_solids.hpp"
#include "downwash/scene/surface_facts.hpp"

namespace downwash {
namespace {

/// How far off its place a cube may lie, in sides: rounding.
constexpr double place_tolerance = 1e-9;

/// Adds the cube as a block; whether it lies on the grid of its size.
bool add_block(const OccupiedCube& cube, std::vector<CellBlock>& blocks) {
    CellBlock block{cube.side_m, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
        const double place = cube.center_local_m[k] / cube.side_m - 0.5;
        if (!(std::abs(place) < 1e9) || std::abs(place - std::round(place)) > place_tolerance) {
            return false;
        }
        block.low[k] = std::llround(place);
        block.high[k] = block.low[k] + 1;
    }
    blocks.push_back(block);
    return true;
}

/// Joins blocks that follow one another along an axis and agree along the others.
void merge_along(std::size_t axis, std::vector<CellBlock>& blocks) {
    const std::size_t other = (axis + 1) % 3;
    const std::size_t third = (axis + 2) % 3;
    const auto profile = [&](const CellBlock& b) {
        return std::tuple(b.side_m, b.low[other], b.high[other], b.low[third], b.high[third]);
    };
    std::sort(blocks.begin(), blocks.end(), [&](const CellBlock& a, const CellBlock& b) {
        return profile(a) < profile(b) || (profile(a) == profile(b) && a.low[axis] < b.low[axis]);
    });
    std::size_t kept = 0;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
        CellBlock& last = blocks[kept];
        if (profile(blocks[i]) == profile(last) && blocks[i].low[axis] <= last.high[axis]) {
            last.high[axis] = std::max(last.high[axis], blocks[i].high[axis]);
        } else {
            blocks[++kept] = blocks[i];
        }
    }
    blocks.resize(blocks.empty() ? 0 : kept + 1);
}

LocalBox box_of(const CellBlock& block) {
    LocalBox box{};
    for (std::size_t k = 0; k < 3; ++k) {
        box.center_m[k] = 0.5 * block.side_m * static_cast<double>(block.low[k] + block.high[k]);
        box.size_m[k] = block.side_m * static_cast<double>(block.high[k] - block.low[k]);
    }
    return box;
}

}  // namespace

std::vector<LocalBox> merged_boxes(std::vector<CellBlock> blocks) {
    for (const std::size_t axis : {0U, 1U, 2U}) {
        merge_along(axis, blocks);
    }
    std::vector<LocalBox> boxes;
    boxes.reserve(blocks.size());
    std::transform(blocks.begin(), blocks.end(), std::back_inserter(boxes), box_of);
    return boxes;
}

std::vector<LocalBox> merged_boxes(const std::vector<OccupiedCube>& cubes) {
    std::vector<CellBlock> blocks;
    std::vector<LocalBox> boxes;
    for (const OccupiedCube& cube : cubes) {
        if (!add_block(cube, blocks)) {
            boxes.push_back({cube.center_local_m, {cube.side_m, cube.side_m, cube.side_m}});
        }
    }
    const std::vector<LocalBox> merged = merged_boxes(std::move(blocks));
    boxes.insert(boxes.end(), merged.begin(), merged.end());
    return boxes;
}

std::vector<LocalBox> solid_boxes(const Octomap& octomap) {
    std::vector<LocalBox> boxes = merged_boxes(octomap.tree->cubes);
    if (octomap.unknown == UnknownSpace::occupied) {
        boxes.insert(boxes.end(), octomap.tree->unseen.begin(), octomap.tree->unseen.end());
    }
    return boxes;
}

std::size_t piece_count(const Octomap& octomap) {
    std::vector<BoundingBox> boxes;
    for (const LocalBox& box : solid_boxes(octomap)) {
        boxes.push_back({box.center_m - 0.5 * box.size_m, box.center_m + 0.5 * box.size_m});
    }
    std::vector<std::size_t> piece(boxes.size());
    std::iota(piece.begin(), piece.end(), std::size_t{0});
    const auto root = [&piece](std::size_t i) {
        while (piece[i] != i) {
            piece[i] = piece[piece[i]];
            i = piece[i];
        }
        return i;
    };
    const BoundsTree index(boxes);
    const double touching_m = place_tolerance * octomap.tree->resolution_m;
    std::size_t pieces = boxes.size();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto gap = [&](const BoundingBox& other) { return gap_m(boxes[i], other); };
        index.any(gap, touching_m, [&](std::size_t other) {
            if (gap(boxes[other]) <= touching_m && root(i) != root(other)) {
                piece[root(other)] = root(i);
                --pieces;
            }
            return false;
        });
    }
    return pieces;
}

}  // namespace downwash
