#include "downwash/simulation/map_effect.hpp"

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::simulation {

RotorMaps rotor_maps(const FlightModel& model, const AeroMap& map) {
    const PlantModel& plant = model.tick().plant;
    RotorMaps maps{&map, {}, {}, {}, {}};
    const auto fill = [&](int place, std::size_t layer) {
        maps.view[place] = map.view(layer);
        maps.layer[place] = layer;
    };
    for (int i = 0; i < plant.rotor_count; ++i) {
        fill(i, model.rotor_layer(i));
    }
    if (plant.has_fountain) {
        fill(RotorMaps::body_place, model.body_layer());
    }
    if (plant.has_walls) {
        fill(RotorMaps::wall_place, model.wall_layer());
    }
    for (int i = 0; i < plant.rotor_count; ++i) {
        maps.same_as[i] = i;
        for (int j = i; j-- > 0;) {
            if (plant.rotor_x_m[i] == plant.rotor_x_m[j] && plant.rotor_z_m[i] == plant.rotor_z_m[j]) {
                maps.same_as[i] = j;
            }
        }
        if (maps.same_as[i] != i) {
            maps.followers[maps.same_as[i]] |= 1U << static_cast<unsigned int>(i);
        }
    }
    return maps;
}

SidedFactor<double> factor_outside(const RotorMaps& maps, int place, double x_m, double z_m) {
    return maps.map->sided_factor(maps.layer[place], x_m, z_m);
}

}  // namespace downwash::simulation
