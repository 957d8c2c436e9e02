#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/simulation/surface_volumes.hpp"

namespace downwash::python {

/// An aero map and the vehicle whose rotors it is of.
struct CoreMap {
    std::shared_ptr<const AeroMap> map;
    std::shared_ptr<const FlightModel> model;
    std::map<std::size_t, MapArrays> arrays = {};  ///< of the layers that were asked for

    /// Fills the map and copies a layer, once.
    const MapArrays& arrays_of_layer(std::size_t layer);
};

/// The volumes of a problem in space, and the vehicle whose rotors they are of. They fill where they are asked.
struct CoreVolumes {
    std::shared_ptr<const SurfaceVolumes> volumes;
    std::shared_ptr<const SpaceProblemModel> model;
};

/// Registers what is for problems in space.
void bind_volumes(py::module_& module);

/// Fills an array with what is found for every row, without the interpreter lock.
/// @param make gives a function of a row, for one thread at a time
template <class Result, class Make>
py::array_t<Result> at_points(const Points& points, std::size_t count, int threads, const Make& make) {
    constexpr std::size_t batch = 2048;  // some milliseconds
    py::array_t<Result> results(static_cast<py::ssize_t>(count));
    const double* from = points.data();
    Result* to = results.mutable_data();
    const auto width = static_cast<std::size_t>(points.shape(1));
    interruptible(py::none(), [&](Attendance& attendance) {
        run_parallel((count + batch - 1) / batch, thread_count(threads),
                     [&, token = attendance.token()](std::size_t i) {
                         const std::size_t begin = i * batch,
                                           end = token.stop_requested() ? begin : std::min(count, begin + batch);
                         auto of = make();
                         for (std::size_t k = begin; k < end; ++k) {
                             to[k] = of(from + k * width);
                         }
                     });
        return true;
    });
    return results;
}

/// @throws InputError unless all coordinates are finite
void require_finite(const Points& points);

/// The index of a rotor that users count from 1. @throws InputError if there is none
[[nodiscard]] int rotor_index(int rotors, int rotor);

}  // namespace downwash::python
