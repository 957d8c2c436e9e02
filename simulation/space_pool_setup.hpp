#pragma once

#include <functional>
#include <optional>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/scene/space_checker.hpp"
#include "downwash/simulation/space_loop.hpp"
#include "downwash/simulation/volume_field.hpp"

namespace downwash {

/// The effects of surfaces on a robot in space, in volumes, of models of a single rotor.
struct SpaceVolumes {
    const VolumeMap* rotor = nullptr;  ///< of K, the same for all rotors; nullptr: nothing acts on them
    const VolumeMap* walls = nullptr;  ///< of how near walls are; nullptr: they do nothing
};

/// The same to look up in.
[[nodiscard]] inline simulation::SpaceVolumeViews views_of(const SpaceVolumes& volumes) {
    simulation::SpaceVolumeViews views;
    if (volumes.rotor != nullptr) {
        views.has_rotors = true;
        views.rotor = volumes.rotor->view();
    }
    if (volumes.walls != nullptr) {
        views.has_walls = true;
        views.walls = volumes.walls->view();
    }
    return views;
}

/// What flies in a SpacePool, and under which rules: those of fly() for one flight (space_flight.hpp).
struct SpacePoolSetup {
    const SpaceRobot& robot;
    simulation::SpaceAero aero = {};
    SpaceVolumes volumes = {};              ///< surfaces in their nominal places; without them everything is flyable
    const SpaceChecker* checker = nullptr;  ///< of collisions, with obstacles in their nominal places; nullptr: none
    double margin_m = 0;                    ///< least clearance of obstacles, also between ticks, >= 0
    std::optional<double> energy_budget_j = {};  ///< a job that has spent more at its end is rejected as over_budget
    std::function<bool()> is_over = {};          ///< all threads ask it now and then; true ends flights as interrupted
};

}  // namespace downwash
