#include "downwash/aeromap/surface_rows.hpp"

#include <cmath>
#include <memory_resource>
#include <tuple>

#include "downwash/base/infinity.hpp"
#include "downwash/scene/shadow_outline.hpp"

namespace downwash {
namespace {

using Line = SurfaceRows::Line;
using Piece = SurfaceRows::Piece;

/// A corner of a face: along and across rows, and its height towards the hubs.
struct Corner {
    double u, v, rise;
};

Interval hull(const Interval& a, const Interval& b) {
    if (a.empty() || b.empty()) {
        return a.empty() ? b : a;
    }
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

/// What a face is of a part.
enum class Role : std::uint8_t {
    outside,    ///< the part does not reach into the slab
    sheet,      ///< it may, and has no inside
    near_side,  ///< it may, and has this side towards the hubs, or beyond them
    far_side,   ///< the other side of that
};

/// Collects what the rows of a window meet, one list for each row.
class RowCuts {
 public:
    RowCuts(const Scene& scene, const RowLattice& lattice, const RowWindow& window, Side side, const Slab& slab)
        : scene_(scene),
          lattice_(lattice),
          frame_(RowLattice::frame(lattice.radius_m)),
          window_(window),
          is_below_(side == Side::below),
          near_(is_below_ ? slab.low_m : -slab.high_m),
          beyond_(is_below_ ? slab.high_m : -slab.low_m),
          first_row_(lattice.row_before(window.v_m.low)),
          pieces_(static_cast<std::size_t>(lattice.row_before(window.v_m.high) - first_row_ + 1)),
          blocked_(pieces_.size()),
          passed_by_(pieces_.size()) {}

    void add(std::size_t part) {
        const BoundingBox bounds = scene_.part_bounds(part);
        const double top = is_below_ ? bounds.high_m[2] : -bounds.low_m[2];
        const double bottom = is_below_ ? bounds.low_m[2] : -bounds.high_m[2];
        if (bottom >= beyond_) {
            return;  // on the other side
        }
        if (!scene_.is_triangle(part)) {
            note_outline(part);
        }
        if (top <= near_) {
            add_sides(part, Role::outside);
        } else if (scene_.is_triangle(part)) {
            add_sides(part, Role::sheet);
        } else {
            add_cut_solid(part);
        }
    }

    [[nodiscard]] std::int64_t first_row() const noexcept { return first_row_; }
    [[nodiscard]] std::size_t row_count() const noexcept { return pieces_.size(); }
    [[nodiscard]] std::vector<Piece>& pieces(std::size_t row) noexcept { return pieces_[row]; }
    [[nodiscard]] const std::vector<Interval>& blocked(std::size_t row) const noexcept { return blocked_[row]; }
    [[nodiscard]] const std::vector<Interval>& passed_by(std::size_t row) const noexcept { return passed_by_[row]; }

 private:
    /// A part without anything in it, along rows and across.
    static constexpr RowWindow nothing{{infinity, -infinity}, {infinity, -infinity}};

    static void include(RowWindow& window, double u, double v) {
        window.u_m = {std::min(window.u_m.low, u), std::max(window.u_m.high, u)};
        window.v_m = {std::min(window.v_m.low, v), std::max(window.v_m.high, v)};
    }

    void note_outline(std::size_t part) {
        constexpr double negligible_share = 5e-4;  // of the disc
        RowWindow extent = nothing;
        const ShadowOutline outline = shadow_outline(scene_, part);
        for (const OutlineSegment& edge : outline.segments) {
            include(extent, frame_.u_of(edge.ax, edge.ay), frame_.v_of(edge.ax, edge.ay));
            include(extent, frame_.u_of(edge.bx, edge.by), frame_.v_of(edge.bx, edge.by));
        }
        for (const OutlineEllipse& ellipse : outline.ellipses) {
            const double u = frame_.u_of(ellipse.x, ellipse.y);
            const double v = frame_.v_of(ellipse.x, ellipse.y);
            const double reach = ellipse.across_m;
            include(extent, u - reach, v - reach);
            include(extent, u + reach, v + reach);
        }
        note(extent, 3 * negligible_share * lattice_.radius_m * lattice_.radius_m);
    }

    /// What is narrower than the distance of rows may lie between two of them.
    /// @param least_m2 of the rectangle around it; less is negligible
    void note(const RowWindow& extent, double least_m2) {
        const double width_m = extent.v_m.high - extent.v_m.low;
        if (!(width_m < lattice_.spacing_m() && width_m * (extent.u_m.high - extent.u_m.low) > least_m2)) {
            return;
        }
        for (std::int64_t row = lattice_.row_before(extent.v_m.low); row <= lattice_.row_before(extent.v_m.high);
             ++row) {
            if (row >= first_row_ && row < first_row_ + static_cast<std::int64_t>(row_count())) {
                passed_by_[index(row)].push_back(extent.u_m);
            }
        }
    }

    /// Adds the side of a part that is seen from the hubs, or the other one.
    void add_sides(std::size_t part, Role role) {
        faces_.clear();
        if (scene_.add_faces(part, is_below_ != (role == Role::far_side), faces_)) {
            for (const Scene::Face& face : faces_) {
                add_face(face, role);
            }
        } else {
            add_curved(part, role);
        }
    }

    /// Of a solid that may reach into the slab: what of it is on this side of the slab, and where it is in the slab. As
    /// it is convex, both its sides are beyond a height over one stretch of a row.
    void add_cut_solid(std::size_t part) {
        near_beyond_.assign(row_count(), {});
        far_before_.assign(row_count(), {});
        add_sides(part, Role::near_side);
        add_sides(part, Role::far_side);
        for (std::size_t row = 0; row < row_count(); ++row) {
            const Interval both{std::max(near_beyond_[row].low, far_before_[row].low),
                                std::min(near_beyond_[row].high, far_before_[row].high)};
            if (!near_beyond_[row].empty() && !far_before_[row].empty() && both.low < both.high) {
                blocked_[row].push_back(both);
            }
        }
    }

    void add_face(const Scene::Face& face, Role role) {
        std::array<Corner, 4> corners{};
        RowWindow extent = nothing;
        for (std::size_t i = 0; i < face.corner_count; ++i) {
            const auto& [x, y, z] = face.corners_m[i];
            corners[i] = {frame_.u_of(x, y), frame_.v_of(x, y), is_below_ ? z : -z};
            include(extent, corners[i].u, corners[i].v);
        }
        const auto& [u, v] = extent;
        if (u.high <= window_.u_m.low || u.low >= window_.u_m.high || v.high <= window_.v_m.low ||
            v.low >= window_.v_m.high) {
            return;
        }
        if (face.corner_count == 3 && u.high - u.low > 2 * lattice_.spacing_m()) {  // smaller ones have neighbours
            note(extent, 0);
        }
        const std::int64_t from = std::max(lattice_.row_before(std::max(v.low, window_.v_m.low)), first_row_);
        const std::int64_t last = std::min(lattice_.row_before(std::min(v.high, window_.v_m.high)),
                                           first_row_ + static_cast<std::int64_t>(row_count()) - 1);
        for (std::int64_t row = from; row <= last; ++row) {
            cut(std::span(corners).first(face.corner_count), row, role);
        }
    }

    /// Neighbours that share an edge are cut at the same place to the last bit: the edge is taken in one direction.
    void cut(std::span<const Corner> corners, std::int64_t row, Role role) {
        const double v = lattice_.v_of(row);
        std::array<Corner, 2> ends{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Corner& a = corners[i];
            const Corner& b = corners[i + 1 < corners.size() ? i + 1 : 0];
            if ((a.v < v) != (b.v < v) && count < 2) {
                const Corner& low = a.v < b.v ? a : b;
                const Corner& high = a.v < b.v ? b : a;
                const double share = (v - low.v) / (high.v - low.v);
                ends[count++] = {low.u + share * (high.u - low.u), v, low.rise + share * (high.rise - low.rise)};
            }
        }
        if (count < 2) {
            return;
        }
        const Corner& low = ends[ends[0].u <= ends[1].u ? 0 : 1];
        const Corner& high = ends[ends[0].u <= ends[1].u ? 1 : 0];
        if (low.u < high.u && low.u < window_.u_m.high && high.u > window_.u_m.low) {
            const Line line{low.u, low.rise, (high.rise - low.rise) / (high.u - low.u)};
            add_piece(index(row), {low.u, high.u, line}, high.rise, role);
        }
    }

    void add_piece(std::size_t row, const Piece& piece, double rise_high, Role role) {
        const double rise_low = piece.line.at(piece.low);
        if (role == Role::outside) {
            pieces_[row].push_back(piece);
            return;
        }
        const auto part_below = [&](double rise) -> Interval {  // where the piece does not rise higher
            if (std::min(rise_low, rise_high) >= rise) {
                return {};
            }
            if (std::max(rise_low, rise_high) <= rise) {
                return {piece.low, piece.high};
            }
            const double there = std::clamp(piece.low + (rise - rise_low) / piece.line.slope, piece.low, piece.high);
            return rise_low < rise_high ? Interval{piece.low, there} : Interval{there, piece.high};
        };
        if (role == Role::far_side) {
            far_before_[row] = hull(far_before_[row], part_below(beyond_));
            return;
        }
        const Interval kept = part_below(near_);
        if (kept.low < kept.high) {
            pieces_[row].push_back({kept.low, kept.high, piece.line});
        }
        // What is not kept is at one end of the piece.
        const Interval reached = role == Role::sheet ? part_below(beyond_) : Interval{piece.low, piece.high};
        const Interval rest = kept.empty()           ? reached
                              : rise_low < rise_high ? Interval{kept.high, reached.high}
                                                     : Interval{reached.low, kept.low};
        if (!(rest.low < rest.high)) {
            return;
        }
        if (role == Role::sheet) {
            blocked_[row].push_back(rest);
        } else {
            near_beyond_[row] = hull(near_beyond_[row], rest);
        }
    }

    /// A round part as straight pieces, denser towards both ends of its shadow, where it turns upright.
    void add_curved(std::size_t part, Role role) {
        const bool is_level = scene_.is_level(part);
        for (std::size_t row = 0; row < row_count(); ++row) {
            const Interval shadow = shadow_on(part, row);
            if (!(shadow.low < shadow.high)) {
                continue;
            }
            const double v = lattice_.v_of(first_row_ + static_cast<std::int64_t>(row));
            const double middle = 0.5 * (shadow.low + shadow.high);
            if (is_level) {
                const double rise = rise_at(part, middle, v, role);
                add_piece(row, {shadow.low, shadow.high, {middle, rise, 0}}, rise, role);
                continue;
            }
            const double reach = 0.5 * (shadow.high - shadow.low) * (1 - 1e-9);  // a little inside
            constexpr double min_pieces = 16;
            constexpr double pieces_in_radius = 12;
            const double count = std::ceil(std::max(min_pieces, 2 * pieces_in_radius * reach / lattice_.radius_m));
            double from = middle - reach;
            double rise_from = rise_at(part, from, v, role);
            for (double i = 1; i <= count; ++i) {
                const double t = 2 * i / count - 1;
                const double to = middle + reach * 0.5 * t * (3 - t * t);
                const double rise_to = rise_at(part, to, v, role);
                if (from < to && rise_from > -infinity && rise_to > -infinity && from < window_.u_m.high &&
                    to > window_.u_m.low) {
                    add_piece(row, {from, to, {from, rise_from, (rise_to - rise_from) / (to - from)}}, rise_to, role);
                }
                from = to;
                rise_from = rise_to;
            }
        }
    }

    [[nodiscard]] Interval shadow_on(std::size_t part, std::size_t row) const {
        const double v = lattice_.v_of(first_row_ + static_cast<std::int64_t>(row));
        return scene_.shadow_on_line(part, frame_.x_of(0, v), frame_.y_of(0, v), frame_.du_x, frame_.du_y);
    }

    /// The height of one side of a part towards the hubs.
    [[nodiscard]] double rise_at(std::size_t part, double u, double v, Role role) const {
        const Interval extent = scene_.vertical_extent(part, frame_.x_of(u, v), frame_.y_of(u, v));
        if (extent.empty()) {
            return -infinity;
        }
        const double z = is_below_ != (role == Role::far_side) ? extent.high : extent.low;
        return is_below_ ? z : -z;
    }

    [[nodiscard]] std::size_t index(std::int64_t row) const { return static_cast<std::size_t>(row - first_row_); }

    const Scene& scene_;
    RowLattice lattice_;
    ChordFrame frame_;
    RowWindow window_;
    bool is_below_;
    double near_, beyond_;  ///< heights of the slab's two sides towards the hubs
    std::int64_t first_row_;
    std::vector<std::vector<Piece>> pieces_;
    std::vector<std::vector<Interval>> blocked_, passed_by_;
    std::pmr::vector<Scene::Face> faces_;
    std::vector<Interval> near_beyond_;  ///< where the near side of the present solid is in the slab or beyond, by row
    std::vector<Interval> far_before_;   ///< where its far side is in the slab or before it
};

/// Finds the highest of pieces along one row.
class HighestPieces {
 public:
    /// Appends them to `all`. @param pieces any number, in any order; sorted afterwards
    void add(std::vector<Piece>& pieces, std::vector<Piece>& all) {
        std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
            return std::tie(a.low, a.high, a.line.rise, a.line.slope, a.line.u) <
                   std::tie(b.low, b.high, b.line.rise, b.line.slope, b.line.u);
        });
        row_begin_ = all.size();
        const auto meets_next = [](const Piece& a, const Piece& b) { return b.low < a.high; };
        if (std::adjacent_find(pieces.begin(), pieces.end(), meets_next) == pieces.end()) {
            for (const Piece& piece : pieces) {
                append(piece, all);
            }
            return;
        }
        ends_.clear();
        for (const Piece& piece : pieces) {
            ends_.push_back(piece.low);
            ends_.push_back(piece.high);
        }
        std::sort(ends_.begin(), ends_.end());
        open_.clear();
        open_highs_.clear();
        std::size_t next = 0;
        for (std::size_t i = 1; i < ends_.size(); ++i) {
            const double low = ends_[i - 1];
            const double high = ends_[i];
            if (!(low < high)) {
                continue;
            }
            for (; next < pieces.size() && pieces[next].low <= low; ++next) {
                open_.push_back(pieces[next].line);
                open_highs_.push_back(pieces[next].high);
            }
            for (std::size_t k = 0; k < open_.size();) {
                if (open_highs_[k] <= low) {
                    open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(k));
                    open_highs_.erase(open_highs_.begin() + static_cast<std::ptrdiff_t>(k));
                } else {
                    ++k;
                }
            }
            between(low, high, all);
        }
    }

 private:
    /// All open lines go from one end to the other: follows the highest one to where a steeper one overtakes it.
    void between(double low, double high, std::vector<Piece>& all) const {
        if (open_.empty()) {
            return;
        }
        const Line* line = &open_.front();
        for (const Line& other : open_) {
            const double lead = other.at(low) - line->at(low);
            if (lead > 0 || (lead == 0 && other.slope > line->slope)) {
                line = &other;
            }
        }
        double from = low;
        while (from < high) {
            double to = high;
            const Line* next = nullptr;
            for (const Line& other : open_) {
                if (other.slope > line->slope) {
                    const double there = other.u + (line->at(other.u) - other.rise) / (other.slope - line->slope);
                    if (there < to || (next != nullptr && there == to && other.slope > next->slope)) {
                        to = std::max(from, there);
                        next = &other;
                    }
                }
            }
            if (from < to) {
                append({from, to, *line}, all);
            }
            if (next == nullptr) {
                return;
            }
            from = to;
            line = next;
        }
    }

    /// Pieces of one line, and level ones at one height, are joined.
    void append(const Piece& piece, std::vector<Piece>& all) const {
        if (all.size() > row_begin_) {
            Piece& last = all.back();
            const bool is_same =
                last.line.u == piece.line.u && last.line.rise == piece.line.rise && last.line.slope == piece.line.slope;
            const bool is_level = last.line.slope == 0 && piece.line.slope == 0 && last.line.rise == piece.line.rise;
            if (last.high == piece.low && (is_same || is_level)) {
                last.high = piece.high;
                return;
            }
        }
        all.push_back(piece);
    }

    std::size_t row_begin_ = 0;
    std::vector<double> ends_;
    std::vector<Line> open_;
    std::vector<double> open_highs_;
};

}  // namespace

SurfaceRows::SurfaceRows(const Scene& scene, std::span<const std::uint32_t> parts, const RowLattice& lattice,
                         const RowWindow& window, Side side, const Slab& slab)
    : lattice_(lattice),
      is_below_(side == Side::below),
      u_low_m_(window.u_m.low),
      buckets_per_m_(static_cast<double>(buckets) / (window.u_m.high - window.u_m.low)) {
    RowCuts cuts(scene, lattice, window, side, slab);
    first_row_ = cuts.first_row();
    for (const std::uint32_t part : parts) {
        cuts.add(part);
    }
    HighestPieces highest;
    starts_.reserve(cuts.row_count() * buckets + 1);
    for (std::size_t row = 0; row < cuts.row_count(); ++row) {
        const std::size_t first = pieces_.size();
        highest.add(cuts.pieces(row), pieces_);
        add_starts(first);
        blocked_.add_row(cuts.blocked(row));
        passed_by_.add_row(cuts.passed_by(row));
    }
    starts_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    for (Piece& piece : pieces_) {
        piece.per_slope = -1 / piece.line.slope;
    }
    pieces_.shrink_to_fit();
    level_rise_m_ = level_rise_m(window);
}

/// That of the only piece in every row, where they are all level, at one height, and go through the window.
std::optional<double> SurfaceRows::level_rise_m(const RowWindow& window) const {
    const std::size_t rows = starts_.size() / buckets;
    const bool is_it = pieces_.size() == rows && blocked_.all.empty() &&
                       std::all_of(pieces_.begin(), pieces_.end(), [&](const Piece& piece) {
                           return piece.line.slope == 0 && piece.line.rise == pieces_.front().line.rise &&
                                  piece.low <= window.u_m.low && piece.high >= window.u_m.high;
                       });
    return is_it ? std::optional(pieces_.front().line.rise) : std::nullopt;
}

void SurfaceRows::Stretches::add_row(const std::vector<Interval>& row) {
    all.insert(all.end(), row.begin(), row.end());
    starts.push_back(static_cast<std::uint32_t>(all.size()));
}

/// @param first piece of the row
void SurfaceRows::add_starts(std::size_t first) {
    std::size_t piece = first;
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
        if (bucket > 0) {  // a little earlier, so that rounding skips nothing
            const double from = u_low_m_ + (static_cast<double>(bucket) - 1e-6) / buckets_per_m_;
            while (piece < pieces_.size() && pieces_[piece].high <= from) {
                ++piece;
            }
        }
        starts_.push_back(static_cast<std::uint32_t>(piece));
    }
}

std::size_t SurfaceRows::bytes() const noexcept {
    return sizeof(*this) + pieces_.capacity() * sizeof(Piece) + starts_.capacity() * sizeof(std::uint32_t) +
           blocked_.bytes() + passed_by_.bytes();
}

}  // namespace downwash
