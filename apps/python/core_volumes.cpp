#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "downwash/base/angles.hpp"
#include "downwash/planner/space_solve.hpp"
#include "downwash/python/core_aeromap.hpp"
#include "downwash/python/core_solution.hpp"
#include "downwash/simulation/space_effect.hpp"

// Surface effects on vehicles in space: evaluated directly, and looked up in volumes.

namespace downwash::python {
namespace {

using simulation::SpaceEffect;
using EffectPointer = std::unique_ptr<SpaceEffect>;

EffectPointer direct_effect(const SpaceProblemModel& model) {
    const SpaceProblem& problem = model.problem();
    return std::make_unique<simulation::DirectSpaceEffect>(model.shared_scene(), problem.aero, problem.robot);
}

EffectPointer effect_in(const CoreVolumes& of) {
    return std::make_unique<simulation::VolumeSpaceEffect>(*of.volumes, of.model->problem().robot);
}

int rotor_index(const SpaceProblemModel& model, int rotor) {
    return python::rotor_index(static_cast<int>(model.problem().robot.plant.rotors.size()), rotor);
}

/// K at hubs of a rotor of a level vehicle with a yaw. @param make gives a SpaceEffect, for one thread at a time
template <class MakeEffect>
py::array_t<double> factors(const SpaceProblemModel& model, const Points& points, int rotor, double yaw_deg,
                            int threads, const MakeEffect& make) {
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, Coordinates::world);
    require_finite(points);
    const double yaw_rad = yaw_deg / degrees_per_radian;
    const double turned[4] = {std::cos(yaw_rad / 2), 0, 0, std::sin(yaw_rad / 2)};
    const dynamics::LaneRotation<double> attitude = dynamics::rotation_of(turned);
    return at_points<double>(points, count, threads, [&] {
        return [&, effect = make()](const double* at) {
            return effect->at_turned_rotor(index, {at[0], at[1], at[2]}, attitude).all;
        };
    });
}

template <class MakeEffect>
py::array_t<bool> flyable(const SpaceProblemModel& model, const Points& points, int rotor, int threads,
                          const MakeEffect& make) {
    const int index = rotor_index(model, rotor);
    const std::size_t count = count_points(points, Coordinates::world);
    return at_points<bool>(points, count, threads, [&] {
        return [&, effect = make()](const double* at) { return effect->is_flyable(index, {at[0], at[1], at[2]}); };
    });
}

py::array_t<double> factor(const CoreSpaceProblem& of, const Points& points, int rotor, double yaw_deg, int threads) {
    return factors(*of.model(), points, rotor, yaw_deg, threads, [&of] { return direct_effect(*of.model()); });
}

py::array_t<bool> is_flyable(const CoreSpaceProblem& of, const Points& points, int rotor, int threads) {
    return flyable(*of.model(), points, rotor, threads, [&of] { return direct_effect(*of.model()); });
}

CoreVolumes made(const CoreSpaceProblem& of, const std::string& cache) {
    return {make_volumes(*of.model(), cache), of.model()};
}

/// All volumes that there are.
std::vector<const VolumeMap*> all_of(const SurfaceVolumes& volumes) {
    std::vector<const VolumeMap*> all;
    for (const auto* each : {&volumes.rotor, &volumes.fountain, &volumes.walls}) {
        if (*each != nullptr) {
            all.push_back(each->get());
        }
    }
    for (const SurfaceVolumes::Image& image : volumes.images) {
        all.push_back(image.map.get());
    }
    return all;
}

std::size_t memory_bytes(const CoreVolumes& of) {
    std::size_t bytes = 0;
    for (const VolumeMap* each : all_of(*of.volumes)) {
        bytes += each->memory_bytes();
    }
    return bytes;
}

/// Lowest and highest coordinate along x, y and z.
std::array<double, 6> extent_of(const CoreVolumes& of) {
    const Vector3 &low_m = of.volumes->rotor->low_m(), &high_m = of.volumes->rotor->high_m();
    return {low_m[0], high_m[0], low_m[1], high_m[1], low_m[2], high_m[2]};
}

std::optional<CoreVolumes> volumes_of(const CoreSpaceSolution& of) {
    const auto& search = of.solution.search;
    return search && search->map ? std::optional(CoreVolumes{search->map, of.of->model()}) : std::nullopt;
}

}  // namespace

void bind_volumes(py::module_& module) {
    module.def("factor", factor);
    module.def("is_flyable", is_flyable);
    py::class_<CoreVolumes, std::shared_ptr<CoreVolumes>>(module, "SurfaceVolumes")
        .def_static("make", made)
        .def_static("of_solution", volumes_of)
        .def("factor",
             [](const CoreVolumes& of, const Points& points, int rotor, double yaw_deg, int threads) {
                 return factors(*of.model, points, rotor, yaw_deg, threads, [&of] { return effect_in(of); });
             })
        .def("is_flyable",
             [](const CoreVolumes& of, const Points& points, int rotor, int threads) {
                 return flyable(*of.model, points, rotor, threads, [&of] { return effect_in(of); });
             })
        .def("extent", extent_of)
        .def("memory_bytes", memory_bytes);
}

}  // namespace downwash::python
