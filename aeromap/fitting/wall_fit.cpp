#include "downwash/fitting/wall_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "downwash/base/key_error.hpp"
#include "downwash/fitting/least_place.hpp"

namespace downwash {
namespace {

using WallPoints = std::vector<WallMeasurement>;
using Component = double WallMeasurement::*;

/// The range of aero.wall.decay_radii in a problem file.
constexpr double min_decay_radii = 0.05, max_decay_radii = 20;

double fading(const WallMeasurement& point, double decay_radii) {
    return std::exp(-(point.distance_over_r - 1) / decay_radii);
}

/// The share that fits best with a given decay: linear least squares. 0 where nothing is left of the wall's effect.
WallShare share_of(const WallPoints& points, Component component, double decay_radii) {
    double shapes = 0;
    double products = 0;
    for (const WallMeasurement& point : points) {
        const double shape = fading(point, decay_radii);
        shapes += shape * shape;
        products += shape * point.*component;
    }
    WallShare share;
    const bool is_felt = std::isnormal(shapes);
    share.value = is_felt ? products / shapes : 0;
    double squares = 0;
    for (const WallMeasurement& point : points) {
        const double error = share.value * fading(point, decay_radii) - point.*component;
        squares += error * error;
        share.largest = std::max(share.largest, std::abs(point.*component));
    }
    const auto count = static_cast<double>(points.size());
    share.rmse = std::sqrt(squares / count);
    if (points.size() > 1 && is_felt) {
        share.standard_error = std::sqrt(squares / (count - 1)) / std::sqrt(shapes);
    }
    return share;
}

WallShares fit_with_decay(const WallPoints& points, double decay_radii) {
    WallShares fit;
    fit.points = points.size();
    fit.force = share_of(points, &WallMeasurement::force_over_thrust, decay_radii);
    fit.moment = share_of(points, &WallMeasurement::moment_over_thrust_radius, decay_radii);
    fit.effect = {fit.force.value, fit.moment.value, decay_radii};
    return fit;
}

LeastPlace best_decay_radii(const WallPoints& points) {
    const auto rmse = [&](double decay_radii) {
        return share_of(points, &WallMeasurement::moment_over_thrust_radius, decay_radii).rmse;
    };
    return least_place(rmse, min_decay_radii, max_decay_radii);
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
    const LeastPlace decay_radii = best_decay_radii(measurements);
    WallFit fit{fit_with_decay(measurements, decay_radii.at), decay_radii.is_at_bound, {}};
    if (fit.moment.value == 0) {
        throw_input_error(
            "the moments tell no decay: they are 0, or nothing of the wall is left so far from it; expected "
            "distances in rotor radii");
    }
    for (const std::string& facility : facilities) {
        WallPoints own;
        std::ranges::copy_if(measurements, std::back_inserter(own),
                             [&](const WallMeasurement& point) { return point.facility == facility; });
        if (facilities.size() > 1) {
            fit.by_facility.emplace_back(facility, fit_with_decay(own, fit.effect.decay_radii));
        }
    }
    return fit;
}

}  // namespace downwash
