#include "downwash/problems/uncertainty_parameters.hpp"

#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Problem>>;
using UncertaintyRows = std::vector<Parameter<Uncertainty>>;

/// Gives a problem an uncertainty. What the problem itself says of vehicle and sensors comes after what the robot says.
Uncertainty& begin(Problem& problem) {
    Uncertainty& uncertainty = problem.uncertainty.emplace();
    if (problem.robot.uncertainty) {
        static_cast<RobotUncertainty&>(uncertainty) = *problem.robot.uncertainty;
    }
    return uncertainty;
}

/// That of a problem; the defaults where it has none.
const Uncertainty& uncertainty_of(const Problem& problem) {
    static const Uncertainty usual;
    return problem.uncertainty ? *problem.uncertainty : usual;
}
Uncertainty& uncertainty_of(Problem& problem) {
    return problem.uncertainty ? *problem.uncertainty : begin(problem);
}

template <class Part>
void nest(Rows& rows, const std::vector<Parameter<Part>>& inner_rows, std::string_view default_of) {
    for (const Parameter<Part>& inner : inner_rows) {
        rows.push_back(parameters::nested<Problem>(
            inner, "uncertainty.", [](auto& p) -> auto& { return uncertainty_of(p); }));
        if (inner.get) {
            rows.back().default_of = default_of;
        }
    }
}

UncertaintyRows aero_rows() {
    using U = Uncertainty;
    UncertaintyRows rows;
    SpreadRows<U> aero(rows, "aero", "surfaces and their effects");
    aero.add("ceiling_scale", "relative change of K - 1 below surfaces, and of a given map", 0.9, &U::ceiling_scale);
    aero.add("ground_scale", "relative change of K - 1 above surfaces", 0.9, &U::ground_scale);
    SpreadRows<U> offset(rows, "aero.scene_offset_m", "where the surfaces are, from where they are believed to be");
    offset.add("x", "along the plane [m]", 10, &U::scene_x_m);
    offset.add("z", "upwards [m]", 10, &U::scene_z_m);
    return rows;
}

UncertaintyRows wind_rows() {
    using U = Uncertainty;
    UncertaintyRows rows;
    SpreadRows<U> wind(rows, "wind", "moving air; it acts through the drag of the robot");
    SpreadRows<U> steady(rows, "wind.steady_m_s", "wind that does not change");
    steady.add("x", "along the plane [m/s]", 30, &U::wind_x_m_s);
    steady.add("z", "upwards [m/s]", 30, &U::wind_z_m_s);
    wind.add_noise("gust_m_s", "Dryden gusts along x and z", 30, &U::gust_m_s);
    rows.push_back(parameters::pair<U>(
                       "wind.gust_length_m", "length scales of the gusts; default: 3 m above ground", {"x", "z"},
                       [](auto& u) -> auto& { return u.gust_length_x_m; },
                       [](auto& u) -> auto& { return u.gust_length_z_m; })
                       .at_least(0.1)
                       .at_most(1000));
    return rows;
}

}  // namespace

void add_uncertainty_rows(Rows& rows) {
    rows.push_back(parameters::group<Problem>(
                       "uncertainty", "what is not known exactly; plans survive it. none: everything is as believed",
                       [](const Problem& p, std::size_t) { return p.uncertainty.has_value(); },
                       [](Problem& p, std::size_t, bool is_there) {
                           p.uncertainty.reset();
                           if (is_there) {
                               begin(p);
                           }
                       })
                       .or_none());
    nest(rows, aero_rows(), "");
    nest(rows, robot_uncertainty_rows(), "robot.uncertainty");
    nest(rows, wind_rows(), "");
}

}  // namespace downwash
