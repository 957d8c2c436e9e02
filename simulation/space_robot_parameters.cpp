#include "downwash/simulation/space_robot_parameters.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>

#include "downwash/base/key_error.hpp"
#include "downwash/base/parameter_factories.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/simulation/space_controller_parameters.hpp"
#include "downwash/simulation/space_world_parameters.hpp"
#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {
namespace {

using Row = Parameter<SpaceRobot>;
using Rows = std::vector<Row>;
using parameters::append;
using parameters::in;

// The same least numbers as of planar robots (robot_parameters.cpp).
constexpr double min_mass_kg = 1e-4;
constexpr double min_inertia_kg_m2 = 1e-10;
constexpr double min_length_m = 1e-4;
constexpr double min_force_n = 1e-3;
constexpr double min_torque_nm = 1e-6;

template <class Member>
Row number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<SpaceRobot>(path, description, member);
}
Row group(std::string_view path, std::string_view description) {
    return parameters::group<SpaceRobot>(path, description);
}
template <class Member>
Row vector(std::string_view path, std::string_view description, Member member) {
    return parameters::vector<SpaceRobot>(path, description, {"x", "y", "z"}, member);
}

/// An inertia as its three principal moments along the axes or, where it has products, as a matrix.
template <class Member>
Row inertia(std::string_view path, std::string_view description, Member member) {
    auto row = parameters::row<SpaceRobot>(ParameterKind::numbers, path, description);
    row.elements = {"xx", "yy", "zz"};
    row.get = [member](const SpaceRobot& robot, std::size_t i) {
        const Matrix3& m = parameters::at(member, robot, i);
        const bool is_diagonal =
            m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
        return is_diagonal ? Value(std::vector{m[0][0], m[1][1], m[2][2]})
                           : Value(std::vector<Vector3>(m.begin(), m.end()));
    };
    row.set = [member](SpaceRobot& robot, std::size_t i, const Value& value) {
        Matrix3& m = parameters::at(member, robot, i);
        if (const auto* rows = std::get_if<std::vector<Vector3>>(&value)) {
            m = {(*rows)[0], (*rows)[1], (*rows)[2]};
        } else {
            const auto& moments = std::get<std::vector<double>>(value);
            m = {{{moments[0], 0, 0}, {0, moments[1], 0}, {0, 0, moments[2]}}};
        }
    };
    return std::move(row).or_matrix().between(min_inertia_kg_m2, 1e5).is_required();
}

template <class Part>
void add_drag(Rows& rows, const std::string& of, std::string_view description, Part part) {
    append(rows, {group(of + ".drag", description),
                  number(of + ".drag.linear_n_s_m", "force per speed through the air",
                         in(part, &DragParameters::linear_n_s_m))
                      .between(0, 1e4),
                  number(of + ".drag.quadratic_n_s2_m2", "force per square of that speed",
                         in(part, &DragParameters::quadratic_n_s2_m2))
                      .between(0, 1e4)});
}

/// The solids of a body. @param list names them in a robot   @param solid names one of them
template <class List, class Solid>
void add_body(Rows& rows, const std::string& path, std::string_view description, std::string_view center, List list,
              Solid solid) {
    rows.push_back(parameters::list<SpaceRobot>(path, description, list));
    const auto shape = in(solid, &SpaceBodyShape::shape);
    const std::string at = path + "[]";
    add_shape_rows<SpaceRobot>(rows, at, shape, [&](Rows& to, const std::string& below) {
        to.push_back(vector(below + ".center_m", center, in(solid, &SpaceBodyShape::center_m)).between(-100, 100));
    });
    const auto capsule = [shape](auto member) {
        return in(in(
                      shape, [](auto& held) -> auto& { return std::get<Capsule>(held); }),
                  member);
    };
    append(rows,
           {parameters::alternative<Capsule, SpaceRobot>(at + ".capsule", "a solid cylinder with round ends", shape),
            number(at + ".capsule.radius_m", "radius", capsule(&Capsule::radius_m)).between(1e-6, 1e5).is_required(),
            vector(at + ".capsule.from_m", "one end of its axis", capsule(&Capsule::from_m)).between(-100, 100),
            vector(at + ".capsule.to_m", "the other end", capsule(&Capsule::to_m)).between(-100, 100).is_required()});
}

void add_multirotor(Rows& rows) {
    const auto body = in(&SpaceRobot::plant, &SpacePlant::multirotor);
    append(rows, {group("multirotor", "the multirotor without its arm").is_required(),
                  number("multirotor.mass_kg", "mass, rotors and battery included, arm excluded",
                         in(body, &SpaceBody::mass_kg))
                      .between(min_mass_kg, 1e4)
                      .is_required(),
                  inertia("multirotor.inertia_kg_m2", "inertia about its centre of mass, x forward, y left, z up",
                          in(body, &SpaceBody::inertia_kg_m2))});
    add_drag(rows, "multirotor", "air drag at its centre of mass; none where it is left out",
             in(&SpaceRobot::plant, &SpacePlant::drag));
    add_body(
        rows, "multirotor.body", "solids that can touch obstacles, in the body frame",
        "centre from the multirotor's centre of mass", &SpaceRobot::body,
        [](auto& robot, std::size_t i) -> auto& { return robot.body[i]; });
    std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.path == "multirotor.body"; })->required =
        true;
}

/// How many rotors a robot has; a list of another length is an error.
void require_one_each(const SpaceRobot& robot, std::size_t given, const char* what) {
    const std::size_t rotors = robot.plant.rotors.size();
    if (rotors > 0 && given != rotors) {
        throw_input_error("has " + std::to_string(given) + " " + what + (given == 1 ? "" : "s") + ": expected " +
                          std::to_string(rotors) + ", one for each rotor of positions_m");
    }
}

/// A number of each rotor, written as one where all are equal.
/// @param list names what has one element for each rotor   @param member names the number in one of them
template <class List, class Member>
Row of_rotors(std::string_view path, std::string_view description, List list, Member member) {
    auto row = parameters::row<SpaceRobot>(ParameterKind::numbers, path, description);
    row.get = [list, member](const SpaceRobot& robot, std::size_t) {
        std::vector<double> numbers;
        for (const auto& each : list(robot)) {
            numbers.push_back(member(each));
        }
        const bool are_equal = std::all_of(numbers.begin(), numbers.end(), [&](double n) { return n == numbers[0]; });
        return are_equal ? Value(numbers.empty() ? 0.0 : numbers[0]) : Value(numbers);
    };
    row.set = [list, member](SpaceRobot& robot, std::size_t, const Value& value) {
        const auto& given = std::get<std::vector<double>>(value);
        if (given.size() != 1) {
            require_one_each(robot, given.size(), "number");
        }
        for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
            member(list(robot)[k]) = given[given.size() == 1 ? 0 : k];
        }
    };
    return std::move(row).or_single();
}

constexpr auto itself = [](auto& number) -> auto& {
    return number;
};

Row positions() {
    auto row = parameters::row<SpaceRobot>(ParameterKind::points, "rotors.positions_m",
                                           "hubs from the multirotor's centre of mass");
    row.get = [](const SpaceRobot& robot, std::size_t) {
        std::vector<Vector3> hubs_m;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            hubs_m.push_back(rotor.position_m);
        }
        return Value(hubs_m);
    };
    row.set = [](SpaceRobot& robot, std::size_t, const Value& value) {
        const auto& hubs_m = std::get<std::vector<Vector3>>(value);
        robot.plant.rotors.assign(hubs_m.size(), {});
        for (std::size_t k = 0; k < hubs_m.size(); ++k) {
            robot.plant.rotors[k].position_m = hubs_m[k];
        }
        robot.min_thrust_n.assign(hubs_m.size(), 0);
        robot.max_thrust_n.assign(hubs_m.size(), 0);
    };
    return std::move(row).between(-100, 100).is_required();
}

Row axes() {
    auto row = parameters::row<SpaceRobot>(
        ParameterKind::points, "rotors.axes",
        "direction of each rotor's thrust in the body frame, of any length but zero; left out: all up");
    row.get = [](const SpaceRobot& robot, std::size_t) {
        std::vector<Vector3> directions;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            directions.push_back(rotor.axis);
        }
        return Value(directions);
    };
    row.set = [](SpaceRobot& robot, std::size_t, const Value& value) {
        const auto& directions = std::get<std::vector<Vector3>>(value);
        require_one_each(robot, directions.size(), "direction");
        for (std::size_t k = 0; k < robot.plant.rotors.size(); ++k) {
            robot.plant.rotors[k].axis = directions[k];
        }
    };
    return std::move(row).between(-1e5, 1e5);
}

Row spin() {
    auto row = parameters::row<SpaceRobot>(
        ParameterKind::numbers, "rotors.spin",
        "how each rotor turns about its axis: 1 counterclockwise, seen from where it blows from, -1 clockwise");
    row.get = [](const SpaceRobot& robot, std::size_t) {
        std::vector<double> spins;
        for (const SpaceRotor& rotor : robot.plant.rotors) {
            spins.push_back(rotor.spin);
        }
        return Value(spins);
    };
    row.set = [](SpaceRobot& robot, std::size_t, const Value& value) {
        const auto& spins = std::get<std::vector<double>>(value);
        require_one_each(robot, spins.size(), "number");
        for (std::size_t k = 0; k < spins.size(); ++k) {
            if (spins[k] != 1 && spins[k] != -1) {
                throw_input_error("has " + to_text(spins[k]) + ": expected 1 or -1");
            }
            if (k < robot.plant.rotors.size()) {
                robot.plant.rotors[k].spin = spins[k] > 0 ? 1 : -1;
            }
        }
    };
    return std::move(row).between(-1, 1).is_required();
}

void add_rotors(Rows& rows) {
    const auto of = [](auto member) { return in(&SpaceRobot::plant, member); };
    append(rows,
           {group("rotors", "the rotors, of one size").is_required(),
            number("rotors.radius_m", "radius", &SpaceRobot::rotor_radius_m).between(min_length_m, 10).is_required(),
            positions(), axes(), spin(),
            of_rotors(
                "rotors.torque_ratio_m", "torque of drag about a rotor's axis per newton of its thrust",
                [](auto& robot) -> auto& { return robot.plant.rotors; },
                [](auto& rotor) -> auto& { return rotor.drag_torque_m; })
                .between(0, 10)
                .is_required(),
            of_rotors(
                "rotors.min_thrust_n", "least thrust of one rotor in free air that can be commanded",
                [](auto& robot) -> auto& { return robot.min_thrust_n; }, itself)
                .between(0, 1e5),
            of_rotors(
                "rotors.max_thrust_n", "greatest thrust of one rotor in free air that can be commanded",
                [](auto& robot) -> auto& { return robot.max_thrust_n; }, itself)
                .between(min_force_n, 1e5)
                .is_required(),
            number("rotors.time_constant_s", "of the first-order lag of thrust behind command; 0 for none",
                   of(&SpacePlant::time_constant_s))
                .between(0, 10),
            number("rotors.power_coefficient_w_n1p5", "power of one rotor is this times its commanded thrust^1.5",
                   of(&SpacePlant::power_coefficient_w_n1p5))
                .between(1e-6, 1e6)
                .is_required(),
            number("rotors.thrust_coefficient_n_s2",
                   "thrust is this times the square of a rotor's speed in rad/s; only spinning masses need it",
                   of(&SpacePlant::thrust_coefficient_n_s2))
                .between(0, 1e3),
            number("rotors.spinning_inertia_kg_m2",
                   "moment of inertia of one rotor about its axis; 0: its spin does not matter",
                   of(&SpacePlant::rotor_inertia_kg_m2))
                .between(0, 10)});
}

/// Names a part of a link's plant, or of its limits.
template <class Member>
auto of_link(Member member) {
    return [member](auto& robot, std::size_t i) -> auto& {
        return std::invoke(member, robot.plant.links[i]);
    };
}
template <class Member>
auto of_limits(Member member) {
    return [member](auto& robot, std::size_t i) -> auto& {
        return std::invoke(member, robot.links[i]);
    };
}

Row joint_limits() {
    auto row = parameters::row<SpaceRobot>(ParameterKind::numbers, "arm.links[].limits_deg",
                                           "least and greatest angle of the joint; null: it turns without end");
    row.elements = {"lower", "upper"};
    row.nullable = true;
    row.get = [](const SpaceRobot& robot, std::size_t i) {
        const SpaceLinkLimits& link = robot.links[i];
        return link.is_limited ? Value(std::vector{link.lower_limit_rad, link.upper_limit_rad}) : Value();
    };
    row.set = [](SpaceRobot& robot, std::size_t i, const Value& value) {
        const auto* given = std::get_if<std::vector<double>>(&value);
        SpaceLinkLimits& link = robot.links[i];
        link.is_limited = given != nullptr;
        link.lower_limit_rad = given ? (*given)[0] : 0;
        link.upper_limit_rad = given ? (*given)[1] : 0;
    };
    return std::move(row).between(-3600, 3600);
}

void add_links(Rows& rows) {
    auto links = parameters::row<SpaceRobot>(ParameterKind::list, "arm.links",
                                             "the arm's links from the multirotor outward, each turned by its joint");
    links.count = [](const SpaceRobot& robot, std::size_t) {
        return std::min(robot.plant.links.size(), robot.links.size());  // they are as many in a sound robot
    };
    links.resize = [](SpaceRobot& robot, std::size_t, std::size_t count) {
        robot.plant.links.assign(count, {});
        robot.links.assign(count, {});
    };
    rows.push_back(std::move(links));
    const std::string path = "arm.links[]";
    const auto body = of_link(&SpaceLink::body);
    append(rows,
           {vector(path + ".joint_m",
                   "joint from the multirotor's centre of mass or, of further links, from the joint before, with "
                   "all joints at zero",
                   of_link(&SpaceLink::joint_m))
                .between(-100, 100)
                .is_required(),
            vector(path + ".axis", "axis about which it turns with all joints at zero, of any length but zero",
                   of_link(&SpaceLink::axis))
                .between(-1e5, 1e5),
            number(path + ".mass_kg", "mass; of the last link, end effector included", in(body, &SpaceBody::mass_kg))
                .between(min_mass_kg, 1e4)
                .is_required(),
            vector(path + ".center_of_mass_m", "centre of mass from the joint", of_link(&SpaceLink::center_of_mass_m))
                .between(-100, 100)
                .is_required(),
            inertia(path + ".inertia_kg_m2", "inertia about the link's own centre of mass",
                    in(body, &SpaceBody::inertia_kg_m2)),
            joint_limits(),
            number(path + ".max_torque_nm", "greatest torque of the joint", of_limits(&SpaceLinkLimits::max_torque_nm))
                .between(min_torque_nm, 1e5)
                .is_required(),
            group(path + ".friction", "of the joint; none where it is left out"),
            number(path + ".friction.viscous_nm_s", "torque per rad/s", of_link(&SpaceLink::viscous_friction_nm_s))
                .between(0, 1e4),
            number(path + ".friction.coulomb_nm", "torque against any motion", of_link(&SpaceLink::coulomb_friction_nm))
                .between(0, 1e4)});
    add_drag(rows, path, "air drag of the whole link in a stream across it; none where it is left out",
             of_link(&SpaceLink::drag));
    add_body(
        rows, path + ".body", "solids that can touch obstacles, in the link's axes", "centre from the joint",
        of_limits(&SpaceLinkLimits::body),
        [](auto& robot, std::size_t i) -> auto& { return robot.links[outer_element(i)].body[inner_element(i)]; });
}

/// The wash of a robot; the defaults where it has none.
const WashParameters& wash_of(const SpaceRobot& robot) {
    static const WashParameters usual;
    return robot.plant.wash ? *robot.plant.wash : usual;
}
WashParameters& wash_of(SpaceRobot& robot) {
    return robot.plant.wash ? *robot.plant.wash : robot.plant.wash.emplace();
}

void add_arm(Rows& rows) {
    const auto of = [](auto member) { return in(&SpaceRobot::plant, member); };
    rows.push_back(group("arm", "the serial arm; left out: none"));
    add_links(rows);
    append(rows,
           {vector("arm.end_effector_m",
                   "end effector from the last joint or, without links, from the multirotor's centre of mass",
                   of(&SpacePlant::end_effector_m))
                .between(-100, 100),
            vector("arm.direction", "where the end effector points with all joints at zero, of any length but zero",
                   &SpaceRobot::tool_direction)
                .between(-1e5, 1e5),
            parameters::optional_group<SpaceRobot>(
                "arm.wash",
                "slipstreams of the rotors on the links, which act through their drag; none where it is left out",
                of(&SpacePlant::wash))
                .or_none(),
            number(
                "arm.wash.scale", "speed of the slipstreams over that of momentum theory",
                [](auto& robot) -> auto& { return wash_of(robot).scale; })
                .between(0, 10)});
}

/// What a robot says of itself; the defaults where it says nothing.
const Uncertainty& uncertainty_of(const SpaceRobot& robot) {
    static const Uncertainty usual;
    return robot.uncertainty ? *robot.uncertainty : usual;
}
Uncertainty& uncertainty_of(SpaceRobot& robot) {
    return robot.uncertainty ? *robot.uncertainty : robot.uncertainty.emplace();
}

void add_uncertainty(Rows& rows) {
    rows.push_back(parameters::optional_group<SpaceRobot>(
        "uncertainty",
        "what is not known exactly of this vehicle: defaults for problems that have an uncertainty; others ignore it",
        &SpaceRobot::uncertainty));
    for (const UncertaintyKey& key : space_uncertainty_keys()) {
        if (key.is_of_robot) {
            add_uncertainty_row(
                rows, key, [](auto& r) -> auto& { return uncertainty_of(r); }, uncertain_parts_of);
        }
    }
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<SpaceRobot>("schema", "format and version of a robot file", "downwash/robot/v1"));
    rows.push_back(parameters::identifier<SpaceRobot>("name", "name of the robot", &SpaceRobot::name).is_required());
    add_multirotor(rows);
    add_rotors(rows);
    add_arm(rows);
    add_space_controller_rows(rows);
    add_uncertainty(rows);
    return rows;
}

}  // namespace

const ParameterTable<SpaceRobot>& space_robot_parameters() {
    static const ParameterTable<SpaceRobot> table(all_rows());
    return table;
}

Robot uncertain_parts_of(const SpaceRobot& robot) {
    Robot parts;
    parts.rotors.time_constant_s = robot.plant.time_constant_s;
    parts.arm.wash = robot.plant.wash;
    parts.controller.rate_hz = robot.controller.rate_hz;
    parts.controller.delay_s = robot.controller.delay_s;
    return parts;
}

}  // namespace downwash
