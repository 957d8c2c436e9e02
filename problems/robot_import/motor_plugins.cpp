#include "downwash/robot_import/motor_plugins.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "downwash/base/text.hpp"

namespace downwash::robot_import {
namespace {

bool contains(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

/// "rotor_0" of "iris::rotor_0".
std::string unscoped(const std::string& name) {
    const std::size_t scope = name.rfind("::");
    return scope == std::string::npos ? name : name.substr(scope + 2);
}

/// The part of a name, whatever model it is in. -1 if there is none.
template <class Parts>
int index_of(const Parts& parts, const std::string& name) {
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (unscoped(parts[i].name) == name) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

/// One plug-in, and how to read its numbers.
class Plugin {
 public:
    Plugin(const XmlElement& element, Findings& findings) : element_(element), findings_(findings) {}

    [[nodiscard]] const Place& place() const { return element_.place; }
    [[nodiscard]] std::string text(std::string_view key) const { return element_.text_of(key).value_or(""); }
    [[nodiscard]] std::optional<double> number(std::string_view key) const {
        const XmlElement* found = element_.child(key);
        if (found == nullptr) {
            return std::nullopt;
        }
        const std::optional<double> value = number_in(found->text);
        if (!value) {
            findings_.error(found->place,
                            "<" + std::string(key) + "> is '" + excerpt(found->text) + "': expected a number");
        }
        return value;
    }
    [[nodiscard]] std::optional<double> positive(std::string_view key) const {
        const std::optional<double> value = number(key);
        if (value && *value <= 0) {
            findings_.error(element_.child(key)->place,
                            "<" + std::string(key) + "> is " + to_text(*value) + ": expected a number above 0");
            return std::nullopt;
        }
        return value;
    }
    /// The part of a list that a key names. -1, with an error, if there is none.
    template <class Find>
    [[nodiscard]] int named(const char* key, const char* what, const Find& find) const {
        const std::string name = unscoped(text(key));
        const int found = find(name);
        if (found < 0) {
            const XmlElement* at = element_.child(key);
            findings_.error(at != nullptr ? at->place : element_.place,
                            std::string("this plug-in has <") + key + "> '" + excerpt(name) +
                                "', and there is no such " + what + ": expected the name of a " + what);
        }
        return found;
    }

 private:
    const XmlElement& element_;
    Findings& findings_;
};

int link_named(const Plugin& plugin, const KinematicTree& tree, const char* key) {
    return plugin.named(key, "link", [&tree](const std::string& name) { return index_of(tree.links, name); });
}

void add_motor_model(KinematicTree& tree, const XmlElement& element, const std::string& file_name, Findings& findings) {
    const Plugin plugin(element, findings);
    if (const std::string type = plugin.text("motorType"); !type.empty() && type != "velocity") {
        return;  // a servo
    }
    TreeRotor rotor;
    rotor.link = link_named(plugin, tree, "linkName");
    if (rotor.link < 0) {
        return;
    }
    rotor.name = tree.links[static_cast<std::size_t>(rotor.link)].name;
    rotor.place = element.place;
    const std::string turning = plugin.text("turningDirection");
    if (turning == "ccw" || turning == "cw") {
        rotor.spin = turning == "ccw" ? 1 : -1;
    } else if (!turning.empty()) {
        findings.error(element.child("turningDirection")->place,
                       "<turningDirection> is '" + excerpt(turning) + "': expected cw or ccw");
    }
    rotor.thrust_coefficient_n_s2 = plugin.positive("motorConstant");
    rotor.torque_ratio_m = plugin.positive("momentConstant");
    rotor.source = file_name;
    if (const auto speed = plugin.positive("maxRotVelocity"); speed && rotor.thrust_coefficient_n_s2) {
        rotor.max_thrust_n = *rotor.thrust_coefficient_n_s2 * *speed * *speed;
        rotor.min_thrust_n = 0;
        rotor.thrust_source =
            "motorConstant " + to_text(*rotor.thrust_coefficient_n_s2) + " N s2 at " + to_text(*speed) + " rad/s";
    }
    // The slower way counts: Downwash has one lag for both.
    const auto up = plugin.positive("timeConstantUp"), down = plugin.positive("timeConstantDown");
    if (up || down) {
        rotor.time_constant_s = std::max(up.value_or(0), down.value_or(0));
    }
    for (const char* key : {"motorNumber", "actuator_number"}) {
        if (const auto number = plugin.number(key); number && *number >= 0 && *number < 1000) {
            rotor.number = static_cast<int>(*number);
        }
    }
    tree.rotors.push_back(std::move(rotor));
}

/// A blade element of the LiftDrag plug-in: lift and drag at one radius, for small angles of attack.
void add_blade(TreeRotor& rotor, double& drag_coefficient, const XmlElement& element, Findings& findings) {
    const Plugin blade(element, findings);
    const double density = blade.positive("air_density").value_or(1.2041);
    const double area = blade.positive("area").value_or(1), a0 = blade.number("a0").value_or(0);
    const double lift = blade.number("cla").value_or(1), drag = blade.number("cda").value_or(0.01);
    std::string cp = blade.text("cp");
    std::string_view rest = cp;
    double square = 0;
    for (int k = 0; k < 2; ++k) {  // from the link's z, about which it turns
        const double coordinate = number_in(take_word(rest)).value_or(0);
        square += coordinate * coordinate;
    }
    const double pressure_area = 0.5 * density * area * square;
    rotor.thrust_coefficient_n_s2 = rotor.thrust_coefficient_n_s2.value_or(0) + pressure_area * lift * a0;
    drag_coefficient += pressure_area * drag * a0 * std::sqrt(square);
}

void add_ardupilot_control(KinematicTree& tree, const XmlElement& control, const std::vector<const XmlElement*>& blades,
                           Findings& findings) {
    const Plugin plugin(control, findings);
    if (plugin.text("type") != "VELOCITY") {
        return;  // a servo
    }
    const int joint =
        plugin.named("jointName", "joint", [&tree](const std::string& name) { return index_of(tree.joints, name); });
    if (joint < 0) {
        return;
    }
    TreeRotor rotor;
    rotor.link = tree.joints[static_cast<std::size_t>(joint)].child;
    rotor.name = tree.links[static_cast<std::size_t>(rotor.link)].name;
    rotor.place = control.place;
    rotor.source = "ArduPilotPlugin and LiftDrag";
    double drag_coefficient = 0;
    for (const XmlElement* blade : blades) {
        if (unscoped(blade->text_of("link_name").value_or("")) == unscoped(rotor.name)) {
            add_blade(rotor, drag_coefficient, *blade, findings);
        }
    }
    const double multiplier = plugin.number("multiplier").value_or(0);
    if (multiplier != 0) {
        rotor.spin = multiplier > 0 ? 1 : -1;
    }
    if (rotor.thrust_coefficient_n_s2 && !(*rotor.thrust_coefficient_n_s2 > 0)) {
        findings.error(control.place, "rotor '" + excerpt(rotor.name) +
                                          "' has LiftDrag plug-ins without lift: expected cla, a0 and cp above 0");
        return;
    }
    if (rotor.thrust_coefficient_n_s2) {
        rotor.torque_ratio_m = drag_coefficient / *rotor.thrust_coefficient_n_s2;
        if (multiplier != 0) {
            rotor.max_thrust_n = *rotor.thrust_coefficient_n_s2 * multiplier * multiplier;
            rotor.min_thrust_n = 0;
            rotor.thrust_source = "lift of its blades at " + to_text(std::abs(multiplier)) + " rad/s";
        }
    }
    if (const auto channel = number_in(control.attribute("channel").value_or(""))) {
        rotor.number = static_cast<int>(*channel);
    }
    tree.rotors.push_back(std::move(rotor));
}

}  // namespace

void add_motor_plugins(KinematicTree& tree, const XmlElement& root, Findings& findings) {
    std::vector<const XmlElement*> plugins, blades;
    for_each_element(root, [&](const XmlElement& element) {
        if (element.name == "plugin") {
            const std::string file = element.attribute("filename").value_or("");
            (contains(file, "LiftDrag") || contains(file, "lift-drag") ? blades : plugins).push_back(&element);
        }
    });
    for (const XmlElement* plugin : plugins) {
        const std::string file = plugin->attribute("filename").value_or("");
        const std::string name = plugin->attribute("name").value_or("");
        if (contains(file, "motor_model") || contains(file, "multicopter-motor-model") ||
            contains(name, "MulticopterMotorModel")) {
            add_motor_model(tree, *plugin, file, findings);
        } else if (contains(file, "ArduPilotPlugin")) {
            for (const XmlElement* control : plugin->all("control")) {
                add_ardupilot_control(tree, *control, blades, findings);
            }
        }
    }
    std::ranges::stable_sort(tree.rotors, {}, [](const TreeRotor& rotor) { return rotor.number.value_or(1000); });
}

}  // namespace downwash::robot_import
