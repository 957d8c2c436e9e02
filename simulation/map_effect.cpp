#include "downwash/simulation/map_effect.hpp"

#include "downwash/aeromap/aero_map.hpp"
#include "downwash/simulation/flight_model.hpp"

namespace downwash::simulation {

RotorMaps rotor_maps(const FlightModel& model, const AeroMap& map) {
    const PlantModel& plant = model.tick().plant;
    RotorMaps maps{&model, &map, {}, {}};
    for (int i = 0; i < plant.rotor_count + (plant.has_fountain ? 1 : 0); ++i) {
        maps.view[i] = map.view(model.rotor_layer(i));
    }
    if (plant.has_walls) {
        maps.view[plant.walls()] = map.view(model.rotor_layer(plant.walls()));
    }
    for (int i = 0; i < plant.rotor_count; ++i) {
        maps.same_as[i] = i;
        for (int j = i; j-- > 0;) {
            if (plant.rotor_x_m[i] == plant.rotor_x_m[j] && plant.rotor_z_m[i] == plant.rotor_z_m[j] &&
                map.are_equal(model.rotor_layer(i), model.rotor_layer(j))) {
                maps.same_as[i] = j;
            }
        }
    }
    return maps;
}

SidedFactor<double> factor_outside(const RotorMaps& maps, int rotor, double x_m, double z_m) {
    return maps.map->sided_factor(maps.model->rotor_layer(rotor), x_m, z_m);
}

}  // namespace downwash::simulation
