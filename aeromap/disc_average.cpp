#include "downwash/aeromap/disc_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <list>
#include <memory_resource>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "downwash/aeromap/chord_envelope.hpp"
#include "downwash/aeromap/facing_surface.hpp"
#include "downwash/aeromap/gauss_rule.hpp"
#include "downwash/aeromap/outline_crossings.hpp"
#include "downwash/aeromap/row_average.hpp"
#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"

namespace downwash {
namespace {

using std::numbers::pi;

/// Where obstacles change k by less, a relative error of one percent does no harm.
constexpr double far_stake = 0.01;
/// The nodes of Gauss' rule of two points.
constexpr double gauss_2 = 0.57735026918962576;

/// With more parts over the disc chord_sum takes their place.
constexpr std::size_t max_with_crossings = 24;

/// A part of an obstacle that may be the first surface for some point of the disc.
struct FacingPart {
    const Footprint* footprint;
    double gap_m;             ///< nowhere smaller
    bool is_straight = true;  ///< along the chords
};

/// Along the axis of the nearest cylinder that lies, else down the slope of the nearest part.
ChordFrame frame_for(const DiscQuery& query, const std::pmr::vector<FacingPart>& nearest_first) {
    for (const FacingPart& candidate : nearest_first) {
        const ShadowOutline& outline = candidate.footprint->outline;
        if (!candidate.footprint->is_level && !candidate.footprint->has_plane_faces && !outline.segments.empty()) {
            return {query.hub_m[0], query.hub_m[1], query.radius_m, outline.slope_y, -outline.slope_x};
        }
    }
    const ShadowOutline& first = nearest_first.front().footprint->outline;
    return {query.hub_m[0], query.hub_m[1], query.radius_m, first.slope_x, first.slope_y};
}

/// Cuts the disc into chords, splits them where outlines begin, end or leave the disc, and takes the first surface
/// along each.
class DiscQuadrature {
 public:
    /// @param background_m gap of what lies behind all candidates; infinite for nothing
    DiscQuadrature(const DiscQuery& query, double background_m, std::pmr::vector<FacingPart>& candidates,
                   std::pmr::memory_resource* memory)
        : query_(query),
          background_(query.factor(background_m)),
          candidates_(candidates),
          envelope_(query, background_m, memory),
          breaks_(memory),
          cuts_(memory) {
        std::sort(candidates.begin(), candidates.end(),
                  [](const FacingPart& a, const FacingPart& b) { return a.gap_m < b.gap_m; });
        frame_ = frame_for(query, candidates);
        for (FacingPart& candidate : candidates) {
            candidate.is_straight = is_straight(*candidate.footprint, frame_);
        }
        const double stake =
            query.curve.largest_difference(candidates.front().gap_m / query.unit_m, background_m / query.unit_m);
        is_far_ = stake < far_stake;
        // Measured against 32 times as many chords: at most 1e-3 up to a stake of 1, and seldom more than 1e-4.
        const double weight = is_far_ ? 0.1 : stake < 0.1 ? 0.35 : stake < 0.5 ? 0.85 : 1.3;
        const bool is_level = std::all_of(candidates.begin(), candidates.end(),
                                          [](const FacingPart& candidate) { return candidate.footprint->is_level; });
        is_polygonal_ = is_level && std::all_of(candidates.begin(), candidates.end(), [](const FacingPart& candidate) {
                            return candidate.footprint->outline.ellipses.empty();
                        });
        scale_ = (is_level ? 2 : 1) * weight / query.radius_m;  // level chords cost little
        breaks_.reserve(32);
        cuts_.reserve(16);
        curve_pieces_ = is_far_ ? 1 : stake < 0.1 ? 2 : 4;
    }

    double average() {
        collect_breaks();
        double excess = 0;  // integral of k over the disc, beyond the background's
        for (std::size_t i = 1; i < breaks_.size(); ++i) {
            excess += strip(breaks_[i - 1], breaks_[i]);
        }
        return background_ + excess / (pi * query_.radius_m * query_.radius_m);
    }

 private:
    double strip(double low, double high) {
        if (is_polygonal_) {
            return polygonal_strip(low, high);
        }
        return integral(low, high, [this](double v) { return chord(v); });
    }

    /// Under level faces with straight edges a chord's integral is made of v and the chord's own length, which with
    /// v = R sin t are analytic in t: Gauss' rule gives it to rounding.
    double polygonal_strip(double low, double high) {
        const double first = angle_of(low);
        const double last = angle_of(high);
        const auto f = [this](double t) {
            const auto [sine, cosine] = lane::sin_cos(t);
            return chord(query_.radius_m * sine) * query_.radius_m * cosine;
        };
        return last - first < 1 ? integrate(plain_6, first, last, f) : integrate(plain_12, first, last, f);
    }

    double angle_of(double v) const {
        return lane::atan2(v, std::sqrt(std::max(query_.radius_m * query_.radius_m - v * v, 0.0)));
    }

    /// More points the wider the piece and the more is at stake.
    template <class Function>
    double integral(double low, double high, const Function& f) const {
        const double width = scale_ * (high - low);
        if (width < 0.1) {
            return integrate(smoothed_2, low, high, f);
        }
        if (width < 0.4) {
            return integrate(smoothed_4, low, high, f);
        }
        if (width < 0.8) {
            return integrate(smoothed_6, low, high, f);
        }
        if (width < 1.4) {
            return integrate(smoothed_8, low, high, f);
        }
        return integrate(smoothed_12, low, high, f);
    }

    double chord(double v) {
        const double half = std::sqrt(std::max(query_.radius_m * query_.radius_m - v * v, 0.0));
        const double x = frame_.x_of(0, v);
        const double y = frame_.y_of(0, v);
        envelope_.clear();
        for (const FacingPart& candidate : candidates_) {
            const Interval shadow =
                candidate.footprint->is_level_polygon()
                    ? candidate.footprint->shadow_on_line(x, y, frame_.du_x, frame_.du_y)
                    : query_.scene.shadow_on_line(candidate.footprint->part, x, y, frame_.du_x, frame_.du_y);
            const double low = std::max(shadow.low, -half);
            const double high = std::min(shadow.high, half);
            if (!(low < high)) {
                continue;
            }
            if (candidate.footprint->is_level) {
                envelope_.add({low, high, candidate.gap_m, candidate.gap_m});
            } else if (!add_plane_stretches(query_, frame_, *candidate.footprint, v, {low, high}, envelope_)) {
                add_slopes(candidate, {low, high}, v);
            }
        }
        return envelope_.excess();
    }

    /// Between the creases of its surface.
    void add_slopes(const FacingPart& candidate, const Interval& shadow, double v) {
        cuts_.clear();
        cuts_.push_back(shadow.low);
        cuts_.push_back(shadow.high);
        if (!is_far_) {
            add_creases(frame_, query_.side, candidate.footprint->outline, v, shadow, cuts_);
            std::sort(cuts_.begin(), cuts_.end());
        }
        for (std::size_t i = 1; i < cuts_.size(); ++i) {
            if (cuts_[i - 1] < cuts_[i]) {
                add_slopes(candidate, cuts_[i - 1], cuts_[i], v);
            }
        }
    }

    /// One straight piece where the surface is straight along the chord, else some, denser towards both ends, where
    /// round surfaces turn upright. Each is the line through two points of the surface that has its mean gap.
    void add_slopes(const FacingPart& candidate, double low, double high, double v) {
        const double middle = 0.5 * (low + high);
        const double reach = 0.5 * (high - low);
        const bool is_ball = candidate.footprint->outline.segments.empty();  // bends both ways
        const int pieces = candidate.is_straight ? 1 : is_ball ? 2 * curve_pieces_ : curve_pieces_;
        double from = low;
        for (int i = 1; i <= pieces; ++i) {
            const double t = 2.0 * i / pieces - 1;
            const double to = i < pieces ? middle + reach * 0.5 * t * (3 - t * t) : high;
            const double center = 0.5 * (from + to);
            const double aside = 0.5 * gauss_2 * (to - from);
            const double one =
                gap_at(query_, *candidate.footprint, frame_.x_of(center - aside, v), frame_.y_of(center - aside, v));
            const double other =
                gap_at(query_, *candidate.footprint, frame_.x_of(center + aside, v), frame_.y_of(center + aside, v));
            if (one < infinity && other < infinity) {
                const double mean = 0.5 * (one + other);
                const double rise = (other - one) * (0.5 / gauss_2);
                envelope_.add({from, to, std::max(0.0, mean - rise), std::max(0.0, mean + rise)});
            }
            from = to;
        }
    }

    void collect_breaks() {
        breaks_.push_back(-query_.radius_m);
        breaks_.push_back(query_.radius_m);
        for (const FacingPart& candidate : candidates_) {
            add_breaks(frame_, query_.side, candidate.footprint->outline, breaks_);
            if (!candidate.footprint->is_level && candidate.gap_m < query_.kink_m()) {
                add_kinks(query_, frame_, *candidate.footprint, breaks_);
            }
        }
        if (is_polygonal_) {
            for (std::size_t i = 1; i < candidates_.size(); ++i) {
                for (std::size_t j = 0; j < i; ++j) {
                    add_crossings(frame_, candidates_[i].footprint->outline, candidates_[j].footprint->outline,
                                  breaks_);
                }
            }
        }
        std::sort(breaks_.begin(), breaks_.end());
        const double negligible = 1e-6 * query_.radius_m;
        breaks_.erase(
            std::unique(breaks_.begin(), breaks_.end(), [&](double x, double y) { return y - x < negligible; }),
            breaks_.end());
    }

    const DiscQuery& query_;
    double background_;
    bool is_far_ = false;
    bool is_polygonal_ = false;  ///< level faces with straight edges only
    int curve_pieces_ = 1;       ///< that stand for a round surface along a chord
    double scale_ = 0;           ///< what makes a width one that matters
    const std::pmr::vector<FacingPart>& candidates_;
    ChordFrame frame_{};
    ChordEnvelope envelope_;
    std::pmr::vector<double> breaks_;
    std::pmr::vector<double> cuts_;
};

/// The plane that covers the disc, not level, when it hides all other candidates and what lies behind them.
std::optional<PlaneCover> only_plane(const DiscQuery& query, const std::pmr::vector<FacingPart>& candidates,
                                     double background_m) {
    const auto nearest = std::min_element(candidates.begin(), candidates.end(),
                                          [](const FacingPart& a, const FacingPart& b) { return a.gap_m < b.gap_m; });
    if (nearest->footprint->is_level) {
        return {};
    }
    const std::optional<PlaneCover> cover = plane_cover(query, *nearest->footprint);
    const auto is_hidden = [&](const FacingPart& candidate) {
        return &candidate == &*nearest || candidate.gap_m >= cover->farthest_m();
    };
    return cover && cover->farthest_m() <= background_m && std::all_of(candidates.begin(), candidates.end(), is_hidden)
               ? cover
               : std::nullopt;
}

/// Whether all candidates are level polygons none of which hides another: then areas are enough.
bool are_beside_each_other(const std::pmr::vector<FacingPart>& candidates) {
    constexpr std::size_t max_candidates = 6;  // each is compared with each
    if (candidates.size() > max_candidates) {
        return false;
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Footprint& one = *candidates[i].footprint;
        if (!one.is_level_polygon()) {
            return false;
        }
        for (std::size_t j = 0; j < i; ++j) {
            if (!one.lies_beside(*candidates[j].footprint)) {
                return false;
            }
        }
    }
    return true;
}

double average_by_areas(const DiscQuery& query, double background_m, const std::pmr::vector<FacingPart>& candidates) {
    const auto& [x, y, z] = query.hub_m;
    const double background = query.factor(background_m);
    double excess = 0;
    for (const FacingPart& candidate : candidates) {
        const double area_m2 = candidate.footprint->area_in_disc_m2(x, y, query.radius_m);
        excess += (query.factor(candidate.gap_m) - background) * area_m2;
    }
    return background + excess / (pi * query.radius_m * query.radius_m);
}

/// The vertical column from the disc on the query's side.
BoundingBox column_of(const DiscQuery& query) {
    const auto& [x, y, z] = query.hub_m;
    const double r = query.radius_m;
    const bool is_below = query.side == Side::below;
    return {{x - r, y - r, is_below ? -infinity : z}, {x + r, y + r, is_below ? z : infinity}};
}

}  // namespace

double disc_average(const DiscQuery& query, const Footprints& footprints) {
    if (const RowColumns* columns = footprints.columns()) {
        if (const std::optional<double> average = row_average(query, *columns)) {
            return *average;
        }
    }
    // Room for about 20 parts over one disc; more of them make the pool fetch memory.
    std::array<std::byte, 6144> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    std::list<Footprint> spare;
    std::pmr::vector<FacingPart> candidates(&memory);
    candidates.reserve(16);
    double cover_m = infinity;  // gap of the nearest level part that covers the disc
    const auto add_over_disc = [&](const Footprint& footprint) {
        if (!footprint.meets_column(query.hub_m[0], query.hub_m[1], query.radius_m)) {
            return;
        }
        const double gap = query.gap(footprint.bounds.low_m[2], footprint.bounds.high_m[2]);
        if (footprint.is_level && footprint.covers_disc(query.hub_m[0], query.hub_m[1], query.radius_m)) {
            cover_m = std::min(cover_m, gap);
        } else if (gap < infinity) {
            candidates.push_back({&footprint, gap});
        }
    };
    const std::span<const Footprint> primitives = footprints.of_primitives();
    std::pmr::vector<std::size_t> others(&memory);
    if (footprints.are_few_primitives()) {
        std::for_each(primitives.begin(), primitives.end(), add_over_disc);
    } else {
        // In the scene's order, however they were found: primitives first.
        footprints.part_columns().add_parts_meeting(column_of(query), others);
        const auto first_other = std::lower_bound(others.begin(), others.end(), primitives.size());
        std::for_each(others.begin(), first_other, [&](std::size_t part) { add_over_disc(primitives[part]); });
        others.erase(others.begin(), first_other);
    }
    const bool are_few = candidates.size() + others.size() <= max_with_crossings;
    if (are_few) {
        for (const std::size_t part : others) {
            add_over_disc(footprints.of_other(part, spare));
        }
    }
    std::erase_if(candidates, [&](const FacingPart& candidate) { return candidate.gap_m >= cover_m; });
    if (!are_few) {
        for (const FacingPart& candidate : candidates) {
            others.push_back(candidate.footprint->part);
        }
        return chord_sum(query, cover_m, others, &memory);
    }
    if (candidates.empty()) {
        return query.factor(cover_m);
    }
    if (are_beside_each_other(candidates)) {
        return average_by_areas(query, cover_m, candidates);
    }
    if (const auto cover = only_plane(query, candidates, cover_m)) {
        return plane_average(query, *cover);
    }
    return DiscQuadrature(query, cover_m, candidates, &memory).average();
}

}  // namespace downwash
