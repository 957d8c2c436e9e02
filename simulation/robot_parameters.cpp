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

// The factories for this table's Model; the members are named by lambdas.
template <class Member>
Parameter<Robot> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Robot>(path, description, member);
}
Parameter<Robot> group(std::string_view path, std::string_view description) {
    return parameters::group<Robot>(path, description).is_required();
}

/// The keys of a drag; they may be left out.
template <class Drag>
void add_drag(Rows& rows, const std::string& of, std::string_view description, Drag drag) {
    rows.push_back(parameters::group<Robot>(of + ".drag", description));
    rows.push_back(number(
                       of + ".drag.linear_n_s_m",
                       "force per speed through the air", [drag](auto& r) -> auto& { return drag(r).linear_n_s_m; })
                       .at_least(0)
                       .at_most(1e4));
    rows.push_back(number(
                       of + ".drag.quadratic_n_s2_m2",
                       "force per square of that speed", [drag](auto& r) -> auto& { return drag(r).quadratic_n_s2_m2; })
                       .at_least(0)
                       .at_most(1e4));
}

void add_multirotor(Rows& rows) {
    rows.push_back(group("multirotor", "the multirotor without its arm"));
    rows.push_back(number(
                       "multirotor.mass_kg", "mass, rotors and battery included, arm excluded",
                       [](auto& r) -> auto& { return r.multirotor.mass_kg; })
                       .is_required()
                       .at_least(min_mass_kg)
                       .at_most(1e4));
    rows.push_back(number(
                       "multirotor.pitch_inertia_kg_m2",
                       "moment of inertia about the pitch axis through its centre of mass",
                       [](auto& r) -> auto& { return r.multirotor.pitch_inertia_kg_m2; })
                       .is_required()
                       .at_least(min_inertia_kg_m2)
                       .at_most(1e5));
    add_drag(
        rows, "multirotor", "air drag at its centre of mass; none where it is left out",
        [](auto& r) -> auto& { return r.multirotor.drag; });
    rows.push_back(parameters::list<Robot>(
                       "multirotor.body", "solids that can touch obstacles, in the body frame",
                       [](auto& r) -> auto& { return r.body; })
                       .is_required());
    add_shape_rows<Robot>(
        rows, "multirotor.body[]", [](auto& r, std::size_t i) -> auto& { return r.body[i].shape; },
        [](Rows& to, const std::string& path) {
            to.push_back(parameters::vector<Robot>(
                             path + ".center_m", "centre from the multirotor's centre of mass", {"x", "y", "z"},
                             [](auto& r, std::size_t i) -> auto& { return r.body[i].center_body_m; })
                             .at_least(-100)
                             .at_most(100));
        });
}

void add_rotors(Rows& rows) {
    rows.push_back(group("rotors", "the rotors, all alike"));
    rows.push_back(number(
                       "rotors.radius_m", "radius", [](auto& r) -> auto& { return r.rotors.radius_m; })
                       .is_required()
                       .at_least(min_length_m)
                       .at_most(10));
    rows.push_back(parameters::points<Robot>(
                       "rotors.positions_m", "hubs from the multirotor's centre of mass",
                       [](auto& r) -> auto& { return r.rotors.positions_m; })
                       .is_required()
                       .at_least(-100)
                       .at_most(100));
    rows.push_back(number(
                       "rotors.min_thrust_n", "least thrust of one rotor in free air that can be commanded",
                       [](auto& r) -> auto& { return r.rotors.min_thrust_n; })
                       .at_least(0)
                       .at_most(1e5));
    rows.push_back(number(
                       "rotors.max_thrust_n", "greatest thrust of one rotor in free air that can be commanded",
                       [](auto& r) -> auto& { return r.rotors.max_thrust_n; })
                       .is_required()
                       .at_least(min_force_n)
                       .at_most(1e5));
    rows.push_back(number(
                       "rotors.time_constant_s", "of the first-order lag of thrust behind command; 0 for none",
                       [](auto& r) -> auto& { return r.rotors.time_constant_s; })
                       .at_least(0)
                       .at_most(10));
    rows.push_back(number(
                       "rotors.power_coefficient_w_n1p5", "power of one rotor is this times its commanded thrust^1.5",
                       [](auto& r) -> auto& { return r.rotors.power_coefficient_w_n1p5; })
                       .is_required()
                       .at_least(1e-6)
                       .at_most(1e6));
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
    return std::move(limits).at_least(-3600).at_most(3600);
}

void add_arm(Rows& rows) {
    rows.push_back(group("arm", "the arm with its end effector, one rigid body on one joint"));
    rows.push_back(parameters::pair<Robot>(
                       "arm.joint_m", "joint from the multirotor's centre of mass", {"x", "z"},
                       [](auto& r) -> auto& { return r.arm.joint_x_m; },
                       [](auto& r) -> auto& { return r.arm.joint_z_m; })
                       .at_least(-100)
                       .at_most(100));
    rows.push_back(number(
                       "arm.length_m", "joint to end effector", [](auto& r) -> auto& { return r.arm.length_m; })
                       .is_required()
                       .at_least(min_length_m)
                       .at_most(100));
    rows.push_back(number(
                       "arm.mass_kg", "mass, end effector included", [](auto& r) -> auto& { return r.arm.mass_kg; })
                       .is_required()
                       .at_least(min_mass_kg)
                       .at_most(1e4));
    rows.push_back(number(
                       "arm.center_of_mass_m", "joint to the arm's centre of mass",
                       [](auto& r) -> auto& { return r.arm.center_of_mass_m; })
                       .is_required()
                       .at_least(0)
                       .at_most(100));
    rows.push_back(number(
                       "arm.inertia_kg_m2", "moment of inertia about the arm's own centre of mass",
                       [](auto& r) -> auto& { return r.arm.inertia_kg_m2; })
                       .is_required()
                       .at_least(min_inertia_kg_m2)
                       .at_most(1e5));
    rows.push_back(
        number(
            "arm.radius_m", "radius of the capsule that encloses it", [](auto& r) -> auto& { return r.arm.radius_m; })
            .is_required()
            .at_least(min_length_m)
            .at_most(10));
    rows.push_back(arm_limits());
    rows.push_back(
        number(
            "arm.max_torque_nm", "greatest torque of the joint", [](auto& r) -> auto& { return r.arm.max_torque_nm; })
            .is_required()
            .at_least(min_torque_nm)
            .at_most(1e5));
    add_drag(
        rows, "arm", "air drag of the whole arm in a stream across it; none where it is left out",
        [](auto& r) -> auto& { return r.arm.drag; });
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
        return number(path, description, member).at_least(0).at_most(1e4);
    }
    template <class Number>
    Parameter<Robot> number(std::string_view path, std::string_view description, Number Law::*member) const {
        return parameters::number<Robot>(below(path), description, place(member));
    }
    /// The keys of how far a law goes, which the laws here share.
    void add_limits() {
        add(number("rotor_lead", "share by which rotors with a lag are asked for more than they lack", &Law::rotor_lead)
                .at_least(0)
                .at_most(10));
        add(number("max_tilt_deg", "the pitch reference is clipped to this", &Law::max_tilt_rad)
                .at_least(0.01)
                .below(90));
        add(number("min_vertical_force_ratio", "least vertical force of the inversion over the weight",
                   &Law::min_vertical_force_ratio)
                .at_least(1e-3)
                .at_most(1));
    }
    /// The keys of what a law has beside its loops.
    void add_aids() {
        const auto observer = [](auto& robot) -> auto& {
            return law_of(robot).aids.observer;
        };
        const auto feed_forward = [](auto& robot) -> auto& {
            return law_of(robot).aids.feed_forward;
        };
        add(parameters::optional_group<Robot>(
            below("observer"), "observes forces and torques that the model does not explain, and counters them",
            observer));
        add(parameters::number<Robot>(
                below("observer.gain_1_s"), "1 / time constant of the estimates",
                [observer](auto& robot) -> auto& { return part_of(observer(robot)).gain_1_s; })
                .at_least(1e-3)
                .at_most(1e4));
        add(parameters::optional_group<Robot>(
            below("feed_forward"), "divides rotor commands by the thrust ratios that a map has at the rotors",
            feed_forward));
        add(parameters::number<Robot>(
                below("feed_forward.offset_x_m"), "where the map has the surfaces, from where they are believed to be",
                [feed_forward](auto& robot) -> auto& { return part_of(feed_forward(robot)).offset_x_m; })
                .at_least(-100)
                .at_most(100));
        add(parameters::number<Robot>(
                below("feed_forward.offset_z_m"), "the same along z",
                [feed_forward](auto& robot) -> auto& { return part_of(feed_forward(robot)).offset_z_m; })
                .at_least(-100)
                .at_most(100));
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
    /// What a part says; the defaults where there is none.
    template <class Part>
    static const Part& part_of(const std::optional<Part>& part) {
        static const Part usual;
        return part ? *part : usual;
    }
    template <class Part>
    static Part& part_of(std::optional<Part>& part) {
        return part ? *part : part.emplace();
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
    rows.push_back(
        number(
            "controller.rate_hz", "control ticks per second", [](auto& r) -> auto& { return r.controller.rate_hz; })
            .at_least(10)
            .at_most(1000));
    rows.push_back(number(
                       "controller.delay_s", "age of the state that the controller sees, at most three control ticks",
                       [](auto& r) -> auto& { return r.controller.delay_s; })
                       .at_least(0)
                       .at_most(0.3));
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
        [](auto& r) -> auto& { return r.uncertainty; }));
    for (const UncertaintyKey& key : uncertainty_keys()) {
        if (key.is_of_robot) {
            add_uncertainty_row(
                rows, key, [](auto& r) -> auto& { return uncertainty_of(r); });
        }
    }
}

Rows all_rows() {
    Rows rows;
    rows.push_back(parameters::constant<Robot>("schema", "format and version of a robot file", "downwash/robot/v1"));
    rows.push_back(parameters::identifier<Robot>(
                       "name", "name of the robot", [](auto& r) -> auto& { return r.name; })
                       .is_required());
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
