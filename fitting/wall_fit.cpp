#include "downwash/fitting/wall_fit.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <iterator>
#include <set>

#include "downwash/base/key_error.hpp"

namespace downwash {
namespace {

using Points = std::vector<WallMeasurement>;
using Component = double WallMeasurement::*;

/// The range of aero.wall.decay_radii in which a fit looks.
constexpr double min_decay_radii = 0.05, max_decay_radii = 20;

double fading(const WallMeasurement& point, double decay_radii) {
    return std::exp(-(point.distance_over_r - 1) / decay_radii);
}

/// The share that fits best with a given decay: linear least squares.
WallShare share_of(const Points& points, Component component, double decay_radii) {
    double shapes = 0;
    double products = 0;
    for (const WallMeasurement& point : points) {
        const double shape = fading(point, decay_radii);
        shapes += shape * shape;
        products += shape * point.*component;
    }
    WallShare share;
    share.value = products / shapes;
    double squares = 0;
    for (const WallMeasurement& point : points) {
        const double error = share.value * fading(point, decay_radii) - point.*component;
        squares += error * error;
        share.largest = std::max(share.largest, std::abs(point.*component));
    }
    const auto count = static_cast<double>(points.size());
    share.rmse = std::sqrt(squares / count);
    if (points.size() > 1) {
        share.standard_error = std::sqrt(squares / (count - 1) / shapes);
    }
    return share;
}

WallShares fit_with_decay(const Points& points, double decay_radii) {
    WallShares fit;
    fit.points = points.size();
    fit.force = share_of(points, &WallMeasurement::force_over_thrust, decay_radii);
    fit.moment = share_of(points, &WallMeasurement::moment_over_thrust_radius, decay_radii);
    fit.effect = {fit.force.value, fit.moment.value, decay_radii};
    return fit;
}

double best_decay_radii(const Points& points) {
    const auto rmse = [&](double log_decay) {
        return share_of(points, &WallMeasurement::moment_over_thrust_radius, std::exp(log_decay)).rmse;
    };
    // A coarse look first: Brent's method finds the minimum between three points.
    constexpr double step = 0.1;
    double best = std::log(min_decay_radii);
    for (double log_decay = best; log_decay < std::log(max_decay_radii); log_decay += step) {
        best = rmse(log_decay) < rmse(best) ? log_decay : best;
    }
    constexpr int bits = 24;
    return std::exp(boost::math::tools::brent_find_minima(rmse, best - step, best + step, bits).first);
}

}  // namespace

WallFit fit_walls(const std::vector<WallMeasurement>& measurements) {
    std::set<double> distances;
    std::set<std::string> facilities;
    for (const WallMeasurement& point : measurements) {
        distances.insert(point.distance_over_r);
        facilities.insert(point.facility);
    }
    if (distances.size() < 2) {
        throw_input_error("a wall effect needs measurements at two distances or more: these have " +
                          std::to_string(distances.size()));
    }
    WallFit fit{fit_with_decay(measurements, best_decay_radii(measurements)), {}};
    for (const std::string& facility : facilities) {
        Points own;
        std::ranges::copy_if(measurements, std::back_inserter(own),
                             [&](const WallMeasurement& point) { return point.facility == facility; });
        if (facilities.size() > 1) {
            fit.by_facility.emplace_back(facility, fit_with_decay(own, fit.effect.decay_radii));
        }
    }
    return fit;
}

}  // namespace downwash
