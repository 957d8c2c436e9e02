#include "downwash/problems/robot_sources.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr std::string_view of_urdf =
    "`downwash robot import FILE -o robot.yaml` makes a robot file in space from a URDF, SDF or MJCF "
    "(docs/robot_files.md). For a "
    "robot "
    "in a vertical plane, with one arm that turns about one joint, you write the file yourself. What becomes of the "
    "tags:\n"
    "  <mass> of the base and all that is fixed to it    multirotor.mass_kg\n"
    "  <inertia iyy> of these                            multirotor.pitch_inertia_kg_m2 (see `downwash explain "
    "inertia`)\n"
    "  <collision> of these                              multirotor.body\n"
    "  <origin xyz> of the rotors' joints                rotors.positions_m, from the multirotor's centre of mass\n"
    "  <origin xyz> of the arm's joint                   arm.joint_m, [x, z] from there\n"
    "  <mass>, <inertia iyy> of all that turns with it   arm.mass_kg, arm.inertia_kg_m2, arm.center_of_mass_m\n"
    "  <limit lower upper> in radians                    arm.limits_deg, in degrees\n"
    "  <limit effort>                                    arm.max_torque_nm\n"
    "A URDF has no rotors' thrust, power and lag, and no gains. docs/robot_files.md has an example.\n";

constexpr std::string_view of_thrust_stand =
    "`downwash robot thrust DATA.csv` computes the keys of a rotor from tables and logs of a thrust stand "
    "(docs/robot_files.md). By hand, two keys come of a table, and a step of its throttle gives a third:\n"
    "  rotors.max_thrust_n               greatest thrust of one rotor [N]; gram-force times 0.00980665\n"
    "  rotors.power_coefficient_w_n1p5   power [W] over thrust [N] to the 1.5, near the thrust of a hover\n"
    "  rotors.time_constant_s            time in which thrust comes 63 % of the way to a new command [s]\n"
    "Power is that of one rotor, voltage times current. docs/robot_files.md has an example.\n";

constexpr std::string_view of_inertia =
    "Inertias are about the pitch axis, y of the body: iyy of a URDF or of a CAD program, in kg m2. There are three "
    "keys:\n"
    "  multirotor.pitch_inertia_kg_m2          of the vehicle without its arm, about its own centre of mass\n"
    "  arm.inertia_kg_m2                       of all that turns with the arm, about its own centre of mass\n"
    "  uncertainty.vehicle.inertia_scale       how well both are known\n"
    "To join parts, use the parallel-axis rule: the sum of iyy + m d2, with d the distance in x and z of a part's "
    "centre of\n"
    "mass from the common one. A joint that Downwash does not move is frozen: its link is part of what it hangs on.\n"
    "docs/robot_files.md has an example.\n";

struct Topic {
    std::array<std::string_view, 5> words;
    std::string_view text;
};
constexpr std::array topics{
    Topic{{"urdf", "sdf", "xacro", "cad", "iyy"}, of_urdf},
    Topic{{"thrust_stand", "thrust stand", "gram_force", "gram-force", "thrust_g"}, of_thrust_stand},
    Topic{{"inertia", "inertia_kg_m2", "pitch_inertia", "pitch_inertia_kg_m2", "moment of inertia"}, of_inertia}};

}  // namespace

bool is_thrust_stand(std::string_view header) {
    std::string names(header);
    std::ranges::transform(names, names.begin(),
                           [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const auto has = [&names](std::string_view word) { return names.find(word) != std::string::npos; };
    return has("thrust") && (has("power") || has("current"));
}

std::string_view robot_source_text(std::string_view word) {
    for (const Topic& topic : topics) {
        if (std::ranges::any_of(topic.words, [&](std::string_view name) { return is_same_word(name, word); })) {
            return topic.text;
        }
    }
    return {};
}

}  // namespace downwash
