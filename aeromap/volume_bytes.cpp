#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <type_traits>
#include <utility>

#include "downwash/aeromap/volume_bricks.hpp"
#include "downwash/aeromap/volume_map.hpp"

// A volume as bytes: the format, the counts of cells along x, lateral and z and of the bricks that follow; then of
// every brick, in their order, its number, whether it is calm, and if it is not, its cells. Of every cell its kind, the
// margin of a box, its polynomials, the halves of a halving, lower first. So bytes do not depend on who asked first.

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

bool take_count(std::string_view& bytes, std::uint64_t& count) {
    return take(bytes, 1, &count);
}

/// Incremented if volumes get other values or another layout.
constexpr std::uint64_t volume_format = 2;
/// More halvings behind each other than any box has.
constexpr int max_depth = 32;

std::size_t polynomials_of(VolumeNodeKind kind) {
    return kind == VolumeNodeKind::both ? 2 : kind == VolumeNodeKind::below || kind == VolumeNodeKind::above ? 1 : 0;
}

void append_node(std::string& bytes, const VolumeNode& node) {
    const VolumeNodeKind kind = kind_of(node);
    append(bytes, &kind, 1);
    if (is_halving(kind)) {
        append_node(bytes, node.halves[0]);
        append_node(bytes, node.halves[1]);
    } else if (kind != VolumeNodeKind::unknown) {
        append(bytes, &node.margin_m, 1);
        append(bytes, node.polynomials, polynomials_of(kind));
    }
}

bool is_finite(const Triquadratic& polynomial) {
    return std::all_of(polynomial.begin(), polynomial.end(), [](float value) { return std::isfinite(value); });
}

/// False where the bytes are no node.
bool take_node(std::string_view& bytes, VolumeNode& node, OwnedBrick& brick, int depth) {
    VolumeNode read;
    if (depth > max_depth || !take(bytes, 1, &read.kind) || read.kind > VolumeNodeKind::unknown) {
        return false;
    }
    if (is_halving(read.kind)) {
        read.halves = brick.new_halves();
        if (!take_node(bytes, read.halves[0], brick, depth + 1) ||
            !take_node(bytes, read.halves[1], brick, depth + 1)) {
            return false;
        }
    } else if (read.kind != VolumeNodeKind::unknown) {
        std::array<Triquadratic, 2> polynomials{};
        const std::size_t count = polynomials_of(read.kind);
        if (!take(bytes, 1, &read.margin_m) || !std::isfinite(read.margin_m) ||
            !take(bytes, count, polynomials.data()) || !is_finite(polynomials[0]) || !is_finite(polynomials[1])) {
            return false;
        }
        read.polynomials = count == 2   ? brick.keep(polynomials[0], polynomials[1])
                           : count == 1 ? brick.keep(polynomials[0])
                                        : nullptr;
    }
    node = read;
    return true;
}

std::unique_ptr<OwnedBrick> take_brick(std::string_view& bytes) {
    auto brick = std::make_unique<OwnedBrick>();
    for (VolumeNode& cell : brick->cells) {
        if (!take_node(bytes, cell, *brick, 0)) {
            return nullptr;
        }
    }
    return brick;
}

std::string bytes_of(const VolumeBricks& bricks, const std::vector<std::size_t>& numbers) {
    std::string bytes;
    append_count(bytes, volume_format);
    for (const std::uint32_t cells : bricks.grid().cells) {
        append_count(bytes, cells);
    }
    append_count(bytes, numbers.size());
    for (const std::size_t number : numbers) {
        const OwnedBrick* const brick = bricks.owned(number);
        append_count(bytes, number);
        append_count(bytes, brick == nullptr ? 1 : 0);
        if (brick != nullptr) {
            const std::scoped_lock lock(brick->mutex);
            for (const VolumeNode& cell : brick->cells) {
                append_node(bytes, cell);
            }
        }
    }
    return bytes;
}

struct NumberedBrick {
    std::size_t number;
    std::unique_ptr<OwnedBrick> brick;  ///< null: calm
};

/// Evaluates again in some bricks. This notices changes of models or integration without a new format.
bool agree_with_effect(const VolumeBricks& bricks, const std::vector<NumberedBrick>& read) {
    constexpr std::size_t samples = 64;
    const std::size_t stride = std::max<std::size_t>(1, read.size() / samples);
    for (std::size_t n = 0; n < read.size(); n += stride) {
        if (read[n].brick != nullptr &&
            !agrees_with_effect(*bricks.effect(), bricks.grid(), read[n].number, *read[n].brick)) {
            return false;
        }
    }
    return true;
}

}  // namespace

std::string VolumeMap::to_bytes() const {
    return bytes_of(*bricks_, bricks_->made());
}

std::string VolumeMap::take_new_bytes() const {
    const std::vector<std::size_t> numbers = bricks_->take_new();
    return numbers.empty() ? std::string() : bytes_of(*bricks_, numbers);
}

bool VolumeMap::add_bytes(std::string_view bytes) {
    std::uint64_t format = 0;
    if (!take_count(bytes, format) || format != volume_format) {
        return false;
    }
    for (const std::uint32_t cells : bricks_->grid().cells) {
        std::uint64_t theirs = 0;
        if (!take_count(bytes, theirs) || theirs != cells) {
            return false;
        }
    }
    std::uint64_t count = 0;
    if (!take_count(bytes, count) || count > bricks_->grid().brick_count()) {
        return false;
    }
    std::vector<NumberedBrick> read;
    for (; count > 0; --count) {
        std::uint64_t number = 0;
        std::uint64_t is_calm = 0;
        if (!take_count(bytes, number) || !take_count(bytes, is_calm) || number >= bricks_->grid().brick_count() ||
            (!read.empty() && number <= read.back().number) || is_calm > 1) {
            return false;
        }
        read.push_back({number, is_calm == 1 ? nullptr : take_brick(bytes)});
        if (is_calm == 0 && read.back().brick == nullptr) {
            return false;
        }
    }
    if (!bytes.empty() || !agree_with_effect(*bricks_, read)) {
        return false;
    }
    for (NumberedBrick& one : read) {
        bricks_->adopt(one.number, std::move(one.brick));
    }
    return true;
}

}  // namespace downwash
