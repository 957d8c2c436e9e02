#pragma once

// Private to aeromap.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "downwash/effects/sided_factor.hpp"

namespace downwash {

/// K at numbered points: a hash table in one piece, because finding a value has to cost less than evaluating it.
class KnownFactors {
 public:
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] std::size_t memory_bytes() const noexcept { return entries_.capacity() * sizeof(Entry); }

    void clear() noexcept {
        entries_.clear();
        size_ = 0;
    }

    /// The value of a point, from `evaluate()` if it is not known.
    /// @param point below 2^64 - 1
    template <class Evaluate>
    SidedFactor<double> find_or_add(std::uint64_t point, const Evaluate& evaluate) {
        if (2 * size_ >= entries_.size()) {
            grow();
        }
        Entry& entry = entry_of(point);
        if (entry.point != point) {
            entry = {point, evaluate()};
            ++size_;
        }
        return entry.factor;
    }

 private:
    struct Entry {
        std::uint64_t point = nowhere;
        SidedFactor<double> factor{1, 1};
    };
    static constexpr std::uint64_t nowhere = ~std::uint64_t{0};

    /// The entry of a point, or the free one where it belongs.
    [[nodiscard]] Entry& entry_of(std::uint64_t point) {
        constexpr std::uint64_t odd = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio, which spreads neighbours
        const std::size_t mask = entries_.size() - 1;
        for (std::size_t i = static_cast<std::size_t>((point * odd) >> 32U) & mask;; i = (i + 1) & mask) {
            if (entries_[i].point == point || entries_[i].point == nowhere) {
                return entries_[i];
            }
        }
    }

    void grow() {
        constexpr std::size_t first_size = 512;
        std::vector<Entry> before = std::exchange(entries_, std::vector<Entry>());
        entries_.resize(before.empty() ? first_size : 2 * before.size());
        for (const Entry& entry : before) {
            if (entry.point != nowhere) {
                entry_of(entry.point) = entry;
            }
        }
    }

    std::vector<Entry> entries_;  ///< a power of two, at least half of them free
    std::size_t size_ = 0;
};

}  // namespace downwash
