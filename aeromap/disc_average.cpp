#include "downwash/aeromap/disc_average.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "downwash/aeromap/gauss_rule.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = 3.14159265358979323846;
/// Where obstacles change k by less, a relative error of one percent does no harm.
constexpr double far_stake = 0.01;

/// A unit vector.
using Direction = std::array<double, 2>;

constexpr double c1 = 0.92387953251128675613;  // cosines of 22.5, 45 and 67.5 degrees
constexpr double c2 = 0.70710678118654752440;
constexpr double c3 = 0.38268343236508977173;
constexpr std::array<Direction, 16> sixteen_directions{{{1, 0},
                                                        {c1, c3},
                                                        {c2, c2},
                                                        {c3, c1},
                                                        {0, 1},
                                                        {-c3, c1},
                                                        {-c2, c2},
                                                        {-c1, c3},
                                                        {-1, 0},
                                                        {-c1, -c3},
                                                        {-c2, -c2},
                                                        {-c3, -c1},
                                                        {0, -1},
                                                        {c3, -c1},
                                                        {c2, -c2},
                                                        {c1, -c3}}};

Direction between(const Direction& a, const Direction& b) {
    const double x = a[0] + b[0];
    const double y = a[1] + b[1];
    const double length = std::sqrt(x * x + y * y);
    return {x / length, y / length};
}

/// An obstacle that may be the first surface for some point of the disc.
struct Candidate {
    const Footprint* footprint;
    double gap_m;   ///< nowhere smaller
    double factor;  ///< at that gap: everywhere when the obstacle is level
};

/// A candidate's shadow on one chord.
struct Stretch {
    double low, high;
    const Candidate* candidate;
};

/// Cuts the disc into chords square to `v`, splits them where outlines begin, end or leave the disc, and takes the
/// first surface along each. Coordinates: u along a chord, v across the chords, from the hub, in metres.
class DiscQuadrature {
 public:
    /// @param background_m gap of what lies behind all candidates; infinite for nothing
    DiscQuadrature(const DiscQuery& query, double background_m, std::pmr::vector<Candidate>& candidates,
                   std::pmr::memory_resource* memory)
        : query_(query),
          background_m_(background_m),
          background_(query.factor(background_m)),
          candidates_(candidates),
          breaks_(memory),
          stretches_(memory),
          cuts_(memory) {
        std::sort(candidates.begin(), candidates.end(),
                  [](const Candidate& a, const Candidate& b) { return a.gap_m < b.gap_m; });
        du_ = {candidates.front().footprint->outline.slope_x, candidates.front().footprint->outline.slope_y};
        dv_ = {-du_[1], du_[0]};
        const double stake = std::abs(candidates.front().factor - background_);
        is_far_ = stake < far_stake;
        const double weight = is_far_ ? 0.12 : stake < 0.1 ? 0.5 : 1;
        const bool is_level = std::all_of(candidates.begin(), candidates.end(),
                                          [](const Candidate& candidate) { return candidate.footprint->is_level; });
        scale_ = (is_level ? 2 : 1) * weight / query.radius_m;  // level chords cost little
        breaks_.reserve(32);
        stretches_.reserve(candidates.size());
        cuts_.reserve(2 * candidates.size());
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
        return integral(low, high, [this](double v) { return chord(v); });
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
        const double x = query_.hub_m[0] + v * dv_[0];
        const double y = query_.hub_m[1] + v * dv_[1];
        stretches_.clear();
        for (const Candidate& candidate : candidates_) {
            const Interval shadow = query_.scene.shadow_on_line(candidate.footprint->obstacle, x, y, du_[0], du_[1]);
            const double low = std::max(shadow.low, -half);
            const double high = std::min(shadow.high, half);
            if (low < high) {
                stretches_.push_back({low, high, &candidate});
            }
        }
        if (stretches_.empty()) {
            return 0;
        }
        cuts_.clear();
        for (const Stretch& stretch : stretches_) {
            cuts_.push_back(stretch.low);
            cuts_.push_back(stretch.high);
            if (!is_far_ && !stretch.candidate->footprint->is_level) {
                cut_at_creases(stretch, v);
            }
        }
        std::sort(cuts_.begin(), cuts_.end());
        double sum = 0;
        for (std::size_t i = 1; i < cuts_.size(); ++i) {
            sum += piece(cuts_[i - 1], cuts_[i], x, y);
        }
        return sum;
    }

    /// Where edges on the side that is seen cross the chord.
    void cut_at_creases(const Stretch& stretch, double v) {
        const auto cut = [&](double u) {
            if (stretch.low < u && u < stretch.high) {
                cuts_.push_back(u);
            }
        };
        const ShadowOutline& outline = stretch.candidate->footprint->outline;
        for (const OutlineSegment& segment : outline.segments) {
            if (is_seen(segment)) {
                const double a = v_of(segment.ax, segment.ay) - v;
                const double b = v_of(segment.bx, segment.by) - v;
                if ((a < 0) != (b < 0)) {
                    const double part = a / (a - b);
                    cut(u_of(segment.ax + part * (segment.bx - segment.ax),
                             segment.ay + part * (segment.by - segment.ay)));
                }
            }
        }
        for (const OutlineEllipse& ellipse : outline.ellipses) {
            if (is_seen(ellipse)) {
                // Shrunk across to a circle of radius 1: |p + u d| = 1.
                const double along = ellipse.ux * du_[0] + ellipse.uy * du_[1];
                const double across = ellipse.ux * du_[1] - ellipse.uy * du_[0];
                const double cu = u_of(ellipse.x, ellipse.y);
                const double cv = v_of(ellipse.x, ellipse.y) - v;
                const double px = -(cu * along - cv * across) / ellipse.along_m;
                const double py = -(cu * across + cv * along) / ellipse.across_m;
                const double dx = along / ellipse.along_m;
                const double dy = across / ellipse.across_m;
                const double square = dx * dx + dy * dy;
                const double middle = -(px * dx + py * dy) / square;
                const double root = square - (px * dy - py * dx) * (px * dy - py * dx);
                if (root > 0) {
                    const double half = std::sqrt(root) / square;
                    cut(middle - half);
                    cut(middle + half);
                }
            }
        }
    }

    template <class Outline>
    bool is_seen(const Outline& outline) const {
        return query_.side == Side::below ? outline.seen_from_above : outline.seen_from_below;
    }

    /// A piece of a chord over which the same candidates lie.
    double piece(double low, double high, double x, double y) {
        const double middle = 0.5 * (low + high);
        for (const Stretch& stretch : stretches_) {  // nearest first
            if (!(stretch.low < middle && middle < stretch.high)) {
                continue;
            }
            if (!stretch.candidate->footprint->is_level) {
                return curved_piece(low, high, x, y);
            }
            return (stretch.candidate->factor - background_) * (high - low);
        }
        return 0;
    }

    /// With a surface that is not level. The model's cap is a kink which the rule must not run across.
    double curved_piece(double low, double high, double x, double y) {
        const double middle = 0.5 * (low + high);
        const auto gap = [&](double u) {
            double least = background_m_;
            for (const Stretch& stretch : stretches_) {
                if (stretch.candidate->gap_m >= least) {
                    break;
                }
                if (stretch.low < middle && middle < stretch.high) {
                    least = std::min(least, gap_at(*stretch.candidate, x + u * du_[0], y + u * du_[1]));
                }
            }
            return least;
        };
        const auto excess = [&](double u) { return query_.factor(gap(u)) - background_; };
        if (stretches_.front().candidate->gap_m >= query_.kink_m) {
            return integral(low, high, excess);
        }
        const double nearest = nearest_between(low, high, gap);
        const double first = kink_between(low, nearest, gap);
        const double second = kink_between(high, nearest, gap);
        return integral(low, first, excess) + integral(first, second, excess) + integral(second, high, excess);
    }

    /// About where the gap is least in a piece.
    template <class Gap>
    static double nearest_between(double low, double high, const Gap& gap) {
        double least = infinity;
        double nearest = low;
        for (const double part : {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}) {
            const double u = low + part * (high - low);
            const double there = gap(u);
            if (there < least) {
                least = there;
                nearest = u;
            }
        }
        return nearest;
    }

    /// Where the gap passes the kink on the way from an end of a piece to its nearest point; the end when it does not.
    template <class Gap>
    double kink_between(double end, double nearest, const Gap& gap) const {
        const bool is_beyond = gap(nearest) > query_.kink_m;
        if ((gap(end) > query_.kink_m) == is_beyond) {
            return end;
        }
        for (int halving = 0; halving < 8; ++halving) {
            const double u = 0.5 * (end + nearest);
            ((gap(u) > query_.kink_m) == is_beyond ? nearest : end) = u;
        }
        return 0.5 * (end + nearest);
    }

    double gap_at(const Candidate& candidate, double x, double y) const {
        if (candidate.footprint->is_level) {
            return candidate.gap_m;
        }
        const Interval extent = query_.scene.vertical_extent(candidate.footprint->obstacle, x, y);
        return extent.empty() ? infinity : query_.gap(extent.low, extent.high);
    }

    void collect_breaks() {
        breaks_.push_back(-query_.radius_m);
        breaks_.push_back(query_.radius_m);
        for (const Candidate& candidate : candidates_) {
            for (const OutlineSegment& segment : candidate.footprint->outline.segments) {
                if (is_seen(segment)) {
                    break_at_segment(segment);
                }
            }
            for (const OutlineEllipse& ellipse : candidate.footprint->outline.ellipses) {
                break_at_ellipse(ellipse);
            }
        }
        std::sort(breaks_.begin(), breaks_.end());
        const double negligible = 1e-6 * query_.radius_m;
        breaks_.erase(
            std::unique(breaks_.begin(), breaks_.end(), [&](double a, double b) { return b - a < negligible; }),
            breaks_.end());
    }

    void break_at(double u, double v) {
        if (u * u + v * v < query_.radius_m * query_.radius_m) {
            breaks_.push_back(v);
        }
    }

    /// At its ends inside the disc, and where it crosses the rim.
    void break_at_segment(const OutlineSegment& segment) {
        const double au = u_of(segment.ax, segment.ay);
        const double av = v_of(segment.ax, segment.ay);
        const double du = u_of(segment.bx, segment.by) - au;
        const double dv = v_of(segment.bx, segment.by) - av;
        const double square = du * du + dv * dv;
        const double along = -(au * du + av * dv);
        const double across = au * dv - av * du;
        const double root = query_.radius_m * query_.radius_m * square - across * across;
        if (!(root > 0)) {
            return;
        }
        break_at(au, av);
        break_at(au + du, av + dv);
        for (const double s : {(along - std::sqrt(root)) / square, (along + std::sqrt(root)) / square}) {
            if (s > 0 && s < 1) {
                breaks_.push_back(std::clamp(av + s * dv, -query_.radius_m, query_.radius_m));
            }
        }
    }

    /// At its first and last chord, and where it crosses the rim.
    void break_at_ellipse(const OutlineEllipse& ellipse) {
        const double cu = u_of(ellipse.x, ellipse.y);
        const double cv = v_of(ellipse.x, ellipse.y);
        const double eu = ellipse.ux * du_[0] + ellipse.uy * du_[1];
        const double ev = ellipse.ux * dv_[0] + ellipse.uy * dv_[1];
        const double along = ellipse.along_m * ev;
        const double across = ellipse.across_m * eu;
        const double reach = std::sqrt(along * along + across * across);
        if (reach > 0) {
            const double shift = (ellipse.along_m * along * eu - ellipse.across_m * across * ev) / reach;
            break_at(cu + shift, cv + reach);
            break_at(cu - shift, cv - reach);
        }
        const double largest = std::max(ellipse.along_m, ellipse.across_m);
        const double distance = std::sqrt(cu * cu + cv * cv);
        if (distance - largest < query_.radius_m && distance + largest > query_.radius_m) {
            break_at_rim(ellipse, cu, cv, eu, ev);
        }
    }

    /// Walks once around the ellipse in sixteen steps and halves those that cross the rim.
    void break_at_rim(const OutlineEllipse& ellipse, double cu, double cv, double eu, double ev) {
        const auto position = [&](const Direction& d) {
            const double along = ellipse.along_m * d[0];
            const double across = ellipse.across_m * d[1];
            return Direction{cu + along * eu - across * ev, cv + along * ev + across * eu};
        };
        const auto beyond_rim = [&](const Direction& d) {
            const Direction p = position(d);
            return p[0] * p[0] + p[1] * p[1] - query_.radius_m * query_.radius_m;
        };
        double last = beyond_rim(sixteen_directions.back());
        for (std::size_t i = 0; i < sixteen_directions.size(); ++i) {
            const double now = beyond_rim(sixteen_directions[i]);
            if ((last < 0) != (now < 0)) {
                Direction a = sixteen_directions[(i + 15) % 16];
                Direction b = sixteen_directions[i];
                for (int halving = 0; halving < 12; ++halving) {
                    const Direction middle = between(a, b);
                    ((beyond_rim(middle) < 0) == (last < 0) ? a : b) = middle;
                }
                breaks_.push_back(std::clamp(position(a)[1], -query_.radius_m, query_.radius_m));
            }
            last = now;
        }
    }

    double u_of(double x, double y) const { return (x - query_.hub_m[0]) * du_[0] + (y - query_.hub_m[1]) * du_[1]; }
    double v_of(double x, double y) const { return (x - query_.hub_m[0]) * dv_[0] + (y - query_.hub_m[1]) * dv_[1]; }

    const DiscQuery& query_;
    double background_m_;
    double background_;
    bool is_far_ = false;
    double scale_ = 0;  ///< what makes a width one that matters
    const std::pmr::vector<Candidate>& candidates_;
    std::array<double, 2> du_{}, dv_{};
    std::pmr::vector<double> breaks_;
    std::pmr::vector<Stretch> stretches_;
    std::pmr::vector<double> cuts_;
};

/// Least gap of any obstacle over the disc's column, and the gap of the nearest level obstacle that covers the disc.
struct Nearest {
    double cover_m = infinity;
    double other_m = infinity;
};

double least_gap(const DiscQuery& query, const Footprint& footprint) {
    return query.gap(footprint.bounds.low_m[2], footprint.bounds.high_m[2]);
}

Nearest nearest_of(const DiscQuery& query, std::span<const Footprint> footprints) {
    Nearest nearest;
    for (const Footprint& footprint : footprints) {
        if (!footprint.meets_column(query.hub_m[0], query.hub_m[1], query.radius_m)) {
            continue;
        }
        const double gap = least_gap(query, footprint);
        const bool covers = footprint.is_level && footprint.covers_disc(query.hub_m[0], query.hub_m[1], query.radius_m);
        double& least = covers ? nearest.cover_m : nearest.other_m;
        least = std::min(least, gap);
    }
    return nearest;
}

double by_quadrature(const DiscQuery& query, std::span<const Footprint> footprints, double cover_m) {
    // Room for about 20 obstacles over one disc; more of them make the pool fetch memory.
    std::array<std::byte, 4096> room;
    std::pmr::monotonic_buffer_resource memory(room.data(), room.size());
    std::pmr::vector<Candidate> candidates(&memory);
    candidates.reserve(16);
    for (const Footprint& footprint : footprints) {
        const double gap = least_gap(query, footprint);
        if (gap < cover_m && footprint.meets_column(query.hub_m[0], query.hub_m[1], query.radius_m)) {
            candidates.push_back({&footprint, gap, query.factor(gap)});
        }
    }
    return DiscQuadrature(query, cover_m, candidates, &memory).average();
}

}  // namespace

double kink_of(const SurfaceEffect& effect, double max_factor) {
    double capped = 0;
    double free = 1e3;  // no model of a surface effect reaches that far
    if (surface_factor(effect, capped, max_factor) < max_factor ||
        surface_factor(effect, free, max_factor) >= max_factor) {
        return -1;
    }
    for (int halving = 0; halving < 60; ++halving) {
        const double zeta = 0.5 * (capped + free);
        (surface_factor(effect, zeta, max_factor) < max_factor ? free : capped) = zeta;
    }
    return free;
}

double disc_average(const DiscQuery& query, std::span<const Footprint> footprints) {
    const Nearest nearest = nearest_of(query, footprints);
    if (nearest.other_m >= nearest.cover_m) {
        return query.factor(nearest.cover_m);
    }
    return by_quadrature(query, footprints, nearest.cover_m);
}

}  // namespace downwash
