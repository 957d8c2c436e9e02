#include "downwash/scene/octomap_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/foreign_file.hpp"
#include "downwash/scene/octree_boxes.hpp"

namespace downwash {
namespace {

constexpr std::string_view binary_line = "# Octomap OcTree binary file";
constexpr std::string_view full_line = "# Octomap OcTree file";

constexpr unsigned max_depth = 16;
constexpr std::uint32_t cells_across = 1U << max_depth;
constexpr double min_resolution_m = 1e-4;
constexpr double max_resolution_m = 30;

struct Header {
    bool is_binary = false;
    bool has_colors = false;  ///< of a ColorOcTree, of which only the probabilities count
    double resolution_m = 0;
    std::uint64_t nodes = 0;
    std::size_t data_at = 0;  ///< first byte of the nodes
};

/// Reads the lines up to "data".
Header read_header(std::string_view bytes, const std::string& name) {
    Header header;
    header.is_binary = bytes.starts_with(binary_line);
    if (!header.is_binary && !bytes.starts_with(full_line)) {
        foreign::fail(name, "line 1: found '" + excerpt(bytes.substr(0, bytes.find('\n'))) + "', expected '" +
                                std::string(binary_line) + "' or '" + std::string(full_line) + "'");
    }
    bool has_id = false;
    std::optional<std::uint64_t> nodes;
    std::optional<double> resolution_m;
    foreign::Lines lines(bytes, name);
    const auto& words = lines.words();
    while (lines.next() && words[0] != "data") {
        if (words[0].starts_with('#')) {
            continue;
        }
        if (words.size() != 2) {
            lines.fail("found " + std::to_string(words.size()) + " words, expected a key and its value, or 'data'");
        }
        if (words[0] == "id" && !has_id) {
            header.has_colors = words[1] == "ColorOcTree";
            has_id = header.has_colors || words[1] == "OcTree";
            if (!has_id) {
                lines.fail("a tree of kind '" + excerpt(words[1]) + "': expected OcTree or ColorOcTree");
            }
        } else if (words[0] == "size" && !nodes) {
            nodes = parse_number<std::uint64_t>(words[1]);
            if (!nodes) {
                lines.fail("found '" + excerpt(words[1]) + "', expected the number of nodes");
            }
        } else if (words[0] == "res" && !resolution_m) {
            resolution_m = parse_number<double>(words[1]);
            if (!resolution_m || *resolution_m < min_resolution_m || *resolution_m > max_resolution_m) {
                lines.fail("found '" + excerpt(words[1]) + "', expected a resolution from 0.0001 to 30 m");
            }
        } else {
            lines.fail("found '" + excerpt(words[0]) + "', expected id, size and res once each, then 'data'");
        }
    }
    if (words.size() != 1) {
        lines.fail("the header ends here: expected a line 'data' of its own");
    }
    for (const auto& [key, is_given] :
         {std::pair("id", has_id), std::pair("size", nodes.has_value()), std::pair("res", resolution_m.has_value())}) {
        if (!is_given) {
            lines.fail("the header ends: expected a line '" + std::string(key) + "' before it");
        }
    }
    header.resolution_m = *resolution_m;
    header.nodes = *nodes;
    header.data_at = bytes.size() - lines.rest().size();
    return header;
}

/// A cube of the octree: its lowest corner in cells of the finest level, and its level, the root's being 0.
struct Place {
    std::array<std::uint32_t, 3> low{};
    unsigned depth = 0;

    [[nodiscard]] std::uint32_t cells() const { return cells_across >> depth; }
    /// The eighth that lies high along x, y, z where bit 0, 1, 2 of `child` is set.
    [[nodiscard]] Place eighth(unsigned child) const {
        Place place{low, depth + 1};
        for (unsigned axis = 0; axis < 3; ++axis) {
            place.low[axis] += (child >> axis & 1U) * place.cells();
        }
        return place;
    }
};

/// Cells of the finest level from the lowest to the highest of what was added.
struct CellBounds {
    std::array<std::uint32_t, 3> low{cells_across, cells_across, cells_across};
    std::array<std::uint32_t, 3> high{};  ///< one beyond the highest

    void include(const Place& place) {
        for (unsigned axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], place.low[axis]);
            high[axis] = std::max(high[axis], place.low[axis] + place.cells());
        }
    }
    /// In cells of the finest level.
    [[nodiscard]] double volume() const {
        double cells = 1;
        for (unsigned axis = 0; axis < 3; ++axis) {
            cells *= high[axis] - low[axis];
        }
        return cells;
    }
};

/// Walks through the nodes as the file orders them, depth first.
class NodeReader {
 public:
    NodeReader(std::string_view bytes, const std::string& name, const Header& header)
        : bytes_(bytes), name_(name), header_(header), at_(header.data_at) {
        tree_.resolution_m = header.resolution_m;
    }

    OccupancyTree read() {
        count_node();
        if (header_.is_binary) {
            read_children({});
        } else {
            read_node({});
        }
        if (nodes_ != header_.nodes) {
            fail("the nodes end after " + std::to_string(nodes_) + ": expected " + std::to_string(header_.nodes) +
                 " as the header's size says");
        }
        if (at_ != bytes_.size()) {
            fail("the file continues after its last node: expected its end");
        }
        if (tree_.cubes.empty()) {
            foreign::fail(name_, "has no occupied leaf: expected at least one");
        }
        describe_unseen();
        return std::move(tree_);
    }

 private:
    /// Binary: two bits for each of eight children. 0 is unknown, 1 a free leaf, 2 an occupied leaf, 3 a node that
    /// follows.
    void read_children(const Place& parent) {
        require_depth(parent);
        const unsigned low = next_byte();
        const unsigned bits = low | next_byte() << 8U;
        if (bits == 0) {
            at_ -= 2;
            fail("a node without children among the inner nodes: expected at least one child");
        }
        for (unsigned child = 0; child < 8; ++child) {
            const unsigned state = bits >> (2 * child) & 3U;
            if (state != 0) {
                count_node();
            }
            if (state == 0) {
                add_unseen(parent.eighth(child));
            } else if (state == 1) {
                add_free(parent.eighth(child));
            } else if (state == 2) {
                add_cube(parent.eighth(child));
            }
        }
        for (unsigned child = 0; child < 8; ++child) {
            if ((bits >> (2 * child) & 3U) == 3) {
                read_children(parent.eighth(child));
            }
        }
    }

    /// Full: the logarithm of the odds that the node is occupied, red, green and blue if it has a colour, and a bit for
    /// each child that follows.
    void read_node(const Place& place) {
        const std::size_t begin = at_;
        std::array<char, 4> word{};
        for (char& byte : word) {
            byte = static_cast<char>(next_byte());
        }
        const auto log_odds = number_at<float>(word.data());
        // Sums of a sensor's log odds are 0 or not this small; swapped bytes mostly are, or are huge.
        const bool is_plausible = log_odds == 0 || (std::abs(log_odds) >= 1e-9F && std::abs(log_odds) <= 1000);
        if (!is_plausible) {
            at_ = begin;
            fail("found log odds of " + to_text(static_cast<double>(log_odds), 6) +
                 ", expected a finite number of at most 1000 in size, little-endian");
        }
        for (int color = 0; header_.has_colors && color < 3; ++color) {
            next_byte();
        }
        const unsigned children = next_byte();
        if (children == 0) {
            if (log_odds >= 0) {
                add_cube(place);
            } else {
                add_free(place);
            }
            return;
        }
        require_depth(place);
        for (unsigned child = 0; child < 8; ++child) {
            if ((children >> child & 1U) != 0) {
                count_node();
                read_node(place.eighth(child));
            } else {
                add_unseen(place.eighth(child));
            }
        }
    }

    unsigned next_byte() {
        if (at_ == bytes_.size()) {
            fail("the file ends after " + std::to_string(nodes_) + " of " + std::to_string(header_.nodes) +
                 " nodes: expected all of them");
        }
        return static_cast<unsigned char>(bytes_[at_++]);
    }

    void count_node() {
        if (++nodes_ > header_.nodes) {
            fail("more nodes than " + std::to_string(header_.nodes) + ": expected as many as the header's size");
        }
    }

    void require_depth(const Place& parent) const {
        if (parent.depth >= max_depth) {
            fail("a node below level " + std::to_string(max_depth) + ": expected no more levels");
        }
    }

    void add_cube(const Place& place) {
        if (tree_.cubes.size() >= max_pieces) {
            fail("too many occupied leaves: expected at most " + std::to_string(max_pieces));
        }
        OccupiedCube cube;
        cube.side_m = place.cells() * header_.resolution_m;
        for (unsigned axis = 0; axis < 3; ++axis) {
            // Halves and whole numbers are exact; only the product rounds.
            const double middle = place.low[axis] + 0.5 * place.cells() - 0.5 * cells_across;
            cube.center_local_m[axis] = middle * header_.resolution_m;
        }
        tree_.cubes.push_back(cube);
        add_known(place);
    }

    void add_free(const Place& place) {
        tree_.has_free_leaf = true;
        add_known(place);
    }

    void add_known(const Place& place) {
        known_.include(place);
        const std::uint64_t cells = place.cells();
        known_cells_ += cells * cells * cells;
    }

    void add_unseen(const Place& place) {
        if (unseen_.size() < max_pieces) {
            unseen_.push_back(place);
        } else {
            tree_.lists_unseen = false;
        }
    }

    /// Cells `low` to `high` - 1 of the finest level, counted from the middle of the tree.
    [[nodiscard]] CellBlock block_of(const std::array<std::uint32_t, 3>& low,
                                     const std::array<std::uint32_t, 3>& high) const {
        constexpr std::int64_t middle = cells_across / 2;
        CellBlock block{header_.resolution_m, {}, {}};
        for (unsigned axis = 0; axis < 3; ++axis) {
            block.low[axis] = low[axis] - middle;
            block.high[axis] = high[axis] - middle;
        }
        return block;
    }

    /// The known box, and what of it has no leaf.
    void describe_unseen() {
        tree_.known_box = merged_boxes({block_of(known_.low, known_.high)}).front();
        tree_.unseen_share = 1 - static_cast<double>(known_cells_) / known_.volume();
        std::vector<CellBlock> blocks;
        for (const Place& place : unseen_) {
            std::array<std::uint32_t, 3> low = place.low;
            std::array<std::uint32_t, 3> high{};
            bool is_within = true;
            for (unsigned axis = 0; axis < 3; ++axis) {
                high[axis] = std::min(low[axis] + place.cells(), known_.high[axis]);
                low[axis] = std::max(low[axis], known_.low[axis]);
                is_within = is_within && low[axis] < high[axis];
            }
            if (is_within) {
                blocks.push_back(block_of(low, high));
            }
        }
        if (tree_.lists_unseen) {
            tree_.unseen = merged_boxes(std::move(blocks));
        }
    }

    [[noreturn]] void fail(const std::string& message) const { foreign::fail_at(name_, at_, message); }

    std::string_view bytes_;
    const std::string& name_;
    const Header& header_;
    std::size_t at_;
    std::uint64_t nodes_ = 0;
    OccupancyTree tree_;
    CellBounds known_;
    std::uint64_t known_cells_ = 0;  ///< of the finest level, in all leaves
    std::vector<Place> unseen_;      ///< also outside of the known box
};

}  // namespace

std::shared_ptr<const OccupancyTree> read_octomap(const std::filesystem::path& file) {
    return std::make_shared<const OccupancyTree>(parse_octomap(foreign::read(file), file.string()));
}

OccupancyTree parse_octomap(std::string_view bytes, const std::string& name) {
    const Header header = read_header(bytes, name);
    return NodeReader(bytes, name, header).read();
}

}  // namespace downwash
