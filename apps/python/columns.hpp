#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <utility>
#include <vector>

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

/// The knots of a plan, named as in solution.json.
[[nodiscard]] NumberTable knot_table(const Plan& plan);
[[nodiscard]] NumberTable knot_table(const SpacePlan& plan);

/// Points that a user gives, in C order.
using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The number of points in an array. @throws InputError unless it has the shape (n, 2), or (n, 3) where that is allowed
[[nodiscard]] std::size_t count_points(const Points& points, bool may_be_in_world);

}  // namespace downwash::python
