#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "downwash/controllers/axes.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/controllers/space_reference.hpp"
#include "downwash/results/number_table.hpp"

namespace downwash::python {

namespace py = pybind11;

/// Values as an array that owns them, without copying.
template <class T>
py::array_t<T> array_of(std::vector<T> values) {
    auto kept = std::make_unique<std::vector<T>>(std::move(values));
    const T* data = kept->data();
    const auto size = static_cast<py::ssize_t>(kept->size());
    const py::capsule owner(kept.release(), [](void* held) { delete static_cast<std::vector<T>*>(held); });
    return py::array_t<T>(size, data, owner);
}

/// A table as a dict of arrays.
[[nodiscard]] py::dict columns_of(NumberTable table);

/// The names of a knot's numbers: t_s, then those of the axes and of their derivatives, as in solution.json.
[[nodiscard]] std::vector<std::string> knot_names(std::span<const Axis> axes);

/// The numbers of a point of a reference, in their order. @tparam Point ReferencePoint or SpacePoint
template <class Point>
[[nodiscard]] std::vector<double> numbers_of(const Point& point, std::size_t axes) {
    std::vector<double> numbers;
    for (const double* of : {point.position, point.velocity, point.acceleration}) {
        numbers.insert(numbers.end(), of, of + axes);
    }
    return numbers;
}

/// The knots of a plan, with these names.
[[nodiscard]] NumberTable knot_table(const Plan& plan);
[[nodiscard]] NumberTable knot_table(const SpacePlan& plan);

/// Points that a user gives, in C order.
using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Which coordinates points may have.
enum class Coordinates : std::uint8_t {
    plane,           ///< x, z of the plane
    plane_or_world,  ///< or x, y, z of the world
    world,           ///< x, y, z of the world
};

/// The number of points in an array. @throws InputError unless it has the shape (n, 2) or (n, 3) of such coordinates
[[nodiscard]] std::size_t count_points(const Points& points, Coordinates coordinates);

}  // namespace downwash::python
