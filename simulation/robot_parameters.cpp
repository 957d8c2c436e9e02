#include "downwash/simulation/robot_parameters.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/scene/shape_parameters.hpp"
#include "downwash/simulation/uncertainty_parameters.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Robot>>;

// What is smaller than anything that flies: with these, and the upper ends of the ranges below, no number of a flight
// overflows before the flight is unstable.
constexpr double min_mass_kg = 1e-4;
constexpr double min_inertia_kg_m2 = 1e-10;
constexpr double min_length_m = 1e-4;
constexpr double min_force_n = 1e-3;
constexpr double min_torque_nm = 1e-6;

using parameters::append;
using parameters::in;

template <class Member>
Parameter<Robot> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Robot>(path, description, member);
}
Parameter<Robot> group(std::string_view path, std::string_view description) {
    return parameters::group<Robot>(path, description).is_required();
}

/// What a part says; the defaults where there is none.
template <class Part>
const Part& part_of(const std::optional<Part>& part) {
    static const Part usual;
    return part ? *part : usual;
}
template <class Part>
Part& part_of(std::optional<Part>& part) {
    return part ? *part : part.emplace();
}

/// The keys of a drag; they may be left out.
template <class Part>
void add_drag(Rows& rows, const std::string& of, std::string_view description, Part part) {
    using Drag = DragParameters;
    append(rows,
           {parameters::group<Robot>(of + ".drag", description),
            number(of + ".drag.linear_n_s_m", "force per speed through the air", in(part, &Drag::linear_n_s_m))
                .between(0, 1e4),
            number(of + ".drag.quadratic_n_s2_m2", "force per square of that speed", in(part, &Drag::quadratic_n_s2_m2))
                .between(0, 1e4)});
}

void add_multirotor(Rows& rows) {
    using Body = MultirotorParameters;
    append(
        rows,
        {group("multirotor", "the multirotor without its arm"),
         number("multirotor.mass_kg", "mass, rotors and battery included, arm excluded",
                in(&Robot::multirotor, &Body::mass_kg))
             .between(min_mass_kg, 1e4)
             .is_required(),
         number(
             "multirotor.pitch_inertia_kg_m2",
             "moment of inertia about the pitch axis, y of the body (iyy), through its centre of mass without the arm",
             in(&Robot::multirotor, &Body::pitch_inertia_kg_m2))
             .between(min_inertia_kg_m2, 1e5)
             .is_required()});
    add_drag(rows, "multirotor", "air drag at its centre of mass; none where it is left out",
             in(&Robot::multirotor, &Body::drag));
    rows.push_back(
        parameters::list<Robot>("multirotor.body", "solids that can touch obstacles, in the body frame", &Robot::body)
            .is_required());
    add_shape_rows<Robot>(
        rows, "multirotor.body[]", parameters::in_each(&Robot::body, &BodyShape::shape),
        [](Rows& to, const std::string& path) {
            to.push_back(parameters::vector<Robot>(path + ".center_m", "centre from the multirotor's centre of mass",
                                                   {"x", "y", "z"},
                                                   parameters::in_each(&Robot::body, &BodyShape::center_body_m))
                             .between(-100, 100));
        });
}

void add_rotors(Rows& rows) {
    const auto of = [](auto member) { return in(&Robot::rotors, member); };
    using Rotors = RotorParameters;
    append(rows, {group("rotors", "the rotors, all alike"),
                  number("rotors.radius_m", "radius", of(&Rotors::radius_m)).between(min_length_m, 10).is_required(),
                  parameters::points<Robot>("rotors.positions_m", "hubs from the multirotor's centre of mass",
                                            of(&Rotors::positions_m))
                      .between(-100, 100)
                      .is_required(),
                  number("rotors.min_thrust_n", "least thrust of one rotor in free air that can be commanded",
                         of(&Rotors::min_thrust_n))
                      .between(0, 1e5),
                  number("rotors.max_thrust_n", "greatest thrust of one rotor in free air that can be commanded",
                         of(&Rotors::max_thrust_n))
                      .between(min_force_n, 1e5)
                      .is_required(),
                  number("rotors.time_constant_s", "of the first-order lag of thrust behind command; 0 for none",
                         of(&Rotors::time_constant_s))
                      .between(0, 10),
                  number("rotors.power_coefficient_w_n1p5", "power of one rotor is this times its commanded thrust^1.5",
                         of(&Rotors::power_coefficient_w_n1p5))
                      .between(1e-6, 1e6)
                      .is_required()});
}

Parameter<Robot> arm_limits() {
    auto limits = parameters::numbers<Robot>(
        "arm.limits_deg",
        "least and greatest angle relative to the multirotor, the same for an arm that does not move; null turns "
        "through "
        "360 degrees",
        {"lower", "upper"},
        [](const Robot& r, std::size_t) {
            return r.arm.is_limited ? Value(std::vector{r.arm.lower_limit_rad, r.arm.upper_limit_rad}) : Value();
        },
        [](Robot&, std::size_t, const std::vector<double>&) {});
    limits.nullable = true;
    limits.set = [](Robot& r, std::size_t, const Value& value) {
        const auto* given = std::get_if<std::vector<double>>(&value);
        r.arm.is_limited = given != nullptr;
        r.arm.lower_limit_rad = given ? (*given)[0] : 0;
        r.arm.upper_limit_rad = given ? (*given)[1] : 0;
    };
    return std::move(limits).between(-3600, 3600);
}

void add_arm(Rows& rows) {
    using Arm = ArmParameters;
    const auto of = [](auto member) { return in(&Robot::arm, member); };
    append(
        rows,
        {group("arm", "the arm with its end effector, one rigid body on one joint"),
         parameters::pair<Robot>("arm.joint_m", "joint from the multirotor's centre of mass", {"x", "z"},
                                 of(&Arm::joint_x_m), of(&Arm::joint_z_m))
             .between(-100, 100),
         number("arm.length_m", "joint to end effector", of(&Arm::length_m)).between(min_length_m, 100).is_required(),
         number("arm.mass_kg", "mass, end effector included", of(&Arm::mass_kg))
             .between(min_mass_kg, 1e4)
             .is_required(),
         number("arm.center_of_mass_m", "joint to the arm's centre of mass", of(&Arm::center_of_mass_m))
             .between(0, 100)
             .is_required(),
         number("arm.inertia_kg_m2",
                "moment of inertia about the pitch axis, y of the body, through the arm's own centre of mass",
                of(&Arm::inertia_kg_m2))
             .between(min_inertia_kg_m2, 1e5)
             .is_required(),
         number("arm.radius_m", "radius of the capsule that encloses it", of(&Arm::radius_m))
             .between(min_length_m, 10)
             .is_required(),
         arm_limits(),
         number("arm.max_torque_nm", "greatest torque of the joint", of(&Arm::max_torque_nm))
             .between(min_torque_nm, 1e5)
             .is_required()});
    add_drag(rows, "arm", "air drag of the whole arm in a stream across it; none where it is left out", of(&Arm::drag));
    rows.push_back(parameters::optional_group<Robot>(
                       "arm.wash",
                       "slipstreams of the rotors on the arm, which act through its drag; none where it is left out",
                       of(&Arm::wash))
                       .or_none());
    rows.push_back(number("arm.wash.scale", "speed of the slipstreams over that of momentum theory",
                          in(in(
                                 of(&Arm::wash), [](auto& wash) -> auto& { return part_of(wash); }),
                             &WashParameters::scale))
                       .between(0, 10));
}

/// Collects the keys that a control law describes.
template <class Law>
class LawRows {
 public:
    explicit LawRows(Rows& rows) : rows_(rows) {}

    /// A key that another law has, too, is one row that serves whichever law flies the robot.
    void add(Parameter<Robot> row) {
        if constexpr (std::variant_size_v < ControlLaw >> 1) {
            row.condition = std::string("with controller.type ") + Law::name;
            row.applies = is_flown;
            const auto known =
                std::find_if(rows_.begin(), rows_.end(), [&](const auto& other) { return other.path == row.path; });
            if (known != rows_.end()) {
                *known = shared(*known, row);
                return;
            }
        }
        rows_.push_back(std::move(row));
    }
    void group(std::string_view path, std::string_view description) { add(downwash::group(below(path), description)); }
    /// Keys that need not be there.
    void optional_group(std::string_view path, std::string_view description) {
        add(parameters::group<Robot>(below(path), description));
    }
    /// Never negative.
    template <class Number>
    Parameter<Robot> gain(std::string_view path, std::string_view description, Number Law::*member) const {
        return number(path, description, member).between(0, 1e4);
    }
    template <class Number>
    Parameter<Robot> number(std::string_view path, std::string_view description, Number Law::*member) const {
        return parameters::number<Robot>(below(path), description, place(member));
    }
    /// The keys of how far a law goes, which the laws here share.
    void add_limits() {
        add(number("rotor_lead", "share by which rotors with a lag are asked for more than they lack", &Law::rotor_lead)
                .between(0, 10));
        add(number("max_tilt_deg", "the pitch reference is clipped to this", &Law::max_tilt_rad)
                .at_least(0.01)
                .below(90));
        add(number("min_vertical_force_ratio", "least vertical force of the inversion over the weight",
                   &Law::min_vertical_force_ratio)
                .between(1e-3, 1));
    }
    /// The keys of what a law has beside its loops.
    void add_aids() {
        using controllers::Aids;
        const auto aids = in(
            [](auto& robot) -> auto& { return law_of(robot); }, &Law::aids);
        const auto observer = in(aids, &Aids::observer);
        const auto feed_forward = in(aids, &Aids::feed_forward);
        const auto place_in = [](auto optional, auto member) {
            return in(in(
                          optional, [](auto& part) -> auto& { return part_of(part); }),
                      member);
        };
        using Observer = typename decltype(Aids::observer)::value_type;
        using FeedForward = typename decltype(Aids::feed_forward)::value_type;
        add(parameters::optional_group<Robot>(
            below("observer"), "observes forces and torques that the model does not explain, and counters them",
            observer));
        add(downwash::number(below("observer.gain_1_s"), "1 / time constant of the estimates",
                             place_in(observer, &Observer::gain_1_s))
                .between(1e-3, 1e4));
        add(parameters::optional_group<Robot>(
            below("feed_forward"), "divides rotor commands by the thrust ratios that a map has at the rotors",
            feed_forward));
        add(downwash::number(below("feed_forward.offset_x_m"),
                             "where the map has the surfaces, from where they nominally are",
                             place_in(feed_forward, &FeedForward::offset_x_m))
                .between(-100, 100));
        add(downwash::number(below("feed_forward.offset_z_m"), "the same along z",
                             place_in(feed_forward, &FeedForward::offset_z_m))
                .between(-100, 100));
    }
    Parameter<Robot> flag(std::string_view path, std::string_view description, bool Law::*member) const {
        return parameters::flag<Robot>(below(path), description, place(member));
    }

 private:
    static Parameter<Robot> shared(const Parameter<Robot>& other, const Parameter<Robot>& own) {
        Parameter<Robot> both = own;
        both.required = own.required && other.required;
        both.condition = other.condition + " or " + Law::name;
        both.applies = [other, own](const Robot& robot, std::size_t i) {
            return other.applies(robot, i) || own.applies(robot, i);
        };
        if (own.get) {
            both.get = [other, own](const Robot& robot, std::size_t i) {
                return (own.applies(robot, i) ? own : other).get(robot, i);
            };
            both.set = [other, own](Robot& robot, std::size_t i, const Value& value) {
                (own.applies(robot, i) ? own : other).set(robot, i, value);
            };
        }
        if (own.count) {
            both.count = [other, own](const Robot& robot, std::size_t i) {
                return (own.applies(robot, i) ? own : other).count(robot, i);
            };
            both.resize = [other, own](Robot& robot, std::size_t i, std::size_t count) {
                (own.applies(robot, i) ? own : other).resize(robot, i, count);
            };
        }
        return both;
    }
    static std::string below(std::string_view path) { return "controller." + std::string(path); }
    static bool is_flown(const Robot& robot, std::size_t /*index*/) {
        return std::holds_alternative<Law>(robot.controller.law);
    }
    /// The law's numbers; its defaults where another law flies.
    static const Law& law_of(const Robot& robot) {
        static const Law usual;
        const Law* law = std::get_if<Law>(&robot.controller.law);
        return law != nullptr ? *law : usual;
    }
    static Law& law_of(Robot& robot) { return std::get<Law>(robot.controller.law); }
    template <class Number>
    static auto place(Number Law::*member) {
        return [member](auto& robot) -> auto& {
            return law_of(robot).*member;
        };
    }

    Rows& rows_;
};

/// The key that says which law flies the robot, once there is a choice.
template <class... Laws>
void add_law_type(Rows& rows, const std::variant<Laws...>* /*laws*/) {
    auto row = parameters::row<Robot>(ParameterKind::choice, "controller.type", "law of the controller");
    row.names = {std::string_view(Laws::name)...};
    row.get = [](const Robot& robot, std::size_t) {
        return Value(std::visit([](const auto& law) { return std::string(law.name); }, robot.controller.law));
    };
    row.set = [](Robot& robot, std::size_t, const Value& value) {
        const auto take = [&]<class Law>(Law law) {
            if (std::get<std::string>(value) == Law::name) {
                robot.controller.law = law;
            }
        };
        (take(Laws{}), ...);
    };
    rows.push_back(std::move(row));
}

template <class... Laws>
void add_laws(Rows& rows, const std::variant<Laws...>* laws) {
    if constexpr (sizeof...(Laws) > 1) {
        add_law_type(rows, laws);
    }
    const auto describe = [&rows]<class Law>(const Law* /*law*/) {
        LawRows<Law> of_law(rows);
        Law::describe(of_law);
    };
    (describe(static_cast<const Laws*>(nullptr)), ...);
    // What every law has needs no condition.
    for (Parameter<Robot>& row : rows) {
        Robot robot;
        const auto applies_to = [&](const ControlLaw& law) {
            robot.controller.law = law;
            return row.applies(robot, 0);
        };
        if (row.path.starts_with("controller.") && row.applies && (applies_to(Laws{}) && ...)) {
            row.condition.clear();
            row.applies = {};
        }
    }
}

void add_controller(Rows& rows) {
    rows.push_back(group("controller", "the controllers of multirotor and arm"));
    append(rows, {number("controller.rate_hz", "control ticks per second", in(&Robot::controller, &Controller::rate_hz))
                      .between(10, 1000),
                  number("controller.delay_s", "age of the state that the controller sees, at most 64 control ticks",
                         in(&Robot::controller, &Controller::delay_s))
                      .between(0, 0.3)});
    add_laws(rows, static_cast<const ControlLaw*>(nullptr));
}

/// What a robot says of itself; the defaults where it says nothing.
const Uncertainty& uncertainty_of(const Robot& robot) {
    static const Uncertainty usual;
    return robot.uncertainty ? *robot.uncertainty : usual;
}
Uncertainty& uncertainty_of(Robot& robot) {
    return robot.uncertainty ? *robot.uncertainty : robot.uncertainty.emplace();
}

void add_uncertainty(Rows& rows) {
    rows.push_back(parameters::optional_group<Robot>(
        "uncertainty",
        "what is not known exactly of this vehicle: defaults for problems that have an uncertainty; others ignore it",
        &Robot::uncertainty));
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.is_of_robot) {
            add_uncertainty_row(
                rows, key, [](auto& r) -> auto& { return uncertainty_of(r); },
                [](const Robot& robot) -> const Robot& { return robot; });
        }
    }
}

Rows all_rows() {
    Rows rows;
    rows.push_back(parameters::constant<Robot>("schema", "format and version of a robot file", "downwash/robot/v1"));
    rows.push_back(parameters::identifier<Robot>("name", "name of the robot", &Robot::name).is_required());
    add_multirotor(rows);
    add_rotors(rows);
    add_arm(rows);
    add_controller(rows);
    add_uncertainty(rows);
    return rows;
}

}  // namespace

const ParameterTable<Robot>& robot_parameters() {
    static const ParameterTable<Robot> table(all_rows());
    return table;
}

}  // namespace downwash
