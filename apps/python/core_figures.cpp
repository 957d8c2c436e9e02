#include <pybind11/stl.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "downwash/python/columns.hpp"
#include "downwash/python/core.hpp"
#include "downwash/report/color_scale.hpp"
#include "downwash/report/figure_colors.hpp"
#include "downwash/report/obstacle_outline.hpp"

namespace downwash::python {
namespace {

std::string text_of(const Color& color) {
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", color.red, color.green, color.blue);
    return text.data();
}

/// Rings as a list of arrays (n, 2).
py::list arrays_of(const std::vector<Ring>& rings) {
    py::list arrays;
    for (const Ring& ring : rings) {
        py::array_t<double> points({static_cast<py::ssize_t>(ring.size()), py::ssize_t{2}});
        auto at = points.mutable_unchecked<2>();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            at(static_cast<py::ssize_t>(i), 0) = ring[i].x_m;
            at(static_cast<py::ssize_t>(i), 1) = ring[i].z_m;
        }
        arrays.append(points);
    }
    return arrays;
}

/// The obstacles in the plane of motion: name, whether the plane cuts it, rings, open lines.
py::list outlines(const CoreProblem& of) {
    py::list list;
    const Scene scene(of.problem().obstacles);
    for (const ObstacleOutline& each : obstacle_outlines(scene, of.problem().plane, 0)) {
        list.append(py::make_tuple(each.name, each.is_cut, arrays_of(each.rings), arrays_of(each.lines)));
    }
    return list;
}

/// Limits and colours of the classes of thrust ratios.
py::tuple factor_colors(double low, double high) {
    const ColorScale scale = factor_scale("", {low, high});
    py::list colors;
    for (const Color& color : scale.colors) {
        colors.append(text_of(color));
    }
    return py::make_tuple(scale.limits, colors);
}

}  // namespace

void bind_figures(py::module_& module) {
    module.def("outlines", outlines);
    module.def("body_outlines",
               [](const CoreProblem& of) { return arrays_of(body_outlines(of.problem().robot.body)); });
    module.def("factor_colors", factor_colors);
    module.def("figure_style", [] {
        py::dict style;
        style["flown"] = text_of(flown_color);
        style["planned"] = text_of(planned_color);
        style["end_effector"] = text_of(end_effector_color);
        style["goal"] = text_of(goal_color);
        style["obstacle"] = text_of(obstacle_color);
        style["outline"] = text_of(outline_color);
        style["font"] = std::string(figure_font);
        return style;
    });
}

}  // namespace downwash::python
