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
                       std::span<const Vector3> places_m)
    : space_(space), transport_(transport), room_m_(room_m) {
    constexpr double around_m = 4;  // all places, for ways around what stands between them
    constexpr double least_edge_m = 0.25;
    constexpr double most_cells = 1 << 17;
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
    rooms_.resize(static_cast<std::size_t>(counts_[0]) * counts_[1] * counts_[2]);
}

std::size_t WaysAround::number_of(const Cell& cell) const noexcept {
    return (static_cast<std::size_t>(cell[2]) * counts_[1] + cell[1]) * counts_[0] + cell[0];
}

auto WaysAround::cell_at(std::size_t number) const noexcept -> Cell {
    const auto rest = static_cast<int>(number) / counts_[0];
    return {static_cast<int>(number) % counts_[0], rest % counts_[1], rest / counts_[1]};
}

/// The cell in which a place is or, outside the grid, the nearest one.
auto WaysAround::cell_of(const Vector3& at_m) const noexcept -> Cell {
    Cell cell{};
    for (std::size_t i = 0; i < 3; ++i) {
        cell[i] = std::clamp(static_cast<int>(std::floor((at_m[i] - low_m_[i]) / edge_m_)), 0, counts_[i] - 1);
    }
    return cell;
}

Vector3 WaysAround::centre_m(const Cell& cell) const noexcept {
    return low_m_ + edge_m_ * Vector3{cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5};
}

bool WaysAround::is_within(const Cell& cell) const noexcept {
    return cell[0] >= 0 && cell[1] >= 0 && cell[2] >= 0 && cell[0] < counts_[0] && cell[1] < counts_[1] &&
           cell[2] < counts_[2];
}

auto WaysAround::room_at(const Cell& cell) -> Room {
    Room& room = rooms_[number_of(cell)];
    if (room == Room::unknown) {
        constexpr int headings = 8;
        room = Room::none;
        SpaceConfiguration at = transport_;
        std::ranges::copy(centre_m(cell), at.begin());
        for (int i = 0; i < headings && room != Room::wide; ++i) {
            at[space::yaw] = std::numbers::pi * (2.0 * i / headings - 1);
            if (space_.has_room(at, room_m_)) {
                room = Room::wide;
            } else if (room == Room::none && space_.is_valid(at)) {
                room = Room::tight;
            }
        }
    }
    return room;
}

/// What a way through a cell counts for each metre.
double WaysAround::weight(const Cell& cell) {
    constexpr double of_tight = 3;
    const Room room = room_at(cell);
    return room == Room::wide ? 1 : room == Room::tight ? of_tight : infinite;
}

/// The weighted length of a straight way.
double WaysAround::straight_length_m(const Vector3& from_m, const Vector3& to_m) {
    const double length_m = distance_m(from_m, to_m);
    const int pieces = static_cast<int>(std::ceil(2 * length_m / edge_m_));
    double sum_m = 0;
    for (int i = 0; i < pieces && std::isfinite(sum_m); ++i) {
        sum_m += length_m / pieces * weight(cell_of(from_m + (i + 0.5) / pieces * (to_m - from_m)));
    }
    return sum_m;
}

/// The nearest open cell of a place; nothing where none is near.
std::optional<std::size_t> WaysAround::entry_of(const Vector3& place_m) {
    constexpr int most_rings = 4;
    const Cell middle = cell_of(place_m);
    for (int ring = 0; ring <= most_rings; ++ring) {
        std::pair<double, std::size_t> nearest{infinite, 0};
        for (int z = -ring; z <= ring; ++z) {
            for (int y = -ring; y <= ring; ++y) {
                const bool is_side = std::max(std::abs(z), std::abs(y)) == ring;
                for (int x = -ring; x <= ring; x += is_side || ring == 0 ? 1 : 2 * ring) {
                    const Cell cell{middle[0] + x, middle[1] + y, middle[2] + z};
                    if (is_within(cell) && room_at(cell) != Room::none) {
                        nearest = std::min(nearest, {distance_m(place_m, centre_m(cell)), number_of(cell)});
                    }
                }
            }
        }
        if (std::isfinite(nearest.first)) {
            return nearest.second;
        }
    }
    return std::nullopt;
}

void WaysAround::search(std::span<const Vector3> from_m) {
    lengths_m_.assign(rooms_.size(), infinite);
    befores_.resize(rooms_.size());
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
        const auto [length_m, number] = open.top();
        open.pop();
        if (length_m > lengths_m_[number]) {
            continue;
        }
        const Cell cell = cell_at(number);
        for (int z = -1; z <= 1; ++z) {
            for (int y = -1; y <= 1; ++y) {
                for (int x = -1; x <= 1; ++x) {
                    const Cell next{cell[0] + x, cell[1] + y, cell[2] + z};
                    if ((x != 0 || y != 0 || z != 0) && is_within(next) && room_at(next) != Room::none) {
                        const double step_m = edge_m_ * std::sqrt(x * x + y * y + z * z);
                        reach(number_of(next), length_m + 0.5 * step_m * (weight(cell) + weight(next)), number);
                    }
                }
            }
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
    std::ranges::transform(way, std::back_inserter(way_m), [&](std::size_t cell) { return centre_m(cell_at(cell)); });
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
