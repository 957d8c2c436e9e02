#include "downwash/search/ways_around.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

namespace downwash::planning {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

double distance_m(const Vector3& a, const Vector3& b) {
    const Vector3 way = b - a;
    return std::sqrt(dot(way, way));
}

}  // namespace

WaysAround::WaysAround(const SpaceSearchSpace& space, const SpaceConfiguration& transport, double room_m,
                       std::span<const Vector3> places_m, double most_cells)
    : space_(space), transport_(transport), room_m_(room_m) {
    constexpr double around_m = 4;  // all places, for ways around what stands between them
    constexpr double least_edge_m = 0.25;
    Vector3 size_m{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto of_axis = [i](const Vector3& a, const Vector3& b) { return a[i] < b[i]; };
        const auto [least, most] = std::ranges::minmax_element(places_m, of_axis);
        low_m_[i] = std::max(space.axes()[i].low, (*least)[i] - around_m);
        size_m[i] = std::min(space.axes()[i].high, (*most)[i] + around_m) - low_m_[i];
    }
    edge_m_ = std::max(least_edge_m, std::cbrt(size_m[0] * size_m[1] * size_m[2] / most_cells));
    for (std::size_t i = 0; i < 3; ++i) {
        counts_[i] = std::max(1, static_cast<int>(size_m[i] / edge_m_));
        low_m_[i] += 0.5 * (size_m[i] - counts_[i] * edge_m_);
    }
    weights_.assign(number_of({counts_[0], counts_[1], counts_[2]}) + 1, infinite);
    befores_.resize(weights_.size());
    for (int z = 0; z < counts_[2]; ++z) {
        for (int y = 0; y < counts_[1]; ++y) {
            std::fill_n(weights_.begin() + static_cast<std::ptrdiff_t>(number_of({0, y, z})), counts_[0], 0.0);
        }
    }
    const auto origin = static_cast<std::ptrdiff_t>(number_of({0, 0, 0}));
    for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                if (x != 0 || y != 0 || z != 0) {
                    steps_.push_back({static_cast<std::ptrdiff_t>(number_of({x, y, z})) - origin,
                                      edge_m_ * std::sqrt(x * x + y * y + z * z)});
                }
            }
        }
    }
}

/// @param cell from -1 to its count in each direction
std::size_t WaysAround::number_of(const std::array<int, 3>& cell) const noexcept {
    const auto size = [&](std::size_t i) { return static_cast<std::size_t>(counts_[i]) + 2; };
    const auto at = [&](std::size_t i) { return static_cast<std::size_t>(cell[i]) + 1; };
    return (at(2) * size(1) + at(1)) * size(0) + at(0);
}

/// The cell in which a place is or, outside the grid, the nearest one.
std::array<int, 3> WaysAround::cell_of(const Vector3& at_m) const noexcept {
    std::array<int, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) {
        cell[i] = std::clamp(static_cast<int>(std::floor((at_m[i] - low_m_[i]) / edge_m_)), 0, counts_[i] - 1);
    }
    return cell;
}

Vector3 WaysAround::centre_m(std::size_t cell) const noexcept {
    Vector3 centre_m = low_m_;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto size = static_cast<std::size_t>(counts_[i]) + 2;
        centre_m[i] += edge_m_ * (static_cast<double>(cell % size) - 0.5);
        cell /= size;
    }
    return centre_m;
}

double WaysAround::weight_at(const Vector3& at_m) const {
    constexpr double of_tight = 3;
    constexpr int headings = 8;
    double weight = infinite;
    SpaceConfiguration at = transport_;
    std::ranges::copy(at_m, at.begin());
    for (int i = 0; i < headings; ++i) {
        at[space::yaw] = std::numbers::pi * (2.0 * i / headings - 1);
        if (space_.has_room(at, room_m_)) {
            return 1;
        }
        if (std::isinf(weight) && space_.is_valid(at)) {
            weight = of_tight;
        }
    }
    return weight;
}

/// The weighted length of a straight way.
double WaysAround::straight_length_m(const Vector3& from_m, const Vector3& to_m) {
    const double length_m = distance_m(from_m, to_m);
    const int pieces = static_cast<int>(std::ceil(2 * length_m / edge_m_));
    double sum_m = 0;
    for (int i = 0; i < pieces && std::isfinite(sum_m); ++i) {
        const Vector3 at_m = from_m + (i + 0.5) / pieces * (to_m - from_m);
        sum_m += length_m / pieces * weight(number_of(cell_of(at_m)));
    }
    return sum_m;
}

/// The nearest open cell of a place; nothing where none is near.
std::optional<std::size_t> WaysAround::entry_of(const Vector3& place_m) {
    constexpr int most_rings = 4;
    const std::array<int, 3> middle = cell_of(place_m);
    std::pair<double, std::size_t> nearest{infinite, 0};
    for (int ring = 0; ring <= most_rings && std::isinf(nearest.first); ++ring) {
        std::array<int, 3> low{}, high{};
        for (std::size_t i = 0; i < 3; ++i) {
            low[i] = std::max(middle[i] - ring, 0);
            high[i] = std::min(middle[i] + ring, counts_[i] - 1);
        }
        for (int z = low[2]; z <= high[2]; ++z) {
            for (int y = low[1]; y <= high[1]; ++y) {
                for (int x = low[0]; x <= high[0]; ++x) {
                    const std::size_t cell = number_of({x, y, z});
                    if (std::isfinite(weight(cell))) {
                        nearest = std::min(nearest, {distance_m(place_m, centre_m(cell)), cell});
                    }
                }
            }
        }
    }
    return std::isfinite(nearest.first) ? std::optional(nearest.second) : std::nullopt;
}

void WaysAround::search(std::span<const Vector3> from_m) {
    lengths_m_.assign(weights_.size(), infinite);
    using Open = std::pair<double, std::size_t>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    const auto reach = [&](std::size_t cell, double length_m, std::size_t before) {
        if (length_m < lengths_m_[cell]) {
            lengths_m_[cell] = length_m;
            befores_[cell] = before;
            open.emplace(length_m, cell);
        }
    };
    for (const Vector3& place_m : from_m) {
        if (const std::optional<std::size_t> entry = entry_of(place_m)) {
            reach(*entry, 0, *entry);
        }
    }
    while (!open.empty()) {
        const auto [length_m, cell] = open.top();
        open.pop();
        if (length_m > lengths_m_[cell]) {
            continue;
        }
        const double half_weight = 0.5 * weight(cell);
        for (const Step& step : steps_) {
            const std::size_t next = cell + static_cast<std::size_t>(step.number);
            reach(next, length_m + step.length_m * (half_weight + 0.5 * weight(next)), cell);
        }
    }
}

/// The cells of the way of the last search from whose one to the other straight motions take least. Through tight cells
/// they count longer, as ways do.
auto WaysAround::corners_to(std::size_t end) -> Corners {
    std::vector<std::size_t> way{end};
    while (befores_[way.back()] != way.back()) {
        way.push_back(befores_[way.back()]);
    }
    std::vector<Vector3> way_m;
    std::ranges::transform(way, std::back_inserter(way_m), [&](std::size_t cell) { return centre_m(cell); });
    const auto duration_s = [&](std::size_t from, std::size_t to) {
        const double weighted_m =
            from == to + 1 ? lengths_m_[way[to]] - lengths_m_[way[from]] : straight_length_m(way_m[from], way_m[to]);
        SpaceConfiguration begin{}, finish{};
        std::ranges::copy(way_m[from], begin.begin());
        std::ranges::copy(way_m[to], finish.begin());
        return space_.duration_s(begin, finish) * weighted_m / distance_m(way_m[from], way_m[to]);
    };
    // From the end to the beginning: the least from each on, and where its first motion leads.
    std::vector<std::pair<double, std::size_t>> rest(way.size(), {infinite, 0});
    rest.front() = {0, 0};
    for (std::size_t at = 1; at < way.size(); ++at) {
        for (std::size_t to = 0; to < at; ++to) {
            rest[at] = std::min(rest[at], {duration_s(at, to) + rest[to].first, to});
        }
    }
    Corners corners;
    for (std::size_t at = rest.back().second; at != 0; at = rest[at].second) {
        corners.push_back(way_m[at]);
    }
    return corners;
}

auto WaysAround::from(std::span<const Vector3> from_m, std::span<const std::vector<Vector3>> to_m)
    -> std::vector<std::optional<Corners>> {
    search(from_m);
    std::vector<std::optional<Corners>> ways;
    for (const std::vector<Vector3>& ends : to_m) {
        std::pair<double, std::size_t> nearest{infinite, 0};
        for (const Vector3& end_m : ends) {
            if (const std::optional<std::size_t> entry = entry_of(end_m)) {
                nearest = std::min(nearest, {lengths_m_[*entry], *entry});
            }
        }
        ways.push_back(std::isfinite(nearest.first) ? std::optional(corners_to(nearest.second)) : std::nullopt);
    }
    return ways;
}

}  // namespace downwash::planning
