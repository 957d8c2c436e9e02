#include "downwash/python/core_aeromap.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "downwash/base/files.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::python {

int rotor_index(int rotors, int rotor) {
    if (rotor < 1 || rotor > rotors) {
        throw_input_error("is " + std::to_string(rotor) + ": expected a number from 1 to " + std::to_string(rotors),
                          "rotor");
    }
    return rotor - 1;
}

void require_finite(const Points& points) {
    if (!std::all_of(points.data(), points.data() + points.size(), [](double x) { return std::isfinite(x); })) {
        throw_input_error("hold a number that is not finite: expected finite ones", "points");
    }
}

namespace {

int rotor_index(const FlightModel& model, int rotor) {
    return python::rotor_index(model.tick().plant.rotor_count, rotor);
}

/// The hub of a rotor in the world, from a point of the plane or of the world.
Vector3 hub_of(const FlightModel& model, int rotor, const double* at, bool is_in_world) {
    return is_in_world ? Vector3{at[0], at[1], at[2]}
                       : model.plane().to_world(at[0], model.rotor_lateral_m(rotor), at[1]);
}

py::array_t<double> factor(const CoreProblem& of, const Points& points, int rotor, int threads) {
    const FlightModel& model = *of.model();
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, Coordinates::plane_or_world);
    require_finite(points);
    const bool is_in_world = points.shape(1) == 3;
    const DirectEffect& effect = model.effect(index);
    return at_points<double>(points, count, threads, [&] {
        return [&](const double* at) { return effect.factor(hub_of(model, index, at, is_in_world)); };
    });
}

py::array_t<bool> is_flyable(const CoreProblem& of, const Points& points, int rotor, int threads) {
    const FlightModel& model = *of.model();
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, Coordinates::plane_or_world);
    const bool is_in_world = points.shape(1) == 3;
    const DirectEffect& effect = model.effect(index);
    return at_points<bool>(points, count, threads, [&] {
        return [&](const double* at) { return effect.is_flyable(hub_of(model, index, at, is_in_world)); };
    });
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
    const std::size_t count = count_points(points, Coordinates::plane);
    return at_points<double>(points, count, threads,
                             [&] { return [&](const double* at) { return of.map->factor(layer, at[0], at[1]); }; });
}

py::array_t<bool> map_flyable(const CoreMap& of, const Points& points, int rotor, int threads) {
    const std::size_t layer = of.model->rotor_layer(rotor_index(*of.model, rotor));
    const std::size_t count = count_points(points, Coordinates::plane);
    return at_points<bool>(points, count, threads,
                           [&] { return [&](const double* at) { return of.map->is_flyable(layer, at[0], at[1]); }; });
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
    bind_volumes(module);
}

}  // namespace downwash::python
