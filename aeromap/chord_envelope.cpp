#include "downwash/aeromap/chord_envelope.hpp"

#include <algorithm>

#include "downwash/aeromap/gauss_rule.hpp"

namespace downwash {
namespace {

/// Lines over one piece of a chord change places at most as often; more is rounding.
constexpr int max_splits = 16;

}  // namespace

double mean_factor(const DiscQuery& query, double one_m, double other_m) {
    if (query.mean != nullptr) {
        return (*query.mean)(one_m / query.unit_m, other_m / query.unit_m);
    }
    const auto there = [&query](double gap_m) { return query.factor(gap_m); };
    const double low = std::min(one_m, other_m);
    const double high = std::max(one_m, other_m);
    if (high - low < 1e-3 * query.unit_m) {
        return query.factor(0.5 * (low + high));
    }
    // The model's cap is a kink which the rule must not run across.
    const double kink = std::clamp(query.kink_m(), low, high);
    return (integrate(plain_6, low, kink, there) + integrate(plain_6, kink, high, there)) / (high - low);
}

ChordEnvelope::ChordEnvelope(const DiscQuery& query, double background_m, std::pmr::memory_resource* memory)
    : query_(query),
      background_m_(background_m),
      background_(query.factor(background_m)),
      stretches_(memory),
      cuts_(memory),
      open_(memory) {}

/// Walks along the chord from cut to cut with the stretches that lie there.
double ChordEnvelope::excess() {
    if (stretches_.empty()) {
        return 0;
    }
    std::sort(stretches_.begin(), stretches_.end(),
              [](const SurfaceStretch& a, const SurfaceStretch& b) { return a.low < b.low; });
    const auto meets_next = [](const SurfaceStretch& a, const SurfaceStretch& b) { return b.low < a.high; };
    if (std::adjacent_find(stretches_.begin(), stretches_.end(), meets_next) == stretches_.end()) {
        double sum = 0;
        for (const SurfaceStretch& stretch : stretches_) {
            open_.assign(1, stretch);
            sum += between(stretch.low, stretch.high, first_at(stretch.low), first_at(stretch.high), max_splits);
        }
        return sum;
    }
    cuts_.clear();
    for (const SurfaceStretch& stretch : stretches_) {
        cuts_.push_back(stretch.low);
        cuts_.push_back(stretch.high);
    }
    std::sort(cuts_.begin(), cuts_.end());
    open_.clear();
    std::size_t next = 0;
    double sum = 0;
    for (std::size_t i = 1; i < cuts_.size(); ++i) {
        const double low = cuts_[i - 1];
        const double high = cuts_[i];
        for (; next < stretches_.size() && stretches_[next].low <= low; ++next) {
            open_.push_back(stretches_[next]);
        }
        std::erase_if(open_, [&](const SurfaceStretch& stretch) { return stretch.high <= low; });
        if (low < high && !open_.empty()) {
            sum += between(low, high, first_at(low), first_at(high), max_splits);
        }
    }
    return sum;
}

double ChordEnvelope::gap_of(std::size_t stretch, double u) const {
    return stretch < open_.size() ? open_[stretch].gap_at(u) : background_m_;
}

ChordEnvelope::First ChordEnvelope::first_at(double u) const {
    First first{open_.size(), background_m_};
    for (std::size_t i = 0; i < open_.size(); ++i) {
        const double gap = open_[i].gap_at(u);
        if (gap < first.gap) {
            first = {i, gap};
        }
    }
    return first;
}

/// A line that is first at both ends is first all the way; otherwise the two that are meet each other or a third one.
double ChordEnvelope::between(double low, double high, First at_low, First at_high, int splits) const {
    const double other_low = gap_of(at_high.stretch, low);
    const double other_high = gap_of(at_low.stretch, high);
    if (at_low.stretch == at_high.stretch || !(other_high > at_high.gap)) {
        return straight(low, high, at_low.gap, other_high);
    }
    if (!(other_low > at_low.gap)) {
        return straight(low, high, other_low, at_high.gap);
    }
    const double lead = other_low - at_low.gap;
    const double lag = other_high - at_high.gap;
    const double meeting = low + (high - low) * (lead / (lead + lag));
    const double gap = gap_of(at_low.stretch, meeting);
    const First first = splits > 0 ? first_at(meeting) : First{at_low.stretch, gap};
    constexpr double negligible_m = 1e-12;
    if (first.gap > gap - negligible_m) {
        return straight(low, meeting, at_low.gap, gap) + straight(meeting, high, gap, at_high.gap);
    }
    return between(low, meeting, at_low, first, splits - 1) + between(meeting, high, first, at_high, splits - 1);
}

double ChordEnvelope::straight(double low, double high, double gap_low, double gap_high) const {
    return (high - low) * (mean_factor(query_, gap_low, gap_high) - background_);
}

}  // namespace downwash
