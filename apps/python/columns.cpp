#include "downwash/python/columns.hpp"

#include <span>
#include <string>
#include <vector>

#include "downwash/base/key_error.hpp"
#include "downwash/controllers/space_axes.hpp"

namespace downwash::python {
namespace {

template <class AnyPlan>
NumberTable table_of(const AnyPlan& plan, std::span<const Axis> axes) {
    NumberTable table;
    table.names = knot_names(axes);
    table.columns.resize(table.names.size());
    for (const auto& knot : plan.reference) {
        std::vector<double> row{static_cast<double>(knot.tick) * plan.tick_s};
        const std::vector<double> numbers = numbers_of(knot.point, axes.size());
        row.insert(row.end(), numbers.begin(), numbers.end());
        table.add_row(row);
    }
    return table;
}

}  // namespace

std::vector<std::string> knot_names(std::span<const Axis> axes) {
    std::vector<std::string> names{"t_s"};
    for (const auto name : {&Axis::position, &Axis::velocity, &Axis::acceleration}) {
        for (const Axis& axis : axes) {
            names.emplace_back(axis.*name);
        }
    }
    return names;
}

py::dict columns_of(NumberTable table) {
    py::dict columns;
    for (std::size_t i = 0; i < table.names.size(); ++i) {
        columns[py::str(table.names[i])] = array_of(std::move(table.columns[i]));
    }
    return columns;
}

NumberTable knot_table(const Plan& plan) {
    return table_of(plan, plan.axes);
}

NumberTable knot_table(const SpacePlan& plan) {
    return table_of(plan, axes_in_space(plan.joints));
}

std::size_t count_points(const Points& points, Coordinates coordinates) {
    const bool may_be_in_plane = coordinates != Coordinates::world;
    const bool may_be_in_world = coordinates != Coordinates::plane;
    const bool is_list = points.ndim() == 2;
    if (!is_list || !((may_be_in_plane && points.shape(1) == 2) || (may_be_in_world && points.shape(1) == 3))) {
        std::string shape;
        for (py::ssize_t i = 0; i < points.ndim(); ++i) {
            shape += (i > 0 ? ", " : "") + std::to_string(points.shape(i));
        }
        const std::string in_plane = may_be_in_plane ? "(n, 2), plane coordinates x, z in m" : "";
        const std::string in_world = may_be_in_world ? "(n, 3), world coordinates x, y, z in m" : "";
        throw_input_error("is an array of shape (" + shape + "): expected " + in_plane +
                              (may_be_in_plane && may_be_in_world ? ", or " : "") + in_world,
                          "points");
    }
    return static_cast<std::size_t>(points.shape(0));
}

}  // namespace downwash::python
