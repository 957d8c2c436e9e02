#include "downwash/report/robot_page.hpp"

#include <nlohmann/json.hpp>

#include "downwash/base/version.hpp"
#include "downwash/report/page_template.hpp"
#include "downwash/report/space_page_scene.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

/// Mass and inertia; of a planar robot that about y alone is known.
void add_mass(Json& json, const SpaceBody& body, bool is_planar) {
    json["mass_kg"] = body.mass_kg;
    if (is_planar) {
        json["pitch_inertia_kg_m2"] = body.inertia_kg_m2[1][1];
    } else {
        json["inertia_kg_m2"] = body.inertia_kg_m2;
    }
}

}  // namespace

std::string robot_page_data(const ShownRobot& shown, const std::string& file,
                            const std::vector<std::string>& warnings) {
    const SpacePlant& plant = shown.robot.plant;
    Json robot = robot_drawing_json(shown.robot);
    add_mass(robot["multirotor"], plant.multirotor, shown.is_planar);
    for (std::size_t i = 0; i < plant.links.size(); ++i) {
        Json& link = robot["links"][i];
        link["center_of_mass_m"] = plant.links[i].center_of_mass_m;
        add_mass(link, plant.links[i].body, shown.is_planar);
    }
    return page_data({{"schema", "downwash/robot-report/v1"},
                      {"version", version()},
                      {"file", file},
                      {"is_planar", shown.is_planar},
                      {"robot", std::move(robot)},
                      {"pose", {{"joints_rad", shown.joints_rad}}},
                      {"hover",
                       {{"middle_n", shown.hover.middle_n},
                        {"forward_n_m", shown.hover.forward_n_m},
                        {"left_n_m", shown.hover.left_n_m}}},
                      {"facts",
                       {{"mass_kg", shown.robot.mass_kg()},
                        {"thrust_to_weight", shown.thrust_to_weight},
                        {"reach_m", shown.reach_m},
                        {"hover_share", shown.hover_share},
                        {"hover_rotor", shown.hover_rotor},
                        {"hover_joints_rad", shown.hover_joints_rad}}},
                      {"warnings", warnings}});
}

std::string robot_page(const ShownRobot& shown, const std::string& file, const std::vector<std::string>& warnings) {
    return filled_page(robot_page_template(), robot_page_data(shown, file, warnings));
}

}  // namespace downwash
