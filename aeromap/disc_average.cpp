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
        du_ = {candidates.front().footprint->chord_x, candidates.front().footprint->chord_y};
        dv_ = {-du_[1], du_[0]};
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
        const auto on_chord = [this](double v) { return chord(v); };
        const double width = (high - low) / query_.radius_m;
        if (width < 0.25) {
            return integrate(smoothed_4, low, high, on_chord);
        }
        if (width < 1) {
            return integrate(smoothed_6, low, high, on_chord);
        }
        return integrate(smoothed_8, low, high, on_chord);
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
        if (stretches_.size() == 1) {
            return piece(stretches_.front().low, stretches_.front().high, x, y);
        }
        cuts_.clear();
        for (const Stretch& stretch : stretches_) {
            cuts_.push_back(stretch.low);
            cuts_.push_back(stretch.high);
        }
        std::sort(cuts_.begin(), cuts_.end());
        double sum = 0;
        for (std::size_t i = 1; i < cuts_.size(); ++i) {
            sum += piece(cuts_[i - 1], cuts_[i], x, y);
        }
        return sum;
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

    double curved_piece(double low, double high, double x, double y) {
        const double middle = 0.5 * (low + high);
        return integrate(smoothed_6, low, high, [&](double u) {
            double gap = background_m_;
            for (const Stretch& stretch : stretches_) {
                if (stretch.candidate->gap_m >= gap) {
                    break;
                }
                if (stretch.low < middle && middle < stretch.high) {
                    gap = std::min(gap, gap_at(*stretch.candidate, x + u * du_[0], y + u * du_[1]));
                }
            }
            return query_.factor(gap) - background_;
        });
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
                break_at_segment(segment);
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

    /// At its first and last chord. Where it crosses the rim a chord's length has only a kink.
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
    }

    double u_of(double x, double y) const { return (x - query_.hub_m[0]) * du_[0] + (y - query_.hub_m[1]) * du_[1]; }
    double v_of(double x, double y) const { return (x - query_.hub_m[0]) * dv_[0] + (y - query_.hub_m[1]) * dv_[1]; }

    const DiscQuery& query_;
    double background_m_;
    double background_;
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

double disc_average(const DiscQuery& query, std::span<const Footprint> footprints) {
    const Nearest nearest = nearest_of(query, footprints);
    if (nearest.other_m >= nearest.cover_m) {
        return query.factor(nearest.cover_m);
    }
    return by_quadrature(query, footprints, nearest.cover_m);
}

}  // namespace downwash
