#include "downwash/aeromap/disc_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "downwash/aeromap/chord_envelope.hpp"
#include "downwash/aeromap/outline_crossings.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

using std::numbers::pi;

/// Where parts change k by less, they are left out.
constexpr double negligible_stake = 1e-4;
/// Straight pieces that stand for the curved surface of one part along a chord.
constexpr int curve_pieces = 16;

/// A point of a surface seen from the disc: along and across the chords, and its gap, negative on the other side.
struct FaceCorner {
    double u, v, gap;
};

/// A plane face over or under the disc.
struct LocalFace {
    std::array<FaceCorner, 4> corners;
    std::size_t corner_count;
    double v_low, v_high;
};

/// A part that is curved, or cut by the rotor plane.
struct Solid {
    std::size_t part;
    bool is_level;
};

/// Directions between the axes of the world, to which most edges run.
constexpr int direction_count = 16;

class ChordSum {
 public:
    ChordSum(const DiscQuery& query, double background_m, std::span<const std::size_t> parts,
             std::pmr::memory_resource* memory)
        : query_(query),
          background_m_(background_m),
          background_(query.factor(background_m)),
          faces_(memory),
          local_faces_(memory),
          solids_(memory),
          envelope_(query, background_m, memory) {
        double nearest_m = background_m;
        for (const std::size_t part : parts) {
            const BoundingBox bounds = query.scene.part_bounds(part);
            const double gap = query.gap(bounds.low_m[2], bounds.high_m[2]);
            if (!(gap < background_m)) {
                continue;
            }
            nearest_m = std::min(nearest_m, gap);
            // A solid that the rotor plane cuts is touched there; a triangle has no inside.
            const bool is_cut = gap == 0 && !query.scene.is_triangle(part);
            if (is_cut || !query.scene.add_faces(part, query.side == Side::below, faces_)) {
                solids_.push_back({part, query.scene.is_level(part)});
            }
        }
        if (nearest_m < background_m) {
            stake_ = query.curve.largest_difference(nearest_m / query.unit_m, background_m / query.unit_m);
        }
        if (stake_ > negligible_stake) {
            frame_ = across_edges();
            place_faces();
        }
    }

    [[nodiscard]] double average() {
        if (!(stake_ > negligible_stake)) {
            return background_;
        }
        const int count = stake_ < 0.01 ? 8 : stake_ < 0.1 ? 24 : 48;
        const double r = query_.radius_m;
        // With v = r sin t the integrand is flat at both ends, where the midpoint rule is at its best.
        double sum = 0;
        for (int i = 0; i < count; ++i) {
            const auto [sine, cosine] = lane::sin_cos(pi * ((i + 0.5) / count - 0.5));
            sum += chord(r * sine, r * cosine) * r * cosine;
        }
        return background_ + sum * (pi / count) / (pi * r * r);
    }

 private:
    /// The chords' direction to which the fewest and shortest edges are parallel.
    [[nodiscard]] ChordFrame across_edges() const {
        std::array<ChordFrame, direction_count> frames{};
        std::array<double, direction_count> parallel{};
        for (std::size_t i = 0; i < frames.size(); ++i) {
            const auto [sine, cosine] = lane::sin_cos(pi * (static_cast<double>(i) + 0.5) / direction_count);
            frames[i] = {query_.hub_m[0], query_.hub_m[1], query_.radius_m, cosine, sine};
        }
        const auto add_edge = [&](double x, double y) {
            const double square = x * x + y * y;
            // No edge counts for more than the disc can see of it.
            const double weight = std::min(std::sqrt(square), 2 * query_.radius_m);
            for (std::size_t i = 0; i < frames.size(); ++i) {
                const double along = x * frames[i].du_x + y * frames[i].du_y;
                const double part = square > 0 ? along * along / square : 0;
                parallel[i] += weight * part * part * part * part;
            }
        };
        for (const Scene::Face& face : faces_) {
            for (std::size_t i = 0; i < face.corner_count; ++i) {
                const Vector3& a = face.corners_m[i];
                const Vector3& b = face.corners_m[(i + 1) % face.corner_count];
                add_edge(b[0] - a[0], b[1] - a[1]);
            }
        }
        for (const Solid& solid : solids_) {
            for (const OutlineSegment& edge : shadow_outline(query_.scene, solid.part).segments) {
                add_edge(edge.bx - edge.ax, edge.by - edge.ay);
            }
        }
        return frames[static_cast<std::size_t>(std::min_element(parallel.begin(), parallel.end()) - parallel.begin())];
    }

    void place_faces() {
        for (const Scene::Face& face : faces_) {
            LocalFace local{{}, face.corner_count, infinity, -infinity};
            double nearest = infinity;
            for (std::size_t i = 0; i < face.corner_count; ++i) {
                const auto& [x, y, z] = face.corners_m[i];
                FaceCorner& corner = local.corners[i];
                corner = {frame_.u_of(x, y), frame_.v_of(x, y),
                          query_.side == Side::below ? query_.hub_m[2] - z : z - query_.hub_m[2]};
                local.v_low = std::min(local.v_low, corner.v);
                local.v_high = std::max(local.v_high, corner.v);
                nearest = std::min(nearest, corner.gap);
            }
            if (local.v_low < query_.radius_m && local.v_high > -query_.radius_m && nearest < background_m_) {
                local_faces_.push_back(local);
            }
        }
    }

    /// Integral of the excess over the background along one chord.
    double chord(double v, double half) {
        envelope_.clear();
        for (const LocalFace& face : local_faces_) {
            if (face.v_low < v && v < face.v_high) {
                add_stretch(face, v, half);
            }
        }
        for (const Solid& solid : solids_) {
            add_stretches(solid, v, half);
        }
        return envelope_.excess();
    }

    void add_stretch(const LocalFace& face, double v, double half) {
        std::array<FaceCorner, 2> ends{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < face.corner_count; ++i) {
            const FaceCorner& a = face.corners[i];
            const FaceCorner& b = face.corners[i + 1 < face.corner_count ? i + 1 : 0];
            if ((a.v < v) != (b.v < v) && count < 2) {
                const double part = (v - a.v) / (b.v - a.v);
                ends[count++] = {a.u + part * (b.u - a.u), v, a.gap + part * (b.gap - a.gap)};
            }
        }
        if (count == 2) {
            const bool is_forward = ends[0].u <= ends[1].u;
            const FaceCorner& low = ends[is_forward ? 0 : 1];
            const FaceCorner& high = ends[is_forward ? 1 : 0];
            add_clipped({low.u, high.u, low.gap, high.gap}, half);
        }
    }

    /// What of the stretch lies on this side of the rotor plane and over the disc.
    void add_clipped(const SurfaceStretch& whole, double half) {
        double low = std::max(whole.low, -half);
        double high = std::min(whole.high, half);
        if (!(low < high)) {
            return;
        }
        if (whole.gap_low < 0 || whole.gap_high < 0) {
            if (whole.gap_low < 0 && whole.gap_high < 0) {
                return;
            }
            const double crossing =
                whole.low + (whole.high - whole.low) * (whole.gap_low / (whole.gap_low - whole.gap_high));
            (whole.gap_low < 0 ? low : high) = whole.gap_low < 0 ? std::max(low, crossing) : std::min(high, crossing);
            if (!(low < high)) {
                return;
            }
        }
        const auto gap_at = [&](double u) { return std::max(0.0, whole.gap_at(u)); };
        envelope_.add({low, high, gap_at(low), gap_at(high)});
    }

    void add_stretches(const Solid& solid, double v, double half) {
        const double x = frame_.x_of(0, v);
        const double y = frame_.y_of(0, v);
        const Interval shadow = query_.scene.shadow_on_line(solid.part, x, y, frame_.du_x, frame_.du_y);
        const double low = std::max(shadow.low, -half);
        const double high = std::min(shadow.high, half);
        if (!(low < high)) {
            return;
        }
        const double middle = 0.5 * (low + high);
        const auto gap_at = [&](double u) {
            const Interval extent = query_.scene.vertical_extent(solid.part, frame_.x_of(u, v), frame_.y_of(u, v));
            return extent.empty() ? infinity : query_.gap(extent.low, extent.high);
        };
        if (solid.is_level) {
            const double gap = gap_at(middle);
            if (gap < background_m_) {
                envelope_.add({low, high, gap, gap});
            }
            return;
        }
        // Denser towards both ends, where round surfaces turn upright, and a little inside of them.
        const double reach = 0.5 * (high - low) * (1 - 1e-9);
        double from = middle - reach;
        double gap_from = gap_at(from);
        for (int i = 1; i <= curve_pieces; ++i) {
            const double t = 2.0 * i / curve_pieces - 1;
            const double to = middle + reach * 0.5 * t * (3 - t * t);
            const double gap_to = gap_at(to);
            if (gap_from < infinity && gap_to < infinity) {
                envelope_.add({from, to, gap_from, gap_to});
            }
            from = to;
            gap_from = gap_to;
        }
    }

    const DiscQuery& query_;
    double background_m_;
    double background_;
    double stake_ = 0;  ///< how much K may differ over the disc
    ChordFrame frame_{};
    std::pmr::vector<Scene::Face> faces_;
    std::pmr::vector<LocalFace> local_faces_;
    std::pmr::vector<Solid> solids_;
    ChordEnvelope envelope_;
};

}  // namespace

double chord_sum(const DiscQuery& query, double background_m, std::span<const std::size_t> parts,
                 std::pmr::memory_resource* memory) {
    return ChordSum(query, background_m, parts, memory).average();
}

}  // namespace downwash
