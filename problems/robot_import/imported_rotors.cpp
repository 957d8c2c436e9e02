#include "downwash/robot_import/imported_rotors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>

#include "downwash/base/text.hpp"
#include "downwash/robot_import/collision_bodies.hpp"

namespace downwash::robot_import {
namespace {

using Number = std::optional<double> TreeRotor::*;

std::string quoted_names(const std::vector<const TreeRotor*>& rotors) {
    constexpr std::size_t most = 6;
    std::string names =
        joined(std::vector(rotors.begin(), rotors.begin() + static_cast<std::ptrdiff_t>(std::min(most, rotors.size()))),
               ", ", [](const TreeRotor* rotor) { return "'" + excerpt(rotor->name) + "'"; });
    return (rotors.size() == 1 ? "rotor " : "rotors ") + names +
           (rotors.size() > most ? " and " + std::to_string(rotors.size() - most) + " more" : "");
}

/// Reads the numbers of all rotors, from the settings before the file.
class RotorNumbers {
 public:
    RotorNumbers(const KinematicTree& tree, Findings& findings) : tree_(tree), findings_(findings) {}

    /// One number for each rotor. @param option that gives it for all   @param hint what it is
    std::vector<double> of_each(Number number, const std::optional<double>& given, const char* option, const char* hint,
                                std::string& source) {
        if (given) {
            source = std::string("given by ") + option;
            return std::vector<double>(tree_.rotors.size(), *given);
        }
        std::vector<double> values;
        std::vector<const TreeRotor*> without;
        for (const TreeRotor& rotor : tree_.rotors) {
            if (!(rotor.*number)) {
                without.push_back(&rotor);
            }
            values.push_back((rotor.*number).value_or(0));
        }
        source = tree_.rotors.front().source;
        ask_for(without, option, hint);
        return values;
    }

    /// One number for all, the greatest where the file's differ.
    Sourced of_all(Number number, const std::optional<double>& given, const char* option, const char* hint) {
        Sourced sourced;
        const std::vector<double> values = of_each(number, given, option, hint, sourced.source);
        const auto [least, greatest] = std::ranges::minmax_element(values);
        sourced.value = *greatest;
        if (*greatest - *least > 1e-9 * *greatest) {
            findings_.warn(tree_.rotors.front().place, std::string("rotors differ in what ") + option + " sets, from " +
                                                           to_text(*least, 6) + " to " + to_text(*greatest, 6) +
                                                           ": taken is the greatest for all");
        }
        return sourced;
    }

    void ask_for(const std::vector<const TreeRotor*>& without, const char* option, const char* hint) {
        if (!without.empty()) {
            findings_.error(
                without.front()->place,
                quoted_names(without) + (without.size() == 1 ? " lacks " : " lack ") + hint + ": give " + option);
        }
    }

 private:
    const KinematicTree& tree_;
    Findings& findings_;
};

/// Radii that the file does not say, from the shapes of the rotors' links.
KinematicTree with_radii(const KinematicTree& tree, const ImportSettings& settings, Findings& findings) {
    KinematicTree known = tree;
    for (TreeRotor& rotor : known.rotors) {
        if (settings.rotor_radius_m || rotor.radius_m) {
            continue;
        }
        const double radius_m =
            disc_radius_m(tree.links[static_cast<std::size_t>(rotor.link)], settings.skips_meshes, findings);
        if (radius_m > 0) {
            rotor.radius_m = radius_m;
        }
    }
    return known;
}

std::vector<int> spins_of(const KinematicTree& tree, const ImportSettings& settings, Findings& findings) {
    std::vector<int> spins;
    if (!settings.spins.empty()) {
        if (settings.spins.size() != tree.rotors.size()) {
            findings.error(
                tree.rotors.front().place,
                "--spin has " + std::to_string(settings.spins.size()) + " numbers: expected " +
                    std::to_string(tree.rotors.size()) + ", one for each rotor, in the order " +
                    [&] { return joined(tree.rotors, ", ", [](const TreeRotor& r) { return excerpt(r.name); }); }());
            return std::vector<int>(tree.rotors.size(), 1);
        }
        return settings.spins;
    }
    std::vector<const TreeRotor*> without;
    for (const TreeRotor& rotor : tree.rotors) {
        spins.push_back(rotor.spin.value_or(1));
        if (!rotor.spin) {
            without.push_back(&rotor);
        }
    }
    RotorNumbers(tree, findings)
        .ask_for(without, "--spin 1 -1 ...", "how they turn (1 counterclockwise, seen from above, -1 clockwise)");
    return spins;
}

/// Where a rotor is and which way it pushes.
SpaceRotor placed(const TreeRotor& rotor, const RigidTransform& pose, Findings& findings) {
    SpaceRotor made;
    made.position_m = pose.placed(rotor.position_m);
    if (!has_direction(rotor.axis)) {
        findings.error(rotor.place, "rotor '" + excerpt(rotor.name) + "' has an axis without direction");
        return made;
    }
    made.axis = unit(pose.rotation * rotor.axis);
    constexpr double least_up = 0.1;
    if (made.axis[2] < least_up) {
        findings.error(
            rotor.place,
            "rotor '" + excerpt(rotor.name) + "' pushes " + (made.axis[2] < -least_up ? "downwards" : "sideways") +
                ", along " + joined(made.axis, " ", [](double x) { return to_text(x, 3); }) +
                " (forward, left, up): expected thrust upwards; are the axes mirrored, or is up another axis "
                "of the base? Then give --up and --forward");
    }
    return made;
}

}  // namespace

void name_rotors(KinematicTree& tree, const ImportSettings& settings, Findings& findings) {
    const auto names = [&tree] {
        return joined(tree.links, ", ", [](const TreeLink& link) { return excerpt(link.name); });
    };
    if (settings.rotors.empty()) {
        if (tree.rotors.empty()) {
            findings.fail({},
                          "nothing describes a rotor: expected a motor plug-in (gazebo_motor_model, "
                          "MulticopterMotorModel or ArduPilotPlugin), actuators at sites of an MJCF, or --rotors "
                          "REGEX with the names of the rotors' links, of " +
                              names());
        }
        return;
    }
    std::regex pattern;
    try {
        pattern = std::regex(settings.rotors, std::regex::ECMAScript);
    } catch (const std::regex_error&) {
        findings.fail({}, "--rotors '" + excerpt(settings.rotors) +
                              "' is no regular expression: expected one such as rotor_.* that matches whole names");
    }
    std::vector<TreeRotor> named;
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
        const int link = static_cast<int>(i), j = tree.joint_of_child(link);
        const TreeJoint* joint = j >= 0 ? &tree.joints[static_cast<std::size_t>(j)] : nullptr;
        if (!std::regex_match(tree.links[i].name, pattern) &&
            (joint == nullptr || !std::regex_match(joint->name, pattern))) {
            continue;
        }
        const auto described =
            std::ranges::find_if(tree.rotors, [link](const TreeRotor& rotor) { return rotor.link == link; });
        if (described != tree.rotors.end()) {
            named.push_back(*described);
            continue;
        }
        TreeRotor rotor;
        rotor.name = tree.links[i].name;
        rotor.place = tree.links[i].place;
        rotor.link = link;
        rotor.source = "--rotors " + settings.rotors;
        if (joint != nullptr && joint->kind != JointKind::fixed && has_direction(joint->axis)) {
            rotor.axis = joint->axis;
        }
        named.push_back(std::move(rotor));
    }
    if (named.empty()) {
        findings.fail({}, "--rotors '" + excerpt(settings.rotors) + "' matches no link and no joint of " + names());
    }
    tree.rotors = std::move(named);
}

ImportedRotors imported_rotors(const KinematicTree& tree, const ArmChain& chain, const ImportSettings& settings,
                               Findings& findings) {
    const KinematicTree known = with_radii(tree, settings, findings);
    ImportedRotors made;
    RotorNumbers numbers(known, findings);
    made.radius_m = numbers.of_all(&TreeRotor::radius_m, settings.rotor_radius_m, "--rotor-radius-m M",
                                   "a radius (half of the propeller's diameter)");
    if (!settings.rotor_radius_m) {
        made.radius_m.source = "from the shapes of " + excerpt(known.rotors.front().name);
    }
    made.max_thrust_n = numbers.of_each(&TreeRotor::max_thrust_n, settings.max_thrust_n, "--max-thrust-n N",
                                        "their greatest thrust", made.thrust_source);
    if (const std::string& how = known.rotors.front().thrust_source; !settings.max_thrust_n && !how.empty()) {
        made.thrust_source += ": " + how;
    }
    std::string ignored;
    // A motor that only pushes can also stand still.
    made.min_thrust_n = numbers.of_each(&TreeRotor::min_thrust_n, settings.min_thrust_n.value_or(0), "", "", ignored);
    const std::vector<double> torque_ratio_m =
        numbers.of_each(&TreeRotor::torque_ratio_m, settings.torque_ratio_m, "--torque-ratio-m M",
                        "a ratio of drag torque to thrust", made.torque_source);
    made.time_constant_s =
        numbers.of_all(&TreeRotor::time_constant_s, settings.time_constant_s, "--rotor-lag-s S",
                       "the lag of thrust behind its command (0.02 to 0.05 s for 7 to 15 inch; 0 for none)");
    const std::vector<int> spins = spins_of(known, settings, findings);
    made.spin_source = settings.spins.empty() ? known.rotors.front().source : "given by --spin";
    const bool has_coefficient =
        std::ranges::all_of(known.rotors, [](const TreeRotor& r) { return r.thrust_coefficient_n_s2.has_value(); });
    if (has_coefficient) {
        made.thrust_coefficient_n_s2 = numbers.of_all(&TreeRotor::thrust_coefficient_n_s2, {}, "motorConstant", "");
    }
    if (settings.power_coefficient_w_n1p5) {
        made.power_coefficient_w_n1p5 = {*settings.power_coefficient_w_n1p5, "given by --power-coefficient"};
    } else if (made.radius_m.value > 0) {
        constexpr double air_density = 1.225, figure_of_merit = 0.6;  // as of the shipped robots
        const double disc_m2 = std::numbers::pi * made.radius_m.value * made.radius_m.value;
        made.power_coefficient_w_n1p5 = {1 / (figure_of_merit * std::sqrt(2 * air_density * disc_m2)),
                                         "assumed: momentum theory with a figure of merit of 0.6"};
    }
    for (std::size_t k = 0; k < known.rotors.size(); ++k) {
        const TreeRotor& rotor = known.rotors[k];
        if (chain.part[static_cast<std::size_t>(rotor.link)] != 0) {
            findings.error(rotor.place, "rotor '" + excerpt(rotor.name) +
                                            "' is on the arm: expected rotors that are fixed to the multirotor; hold "
                                            "the joints between by --freeze JOINT=DEG");
            continue;
        }
        TreeRotor turned = rotor;
        const RigidTransform& pose = chain.pose[static_cast<std::size_t>(rotor.link)];
        if (!rotor.spin && (pose.rotation * rotor.axis)[2] < 0) {
            turned.axis = -1.0 * rotor.axis;  // a joint's axis may point either way
        }
        made.rotors.push_back(placed(turned, pose, findings));
        made.rotors.back().spin = spins[k];
        made.rotors.back().drag_torque_m = torque_ratio_m[k];
        made.names.push_back(rotor.name);
        made.links.push_back(rotor.link);
    }
    return made;
}

}  // namespace downwash::robot_import
