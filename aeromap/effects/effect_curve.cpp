#include "downwash/effects/effect_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/effects/effect_table.hpp"

namespace downwash {
namespace {

// Where the largest change is bounded from samples: distances q^i * nearest, up to `farthest`.
constexpr double nearest = 0.01;
constexpr double farthest = 1000;  // no surface effect reaches that far
constexpr double ratio = 1.01;

std::vector<double> sample_distances() {
    std::vector<double> distances{0};
    for (double zeta = nearest; zeta < farthest; zeta *= ratio) {
        distances.push_back(zeta);
    }
    return distances;
}

const std::vector<double>& samples() {
    static const std::vector<double> distances = sample_distances();
    return distances;
}

}  // namespace

EffectCurve::EffectCurve(SurfaceEffect effect, double max_factor, RotorNeighbours neighbours)
    : effect_(std::move(effect)), neighbours_(std::move(neighbours)), max_factor_(max_factor) {
    effect_.file.clear();  // so that at_wall() copies without allocating
    prepare();
}

EffectCurve EffectCurve::fountain(const SurfaceEffect& effect, double max_factor, const RotorNeighbours& neighbours) {
    EffectCurve curve(effect, max_factor, neighbours);
    curve.kind_ = Kind::fountain;
    curve.prepare();
    return curve;
}

EffectCurve EffectCurve::image(double distance_radii, double max_factor) {
    EffectCurve curve(EffectModel::multirotor_images, max_factor);
    curve.kind_ = Kind::image;
    curve.image_distance_radii_ = distance_radii;
    curve.prepare();
    return curve;
}

double EffectCurve::clamped(double factor) const noexcept {
    return lane::clamp(factor, effect_.model == EffectModel::table ? 0.0 : 1.0, max_factor_);
}

double EffectCurve::operator()(double z_over_r) const {
    if (kind_ == Kind::image) {
        return z_over_r < infinity ? clamped(1 + image_loss(z_over_r, image_distance_radii_)) : 1;
    }
    const double factor = clamped(formula_factor(effect_, z_over_r, neighbours_));
    if (kind_ == Kind::rotor) {
        return factor;
    }
    return 1 + factor - clamped(formula_factor(EffectModel::multirotor_images, z_over_r, neighbours_));
}

void EffectCurve::prepare() {
    const std::vector<double>& distances = samples();
    std::vector<double> factors(distances.size());
    std::transform(distances.begin(), distances.end(), factors.begin(), [this](double zeta) { return (*this)(zeta); });
    falls_with_distance_ = effect_.model != EffectModel::table &&
                           std::is_sorted(factors.begin(), factors.end(), std::greater<>()) && factors.back() >= 1;
    changes_.reset();
    if (!falls_with_distance_ && effect_.model != EffectModel::table) {
        std::vector<double> changes(factors.size());
        double largest = 0;
        for (std::size_t i = factors.size(); i-- > 0;) {
            largest = std::max(largest, std::abs(factors[i] - 1));
            changes[i] = largest;
        }
        changes_ = std::make_shared<const std::vector<double>>(std::move(changes));
    }

    cap_distance_ = -1;
    for (std::size_t i = factors.size() - 1; i-- > 0;) {
        if (factors[i] >= max_factor_ && factors[i + 1] < max_factor_) {
            double capped = distances[i];
            double free = distances[i + 1];
            for (int halving = 0; halving < 60; ++halving) {
                const double zeta = 0.5 * (capped + free);
                ((*this)(zeta) < max_factor_ ? free : capped) = zeta;
            }
            cap_distance_ = free;
            break;
        }
    }
    flat_distance_ = is_none() ? -1 : factors.back() >= max_factor_ ? farthest : cap_distance_;
    if (effect_.model == EffectModel::table) {
        const EffectTable& table = *effect_.table;
        flat_distance_ = std::max(flat_distance_, table.z_over_r().front());
        if (depends_on_wall()) {
            flat_distance_ = std::max(flat_distance_, table.distance_below(max_factor_));
        }
    }
}

bool EffectCurve::depends_on_wall() const noexcept {
    return effect_.model == EffectModel::table && effect_.table->depends_on_d() && !effect_.d_over_r;
}

EffectCurve EffectCurve::at_wall(double d_over_r) const {
    EffectCurve curve = *this;
    curve.effect_.d_over_r = d_over_r;
    return curve;
}

double EffectCurve::largest_change_beyond(double z_over_r) const {
    if (effect_.model == EffectModel::table) {
        return effect_.table->largest_change_beyond(z_over_r);
    }
    if (falls_with_distance_) {
        return (*this)(z_over_r)-1;
    }
    // The curve between two samples, a percent apart, may stand out of both a little.
    constexpr double allowance = 1.05;
    const std::vector<double>& distances = samples();
    const auto above = std::upper_bound(distances.begin(), distances.end(), z_over_r);
    return allowance * (*changes_)[static_cast<std::size_t>(above - distances.begin()) - 1];
}

double EffectCurve::largest_difference(double near, double far) const {
    if (falls_with_distance_) {
        return (*this)(near) - (*this)(far);
    }
    return largest_change_beyond(near) + std::abs((*this)(far)-1);
}

}  // namespace downwash
