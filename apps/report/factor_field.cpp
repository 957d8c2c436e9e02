#include "downwash/report/factor_field.hpp"

#include <algorithm>
#include <limits>

namespace downwash {

std::function<double(double, double)> factor_field(const MapLayer& layer, const PlaneOfMotion& plane) {
    return [layer, plane](double x_m, double z_m) {
        const Vector3 hub_m = plane.to_world(x_m, layer.lateral_m, z_m);
        return layer.effect->is_flyable(hub_m) ? layer.effect->factor(hub_m) : std::numeric_limits<double>::quiet_NaN();
    };
}

AxisRange factor_range(const FieldFigure& figure, const Bounds& problem_extent) {
    constexpr int steps = 150;
    const AxisRange whole = value_range(figure.value, problem_extent, steps, 1);
    const AxisRange shown = value_range(figure.value, figure.extent, steps, 1);
    return {std::min(whole.low, shown.low), std::max(whole.high, shown.high)};
}

}  // namespace downwash
