#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "downwash/aeromap/volume_bricks.hpp"
#include "downwash/aeromap/volume_map.hpp"

// A volume as bytes: the counts of cells along x, lateral and z and of the bricks that follow; then of every brick, in
// their order, its number, whether it is calm, and if it is not, the counts of its nodes and polynomials, its cells,
// nodes and polynomials.

namespace downwash {
namespace {

template <class Element>
void append(std::string& bytes, const Element* elements, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Element>);
    bytes.append(reinterpret_cast<const char*>(elements), count * sizeof(Element));
}

void append_count(std::string& bytes, std::uint64_t count) {
    append(bytes, &count, 1);
}

/// Moves so many elements from the front of the bytes to a place; false when there are less.
template <class Element>
bool take(std::string_view& bytes, std::size_t count, Element* to) {
    if (count > bytes.size() / sizeof(Element)) {
        return false;
    }
    if (count > 0) {
        std::memcpy(to, bytes.data(), count * sizeof(Element));
    }
    bytes.remove_prefix(count * sizeof(Element));
    return true;
}

template <class Element>
bool take(std::string_view& bytes, std::uint64_t count, std::vector<Element>& to) {
    if (count > bytes.size() / sizeof(Element)) {
        return false;
    }
    to.resize(count);
    return take(bytes, to.size(), to.data());
}

bool take_count(std::string_view& bytes, std::uint64_t& count) {
    return take(bytes, 1, &count);
}

/// Whether look-ups end, stay within the brick and find numbers there.
bool is_sound(const OwnedBrick& brick) {
    const auto is_good = [&brick](const VolumeNode& node, std::size_t behind) {
        switch (node.kind()) {
            case VolumeNodeKind::calm:
            case VolumeNodeKind::direct:
                return std::isfinite(node.margin_m);
            case VolumeNodeKind::below:
            case VolumeNodeKind::above:
                return std::isfinite(node.margin_m) && node.index() < brick.polynomials_size;
            case VolumeNodeKind::both:
                return std::isfinite(node.margin_m) && node.index() + 1U < brick.polynomials_size;
            default:  // a halving: its halves stand behind it
                return node.index() >= behind && node.index() + 1U < brick.nodes_size;
        }
    };
    for (const VolumeNode& cell : brick.cells) {
        if (!is_good(cell, 0)) {
            return false;
        }
    }
    for (std::size_t i = 0; i < brick.nodes_size; ++i) {
        if (!is_good(brick.nodes[i], i + 1)) {
            return false;
        }
    }
    return std::all_of(brick.all_polynomials.begin(), brick.all_polynomials.end(), [](const Triquadratic& polynomial) {
        return std::all_of(polynomial.begin(), polynomial.end(), [](float value) { return std::isfinite(value); });
    });
}

std::shared_ptr<const VolumeBrick> take_brick(std::string_view& bytes) {
    auto brick = std::make_shared<OwnedBrick>();
    std::uint64_t nodes = 0;
    std::uint64_t polynomials = 0;
    constexpr std::uint64_t largest = 1U << 29U;  // what an index may be
    if (!take_count(bytes, nodes) || !take_count(bytes, polynomials) || nodes > largest || polynomials > largest ||
        !take(bytes, VolumeBrick::cell_count, &brick->cells[0]) || !take(bytes, nodes, brick->all_nodes) ||
        !take(bytes, polynomials, brick->all_polynomials)) {
        return nullptr;
    }
    brick->seal();
    return is_sound(*brick) ? brick : nullptr;
}

std::string bytes_of(const VolumeBricks& bricks, const std::vector<std::size_t>& numbers) {
    static_assert(sizeof(VolumeNode) == 8, "no bytes between the members");
    std::string bytes;
    for (const std::uint32_t cells : bricks.grid().cells) {
        append_count(bytes, cells);
    }
    append_count(bytes, numbers.size());
    for (const std::size_t number : numbers) {
        const VolumeBrick& brick = *bricks.store().find(number);
        const bool is_calm = &brick == bricks.calm().get();
        append_count(bytes, number);
        append_count(bytes, is_calm ? 1 : 0);
        if (!is_calm) {
            append_count(bytes, brick.nodes_size);
            append_count(bytes, brick.polynomials_size);
            append(bytes, &brick.cells[0], VolumeBrick::cell_count);
            append(bytes, brick.nodes, brick.nodes_size);
            append(bytes, brick.polynomials, brick.polynomials_size);
        }
    }
    return bytes;
}

struct NumberedBrick {
    std::size_t number;
    std::shared_ptr<const VolumeBrick> brick;
};

/// Evaluates again at the low corners of some bricks, which are samples of the first cell or of its first half. This
/// notices changes of models or integration without a new map_format_version.
bool agree_with_effect(const VolumeBricks& bricks, const std::vector<NumberedBrick>& read) {
    constexpr std::size_t samples = 64;
    const VolumeGrid& grid = bricks.grid();
    const std::size_t stride = std::max<std::size_t>(1, read.size() / samples);
    for (std::size_t n = 0; n < read.size(); n += stride) {
        const VolumeBrick& brick = *read[n].brick;
        VolumeNode node = brick.cells[0];
        while (node.kind() <= VolumeNodeKind::halved_z) {
            node = brick.nodes[node.index()];
        }
        if (node.kind() == VolumeNodeKind::calm || node.kind() == VolumeNodeKind::direct) {
            continue;
        }
        const auto at = grid.brick_at(read[n].number);
        Vector3 corner_m{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            corner_m[axis] =
                grid.low_m[axis] + static_cast<double>(at[axis] * VolumeBrick::side_cells) * grid.cell_m[axis];
        }
        const double now =
            direct_value(*bricks.effect(), grid.frame.to_world(corner_m[0], corner_m[1], corner_m[2])).all;
        if (brick.polynomials[node.index()][0] != static_cast<float>(now)) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::string VolumeMap::to_bytes() const {
    return bytes_of(*bricks_, bricks_->store().made());
}

std::string VolumeMap::take_new_bytes() const {
    const std::vector<std::size_t> numbers = bricks_->store().take_new();
    return numbers.empty() ? std::string() : bytes_of(*bricks_, numbers);
}

bool VolumeMap::add_bytes(std::string_view bytes) {
    for (const std::uint32_t cells : bricks_->grid().cells) {
        std::uint64_t theirs = 0;
        if (!take_count(bytes, theirs) || theirs != cells) {
            return false;
        }
    }
    std::uint64_t count = 0;
    if (!take_count(bytes, count) || count > bricks_->store().size()) {
        return false;
    }
    std::vector<NumberedBrick> read;
    for (; count > 0; --count) {
        std::uint64_t number = 0;
        std::uint64_t is_calm = 0;
        if (!take_count(bytes, number) || !take_count(bytes, is_calm) || number >= bricks_->store().size() ||
            (!read.empty() && number <= read.back().number) || is_calm > 1) {
            return false;
        }
        read.push_back({number, is_calm == 1 ? bricks_->calm() : take_brick(bytes)});
        if (read.back().brick == nullptr) {
            return false;
        }
    }
    if (!bytes.empty() || !agree_with_effect(*bricks_, read)) {
        return false;
    }
    for (NumberedBrick& one : read) {
        bricks_->store().put(one.number, std::move(one.brick));
    }
    return true;
}

}  // namespace downwash
