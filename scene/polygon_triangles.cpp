#include "downwash/scene/polygon_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "downwash/scene/bounding_box.hpp"

namespace downwash {
namespace {

/// Greatest distance of a corner from its face's plane, over the face's size.
constexpr double max_bend = 0.05;
/// Faces that are bent by no more are plane: rounding.
constexpr double plane_bend = 1e-9;
/// Corners that lie this near to a line, in sizes of the face, lie on it.
constexpr double line_width = 1e-9;
/// Edges that cross by no more, in sizes of the face, touch: the digits of files and single precision.
constexpr double touching_width = 1e-6;
/// Areas below this, in squares of the face's size, are rounding.
constexpr double no_area = 1e-13;

/// A point of the face's plane.
struct Point {
    double x, y;
    friend bool operator==(const Point&, const Point&) = default;
};

/// Twice the area of a triangle, above 0 when it turns to the left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double length(const Vector3& v) {
    return std::sqrt(dot(v, v));
}

/// The corner with which the face begins however it is written: the lowest, by what follows if there are several.
std::size_t first_of(std::span<const Vector3> corners) {
    constexpr std::size_t max_compared = 8;
    const std::size_t count = corners.size();
    const auto at = [&](std::size_t i) -> const Vector3& { return corners[i % count]; };
    std::size_t first = 0;
    for (std::size_t i = 1; i < count; ++i) {
        for (std::size_t k = 0; k < max_compared; ++k) {
            if (at(i + k) != at(first + k)) {
                first = at(i + k) < at(first + k) ? i : first;
                break;
            }
        }
    }
    return first;
}

bool are_on_a_line(std::span<const Vector3> corners, double size) {
    const auto from_first = [&](const Vector3& p) { return length(p - corners[0]); };
    const Vector3 far = *std::max_element(corners.begin(), corners.end(), [&](const Vector3& a, const Vector3& b) {
        return from_first(a) < from_first(b);
    });
    const double span = from_first(far);
    return std::all_of(corners.begin(), corners.end(), [&](const Vector3& p) {
        return length(cross(far - corners[0], p - corners[0])) <= line_width * size * span;
    });
}

/// How often the steps of a closed sequence change between up and down.
template <class Coordinate>
std::size_t changes_of_direction(const std::vector<Point>& outline, Coordinate of) {
    std::size_t changes = 0;
    double first = 0;
    double last = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const double step = of(outline[(i + 1) % outline.size()]) - of(outline[i]);
        if (step != 0) {
            changes += last * step < 0 ? 1 : 0;
            first = first == 0 ? (step > 0 ? 1 : -1) : first;
            last = step > 0 ? 1 : -1;
        }
    }
    return changes + (last * first < 0 ? 1 : 0);
}

/// Whether an outline turns to the left everywhere, once around. @param rounding area
bool is_convex(std::vector<Point> outline, double rounding) {
    outline.erase(std::unique(outline.begin(), outline.end()), outline.end());
    while (outline.size() > 1 && outline.front() == outline.back()) {
        outline.pop_back();
    }
    const std::size_t count = outline.size();
    for (std::size_t i = 0; i < count; ++i) {
        if (turn(outline[i], outline[(i + 1) % count], outline[(i + 2) % count]) < -rounding) {
            return false;
        }
    }
    // Spikes turn by nothing, so that what a fan covers tells of them.
    double backwards = 0;
    for (std::size_t i = 1; i + 1 < count; ++i) {
        backwards -= std::min(0., turn(outline[0], outline[i], outline[i + 1]));
    }
    return backwards <= static_cast<double>(count) * rounding &&
           changes_of_direction(outline, [](const Point& p) { return p.x; }) <= 2 &&
           changes_of_direction(outline, [](const Point& p) { return p.y; }) <= 2;
}

/// Whether the ends of one edge lie on both sides of the line through another, by more than a distance.
bool are_parted(const Point& a, const Point& b, const Point& c, const Point& d, double distance) {
    const double least = distance * std::hypot(b.x - a.x, b.y - a.y);
    const double of_c = turn(a, b, c);
    const double of_d = turn(a, b, d);
    return (of_c > least && of_d < -least) || (of_c < -least && of_d > least);
}

/// Counts comparisons of corners and edges up to a limit.
class Comparisons {
 public:
    explicit Comparisons(std::size_t max) : max_(max) {}

    void count(std::size_t more = 1) { count_ += more; }
    [[nodiscard]] std::size_t number() const { return count_; }
    [[nodiscard]] bool are_too_many() const { return count_ > max_; }

 private:
    std::size_t max_;
    std::size_t count_ = 0;
};

/// Whether two edges cross; those that only touch do not. Ends early when there are too many comparisons.
/// @param distance by which ends have to lie beyond
bool crosses_itself(const std::vector<Point>& outline, double distance, Comparisons& comparisons) {
    struct Side {
        Point a, b;
        double x_low, x_high, y_low, y_high;
    };
    std::vector<Side> sides;
    sides.reserve(outline.size());
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Point& a = outline[i];
        const Point& b = outline[(i + 1) % outline.size()];
        sides.push_back({a, b, std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y)});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) { return s.x_low < t.x_low; });
    for (auto s = sides.begin(); s != sides.end() && !comparisons.are_too_many(); ++s) {
        for (auto t = s + 1; t != sides.end() && t->x_low <= s->x_high; ++t) {
            comparisons.count();
            if (t->y_high >= s->y_low && t->y_low <= s->y_high && are_parted(s->a, s->b, t->a, t->b, distance) &&
                are_parted(t->a, t->b, s->a, s->b, distance)) {
                return true;
            }
        }
    }
    return false;
}

/// Clips ears off an outline that turns to the left on the whole.
class EarClipper {
 public:
    /// @param size of the face
    EarClipper(const std::vector<Point>& outline, double size, Comparisons& comparisons)
        : outline_(outline),
          comparisons_(comparisons),
          touching_(touching_width * size),
          touching_area_(touching_width * size * size),
          rounding_(no_area * size * size),
          before_(outline.size()),
          after_(outline.size()) {
        const std::size_t count = outline.size();
        for (std::size_t i = 0; i < count; ++i) {
            before_[i] = (i + count - 1) % count;
            after_[i] = (i + 1) % count;
        }
        find_twins();
        is_watched_.resize(count);
        is_spike_.resize(count);
        for (std::size_t i = 0; i < count; ++i) {
            watch(i);
        }
    }

    /// @return nothing when what is left has no ear, as it overlaps itself, or when it took too long to find one
    std::optional<std::vector<std::array<std::size_t, 3>>> triangles() {
        std::vector<std::array<std::size_t, 3>> all;
        all.reserve(outline_.size() - 2);
        std::size_t at = 0;
        for (std::size_t left = outline_.size(); left > 2; --left) {
            const std::optional<std::size_t> tip = next_tip(at, left);
            if (!tip || comparisons_.are_too_many()) {
                return std::nullopt;
            }
            const std::size_t a = before_[*tip];
            const std::size_t c = after_[*tip];
            all.push_back({a, *tip, c});
            after_[a] = c;
            before_[c] = a;
            before_[*tip] = after_[*tip] = *tip;  // gone
            set_spike(*tip, false);
            watch(a);
            watch(c);
            at = a;  // narrow passages have their next ear here
        }
        return all;
    }

 private:
    /// Which points of the outline are where others are, too.
    void find_twins() {
        std::vector<std::size_t> order(outline_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        const auto key = [&](std::size_t i) { return std::pair(outline_[i].x, outline_[i].y); };
        std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return key(i) < key(k); });
        has_twin_.resize(outline_.size());
        for (std::size_t i = 1; i < order.size(); ++i) {
            if (key(order[i]) == key(order[i - 1])) {
                has_twin_[order[i]] = has_twin_[order[i - 1]] = true;
            }
        }
    }

    [[nodiscard]] double turn_at(std::size_t i) const {
        return turn(outline_[before_[i]], outline_[i], outline_[after_[i]]);
    }
    [[nodiscard]] bool is_gone(std::size_t i) const { return after_[i] == i; }

    void set_spike(std::size_t i, bool is_spike) {
        spikes_ += is_spike ? 1 : 0;
        spikes_ -= is_spike_[i] ? 1 : 0;
        is_spike_[i] = is_spike;
    }

    /// Keeps a point in mind that may lie in the way of an ear, one that turns to the right or touches another, and the
    /// tips of spikes.
    void watch(std::size_t i) {
        set_spike(i, is_flat(i, rounding_) && turns_back(i));
        const bool may_block = has_twin_[i] || turn_at(i) <= rounding_;
        if (may_block && !is_watched_[i]) {
            watched_.push_back(i);
        }
        is_watched_[i] = may_block;
    }

    /// Where other points may not be if a corner is to be an ear.
    enum class Margin {
        wide,    ///< in the ear, or so near that they touch it
        closed,  ///< in the ear or on its edges
        open,    ///< in the ear
    };

    /// The next point to clip, from `at` on: the tip of a spike, else an ear with the widest margin that there is, else
    /// a corner that lies on a line or about on it.
    std::optional<std::size_t> next_tip(std::size_t at, std::size_t left) {
        comparisons_.count(watched_.size());
        std::erase_if(watched_, [&](std::size_t i) {
            const bool is_over = is_gone(i) || !is_watched_[i];
            is_watched_[i] = is_watched_[i] && !is_over;
            return is_over;
        });
        if (left == 3) {
            return turn_at(at) >= -touching_area_ ? std::optional(at) : std::nullopt;
        }
        const auto first = [&](const auto& is_wanted) -> std::optional<std::size_t> {
            std::size_t i = at;
            for (std::size_t seen = 0; seen < left; ++seen, i = after_[i]) {
                comparisons_.count();
                if (is_wanted(i)) {
                    return i;
                }
            }
            return std::nullopt;
        };
        const auto ear_with = [&](Margin margin) {
            return first([this, margin](std::size_t i) { return is_ear(i, margin); });
        };
        auto tip = spikes_ > 0 ? first([this](std::size_t i) { return is_spike_[i]; }) : std::nullopt;
        tip = tip ? tip : ear_with(Margin::wide);
        tip = tip ? tip : ear_with(Margin::closed);
        tip = tip ? tip : first([this](std::size_t i) { return is_flat(i, rounding_); });
        tip = tip ? tip : ear_with(Margin::open);
        return tip ? tip : first([this](std::size_t i) { return is_flat(i, touching_area_); });
    }

    [[nodiscard]] bool is_flat(std::size_t i, double area) const { return std::abs(turn_at(i)) <= area; }
    /// Whether the outline goes back from a flat point the way it came, or stays there.
    [[nodiscard]] bool turns_back(std::size_t i) const {
        const Point& a = outline_[before_[i]];
        const Point& b = outline_[i];
        const Point& c = outline_[after_[i]];
        return (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) >= 0;
    }

    [[nodiscard]] bool is_ear(std::size_t tip, Margin margin) {
        if (turn_at(tip) <= rounding_ || comparisons_.are_too_many()) {
            return false;
        }
        Ear ear{{before_[tip], tip, after_[tip]}, {}, margin};
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& a = outline_[ear.corners[k]];
            const Point& b = outline_[ear.corners[(k + 1) % 3]];
            ear.least_turn[k] = margin == Margin::wide     ? -touching_ * std::hypot(b.x - a.x, b.y - a.y)
                                : margin == Margin::closed ? -rounding_
                                                           : rounding_;
        }
        return std::none_of(watched_.begin(), watched_.end(), [&](std::size_t i) {
            comparisons_.count();
            return is_in_the_way(i, ear);
        });
    }

    struct Ear {
        std::array<std::size_t, 3> corners;
        std::array<double, 3> least_turn;  ///< of points that are in the way, seen along each edge
        Margin margin;
    };

    [[nodiscard]] bool is_in_the_way(std::size_t i, const Ear& ear) const {
        if (i == ear.corners[0] || i == ear.corners[1] || i == ear.corners[2]) {
            return false;
        }
        const Point& p = outline_[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& corner = outline_[ear.corners[k]];
            const Point& next = outline_[ear.corners[(k + 1) % 3]];
            const Point& last = outline_[ear.corners[(k + 2) % 3]];
            if (p == corner) {  // in the way if its outline goes on into the ear
                return ear.margin != Margin::open && (lies_between(corner, next, last, outline_[before_[i]]) ||
                                                      lies_between(corner, next, last, outline_[after_[i]]));
            }
            if (!(turn(corner, next, p) > ear.least_turn[k])) {
                return false;
            }
        }
        return true;
    }

    /// Whether p, seen from the corner of a triangle, lies between the other two.
    [[nodiscard]] bool lies_between(const Point& corner, const Point& next, const Point& last, const Point& p) const {
        return turn(corner, next, p) > rounding_ && turn(corner, p, last) > rounding_;
    }

    const std::vector<Point>& outline_;
    Comparisons& comparisons_;
    double touching_, touching_area_;
    double rounding_;  ///< areas up to this are none
    std::vector<std::size_t> before_, after_;
    std::vector<bool> has_twin_, is_watched_, is_spike_;
    std::vector<std::size_t> watched_;
    std::size_t spikes_ = 0;
};

/// A face in its plane, `size` across.
std::vector<Point> outline_of(std::span<const Vector3> corners, std::size_t first, const Vector3& normal) {
    const auto axis = static_cast<std::size_t>(
        std::min_element(normal.begin(), normal.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
        normal.begin());
    Vector3 least{};
    least[axis] = 1;
    Vector3 u = cross(least, normal);
    u = (1 / length(u)) * u;
    const Vector3 v = cross(normal, u);
    std::vector<Point> outline;
    outline.reserve(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vector3 p = corners[(first + i) % corners.size()] - corners[first];
        outline.push_back({dot(u, p), dot(v, p)});
    }
    return outline;
}

/// Triangles around one corner.
void add_fan(std::size_t first, std::size_t count, FaceCut& cut) {
    for (std::size_t i = 1; i + 1 < count; ++i) {
        cut.triangles.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>((first + i) % count),
                                 static_cast<std::uint32_t>((first + i + 1) % count)});
    }
}

}  // namespace

FaceCut cut_face(std::span<const Vector3> corners, std::size_t max_comparisons) {
    FaceCut cut;
    const std::size_t count = corners.size();
    if (count == 3) {
        add_fan(0, count, cut);
        return cut;
    }
    BoundingBox bounds{corners[0], corners[0]};
    Vector3 mean{};
    Vector3 normal{};
    const std::size_t first = first_of(corners);
    for (std::size_t i = 0; i < count; ++i) {
        const Vector3& corner = corners[(first + i) % count];
        const Vector3& next = corners[(first + i + 1) % count];
        bounds.include({corner, corner});
        mean = mean + (1. / static_cast<double>(count)) * (corner - corners[first]);
        normal = normal + cross(corner - corners[first], next - corners[first]);
    }
    const double size = length(bounds.high_m - bounds.low_m);
    const double area = length(normal);
    const double rounding = no_area * size * size;
    if (!(area > rounding)) {
        if (are_on_a_line(corners, size)) {
            add_fan(0, count, cut);
        } else {
            cut.fault = FaceFault::crossing;  // what lies left and right of its outline cancels
        }
        return cut;
    }
    normal = (1 / area) * normal;
    for (const Vector3& corner : corners) {
        cut.bend = std::max(cut.bend, std::abs(dot(normal, corner - corners[first] - mean)) / size);
    }
    if (cut.bend > max_bend) {
        cut.fault = FaceFault::bent;
        return cut;
    }
    const std::vector<Point> outline = outline_of(corners, first, normal);
    if (is_convex(outline, rounding)) {
        add_fan(cut.bend > plane_bend ? first : 0, count, cut);
        return cut;
    }
    if (count > max_concave_corners) {
        cut.fault = FaceFault::too_large;
        return cut;
    }
    Comparisons comparisons(max_comparisons);
    const bool is_crossing = crosses_itself(outline, touching_width * size, comparisons);
    const auto triangles =
        is_crossing || comparisons.are_too_many() ? std::nullopt : EarClipper(outline, size, comparisons).triangles();
    cut.comparisons = comparisons.number();
    if (!triangles) {
        cut.fault = !is_crossing && comparisons.are_too_many() ? FaceFault::too_large : FaceFault::crossing;
        return cut;
    }
    double cut_area = 0;
    for (const auto& [a, b, c] : *triangles) {
        cut_area += std::abs(turn(outline[a], outline[b], outline[c]));
        const auto of_face = [&](std::size_t i) { return static_cast<std::uint32_t>((first + i) % count); };
        cut.triangles.push_back({of_face(a), of_face(b), of_face(c)});
    }
    // An outline may go back along itself so that triangles overlap: the face has less area than they have.
    if (cut_area - area > touching_width * static_cast<double>(count) * size * size) {
        cut.triangles.clear();
        cut.fault = FaceFault::crossing;
    }
    return cut;
}

}  // namespace downwash
