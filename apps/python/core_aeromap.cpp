#include "downwash/python/core_aeromap.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/parallel.hpp"
#include "downwash/python/columns.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/python/interruptible.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::python {
namespace {

/// The index of a rotor that users count from 1. @throws InputError if there is none
int rotor_index(const FlightModel& model, int rotor) {
    const int rotors = model.tick().plant.rotor_count;
    if (rotor < 1 || rotor > rotors) {
        throw_input_error("is " + std::to_string(rotor) + ": expected a number from 1 to " + std::to_string(rotors),
                          "rotor");
    }
    return rotor - 1;
}

/// Fills an array with what of(point) gives for every row, without the interpreter lock.
template <class Result, class Of>
py::array_t<Result> at_points(const Points& points, std::size_t count, int threads, const Of& of) {
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
                         for (std::size_t k = begin; k < end; ++k) {
                             to[k] = of(from + k * width);
                         }
                     });
        return true;
    });
    return results;
}

/// The hub of a rotor in the world, from a point of the plane or of the world.
Vector3 hub_of(const FlightModel& model, int rotor, const double* at, bool is_in_world) {
    return is_in_world ? Vector3{at[0], at[1], at[2]}
                       : model.plane().to_world(at[0], model.rotor_lateral_m(rotor), at[1]);
}

py::array_t<double> factor(const CoreProblem& of, const Points& points, int rotor, int threads) {
    const FlightModel& model = *of.model();
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, true);
    if (!std::all_of(points.data(), points.data() + points.size(), [](double x) { return std::isfinite(x); })) {
        throw_input_error("hold a number that is not finite: expected finite ones", "points");
    }
    const bool is_in_world = points.shape(1) == 3;
    const DirectEffect& effect = model.effect(index);
    return at_points<double>(points, count, threads,
                             [&](const double* at) { return effect.factor(hub_of(model, index, at, is_in_world)); });
}

py::array_t<bool> is_flyable(const CoreProblem& of, const Points& points, int rotor, int threads) {
    const FlightModel& model = *of.model();
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, true);
    const bool is_in_world = points.shape(1) == 3;
    const DirectEffect& effect = model.effect(index);
    return at_points<bool>(points, count, threads,
                           [&](const double* at) { return effect.is_flyable(hub_of(model, index, at, is_in_world)); });
}

}  // namespace

const MapArrays& CoreMap::arrays_of_layer(std::size_t layer) {
    auto known = arrays.find(layer);
    if (known == arrays.end()) {
        known = arrays.emplace(layer, arrays_of(*map, layer, thread_count(0))).first;
    }
    return known->second;
}

namespace {

CoreMap built(const CoreProblem& of, int threads, const std::string& cache, const py::object& on_progress,
              const py::object& stop) {
    auto map = interruptible(stop, [&](Attendance& attendance) {
        std::function<void(double)> tell;
        if (!on_progress.is_none()) {
            tell = [&](double share) { attendance.tell([&on_progress, share] { on_progress(share); }); };
        }
        return of.model()->make_whole_map(of.problem().bounds, thread_count(threads), tell, cache,
                                          [token = attendance.token()] { return token.stop_requested(); });
    });
    return {std::move(map), of.model()};
}

/// The layers of a vehicle's map, in their order.
std::vector<MapLayer> layers_of(const Problem& problem) {
    return effect_layers(problem.robot.rotors, std::make_shared<const Scene>(problem.obstacles), problem.aero,
                         problem.plane.heading_rad())
        .layers;
}

CoreMap read(const std::string& file, const CoreProblem& of) {
    constexpr std::size_t max_bytes = std::size_t{1} << 31U;
    const Problem& problem = of.problem();
    const std::string bytes = naming(file, [&] { return read_whole_file(file, max_bytes); });
    std::optional<AeroMap> map = AeroMap::from_bytes(layers_of(problem), problem.plane,
                                                     rotor_extent(problem.robot.rotors, problem.bounds), bytes);
    if (!map) {
        throw_input_error(file +
                          " holds no aero map of this problem: it is of another scene, robot, plane, bounds or "
                          "version, or damaged. Build the map again");
    }
    return {std::make_shared<const AeroMap>(std::move(*map)), of.model()};
}

void write(const CoreMap& of, const std::string& file) {
    naming(file, [&] { write_file(file, of.map->to_bytes()); });
}

py::array_t<double> map_factor(const CoreMap& of, const Points& points, int rotor, int threads) {
    const std::size_t layer = of.model->rotor_layer(rotor_index(*of.model, rotor));
    const std::size_t count = count_points(points, false);
    return at_points<double>(points, count, threads,
                             [&](const double* at) { return of.map->factor(layer, at[0], at[1]); });
}

py::array_t<bool> map_flyable(const CoreMap& of, const Points& points, int rotor, int threads) {
    const std::size_t layer = of.model->rotor_layer(rotor_index(*of.model, rotor));
    const std::size_t count = count_points(points, false);
    return at_points<bool>(points, count, threads,
                           [&](const double* at) { return of.map->is_flyable(layer, at[0], at[1]); });
}

/// The arrays of a layer, which are made once, keep the map alive and cannot be written.
py::dict arrays_dict(const std::shared_ptr<CoreMap>& of, int rotor) {
    const MapArrays& of_layer = of->arrays_of_layer(of->model->rotor_layer(rotor_index(*of->model, rotor)));
    py::list names, formats, offsets;
    names.append("first_node"), names.append("steps_x"), names.append("steps_z");
    formats.append("u4"), formats.append("u2"), formats.append("u2");
    offsets.append(offsetof(MapCell, first_node)), offsets.append(offsetof(MapCell, steps_x)),
        offsets.append(offsetof(MapCell, steps_z));
    const py::dtype cell(names, formats, offsets, sizeof(MapCell));
    const py::object owner = py::cast(of);
    const auto array = [&owner](const py::dtype& type, std::vector<py::ssize_t> shape, const void* data) {
        py::array made(type, std::move(shape), data, owner);
        made.attr("setflags")(false);
        return made;
    };
    const std::vector<py::ssize_t> shape{of_layer.rows, of_layer.columns};
    py::dict arrays;
    arrays["cells"] = array(cell, shape, of_layer.cells.data());
    arrays["flyability"] = array(py::dtype("u1"), shape, of_layer.flyability.data());
    arrays["sides"] = array(py::dtype("u1"), shape, of_layer.sides.data());
    arrays["nodes"] = array(py::dtype("f4"), {static_cast<py::ssize_t>(of_layer.nodes.size())}, of_layer.nodes.data());
    return arrays;
}

py::tuple extent_of(const CoreMap& of) {
    const Bounds& extent = of.map->extent();
    return py::make_tuple(extent.x_low_m, extent.x_high_m, extent.z_low_m, extent.z_high_m);
}

std::optional<CoreMap> map_of(const CoreSolution& of) {
    return of.solution.map != nullptr ? std::optional(CoreMap{of.solution.map, of.of->model()}) : std::nullopt;
}

}  // namespace

void bind_aeromap(py::module_& module) {
    module.def("factor", factor);
    module.def("is_flyable", is_flyable);
    py::class_<CoreMap, std::shared_ptr<CoreMap>>(module, "AeroMap")
        .def_static("build", built)
        .def_static("read", read)
        .def_static("of_solution", map_of)
        .def("write", write)
        .def("factor", map_factor)
        .def("is_flyable", map_flyable)
        .def("arrays", arrays_dict)
        .def("extent", extent_of)
        .def("cells_per_m", [](const CoreMap& of) { return of.map->view(0).cells_per_m; })
        .def("memory_bytes", [](const CoreMap& of) { return of.map->memory_bytes(); });
}

}  // namespace downwash::python
