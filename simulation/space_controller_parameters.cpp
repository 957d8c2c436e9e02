#include "downwash/simulation/space_controller_parameters.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "downwash/base/parameter_factories.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<SpaceRobot>>;

/// Names of the laws in files, in the order of SpaceLaw.
constexpr std::string_view law_names[] = {SpaceInversion::name, Px4Cascade::name};
static_assert(std::size(law_names) == std::variant_size_v<SpaceLaw>);

/// The rows of one law, below `controller`.
template <class Law>
class LawRows {
 public:
    explicit LawRows(Rows& rows) : rows_(rows) {}

    /// Keys that files with this law must have.
    void group(std::string_view path, std::string_view description) {
        add(parameters::group<SpaceRobot>(below(path), description).is_required());
    }
    /// A gain that a file has to say.
    template <class Member>
    void gain(std::string_view path, std::string_view description, Member member) {
        add(number(path, description, member).between(0, 1e4).is_required());
    }
    /// A gain that may be left out.
    template <class Member>
    void optional_gain(std::string_view path, std::string_view description, Member member) {
        add(number(path, description, member).between(0, 1e4));
    }
    template <class Member>
    void limit(std::string_view path, std::string_view description, double low, double high, Member member) {
        add(number(path, description, member).between(low, high));
    }
    template <class Member>
    void flag(std::string_view path, std::string_view description, Member member) {
        add(parameters::flag<SpaceRobot>(below(path), description, of(member)));
    }
    /// The gains of a loop from position to acceleration. @param unit of the
    /// integral's limit: "m_s2" or "rad_s2"
    template <class Member>
    void loop(std::string_view path, std::string_view description, std::string_view unit, Member member) {
        const std::string at(path);
        const auto gains = [member](auto gain) {
            return [ member, gain ](auto& law) -> auto& {
                return std::invoke(member, law).*gain;
            };
        };
        group(path, description);
        gain(at + ".kp", "acceleration per position error", gains(&SpaceLoopGains::kp_1_s2));
        gain(at + ".kd", "acceleration per speed error", gains(&SpaceLoopGains::kd_1_s));
        optional_gain(at + ".ki", "acceleration per integral of the position error", gains(&SpaceLoopGains::ki_1_s3));
        limit(at + ".integral_limit_" + std::string(unit), "most that the integral adds", 0, 1e4,
              gains(&SpaceLoopGains::integral_limit));
    }

    /// The gains of a loop from velocity or rate to acceleration; all have
    /// defaults.
    template <class Member>
    void rate_loop(std::string_view path, std::string_view description, std::string_view unit, Member member) {
        const std::string at(path);
        const auto gains = [member](auto gain) {
            return [ member, gain ](auto& law) -> auto& {
                return std::invoke(member, law).*gain;
            };
        };
        optional_group(path, description);
        optional_gain(at + ".kp", "acceleration per error", gains(&SpaceRateGains::kp_1_s));
        optional_gain(at + ".ki", "acceleration per integral of the error", gains(&SpaceRateGains::ki_1_s2));
        optional_gain(at + ".kd", "acceleration per measured acceleration, against it", gains(&SpaceRateGains::kd));
        limit(at + ".integral_limit_" + std::string(unit), "most that the integral adds", 0, 1e4,
              gains(&SpaceRateGains::integral_limit));
    }
    /// Keys that need not be there.
    void optional_group(std::string_view path, std::string_view description) {
        add(parameters::group<SpaceRobot>(below(path), description));
    }
    template <class Member>
    void vector(std::string_view path, std::string_view description, Member member) {
        add(parameters::vector<SpaceRobot>(below(path), description, {"x", "y", "z"}, of(member)).between(-100, 100));
    }

 private:
    static std::string below(std::string_view path) { return "controller." + std::string(path); }
    static constexpr std::size_t law_index() {
        return std::is_same_v<Law, std::variant_alternative_t<0, SpaceLaw>> ? 0 : 1;
    }
    static bool is_flown(const SpaceRobot& robot, std::size_t /*index*/) {
        return std::holds_alternative<Law>(robot.controller.law);
    }
    /// The law's numbers; its defaults where another law flies.
    static const Law& law_of(const SpaceRobot& robot) {
        static const Law usual;
        const Law* law = std::get_if<Law>(&robot.controller.law);
        return law != nullptr ? *law : usual;
    }
    static Law& law_of(SpaceRobot& robot) { return std::get<Law>(robot.controller.law); }
    template <class Member>
    static auto of(Member member) {
        return [member](auto& robot) -> auto& {
            return std::invoke(member, law_of(robot));
        };
    }
    template <class Member>
    static Parameter<SpaceRobot> number(std::string_view path, std::string_view description, Member member) {
        return parameters::number<SpaceRobot>(below(path), description, of(member));
    }
    void add(Parameter<SpaceRobot> row) {
        const std::string law(law_names[law_index()]);
        row.condition = "with controller.type " + law;
        row.applies = &is_flown;
        const auto known =
            std::find_if(rows_.begin(), rows_.end(), [&](const auto& other) { return other.path == row.path; });
        if (known == rows_.end()) {
            rows_.push_back(std::move(row));
        } else {  // a key that another law has, too, is one row that serves
                  // whichever law flies the robot
            *known = shared(*known, row, law);
        }
    }
    static Parameter<SpaceRobot> shared(const Parameter<SpaceRobot>& other, const Parameter<SpaceRobot>& own,
                                        const std::string& law) {
        Parameter<SpaceRobot> both = own;
        both.required = own.required && other.required;
        both.condition = other.condition + " or " + law;
        both.applies = [other, own](const SpaceRobot& robot, std::size_t i) {
            return other.applies(robot, i) || own.applies(robot, i);
        };
        if (own.get) {
            both.get = [other, own](const SpaceRobot& robot, std::size_t i) {
                return (own.applies(robot, i) ? own : other).get(robot, i);
            };
            both.set = [other, own](SpaceRobot& robot, std::size_t i, const Value& value) {
                (own.applies(robot, i) ? own : other).set(robot, i, value);
            };
        }
        return both;
    }

    Rows& rows_;
};

void add_type(Rows& rows) {
    auto row = parameters::row<SpaceRobot>(ParameterKind::choice, "controller.type", "law of the controller");
    row.names.assign(std::begin(law_names), std::end(law_names));
    row.get = [](const SpaceRobot& robot, std::size_t) {
        return Value(std::string(law_names[robot.controller.law.index()]));
    };
    row.set = [](SpaceRobot& robot, std::size_t, const Value& value) {
        if (std::get<std::string>(value) == law_names[1]) {
            robot.controller.law = std::variant_alternative_t<1, SpaceLaw>{};
        } else {
            robot.controller.law = std::variant_alternative_t<0, SpaceLaw>{};
        }
    };
    rows.push_back(std::move(row));
}

void add_inversion(Rows& rows) {
    using Law = SpaceInversion;
    LawRows<Law> law(rows);
    law.loop("position", "x and y, by tilting", "m_s2", &Law::horizontal);
    law.loop("height", "z, by thrust", "m_s2", &Law::height);
    law.loop("joints", "every joint of the arm", "rad_s2", &Law::joint);
    law.group("attitude", "tilt first, then yaw");
    law.gain("attitude.kp", "rate per tilt error", &Law::attitude_kp_1_s);
    law.gain("attitude.yaw_kp", "rate per yaw error", &Law::yaw_kp_1_s);
    law.gain("attitude.rate_kp", "angular acceleration per error of the roll or pitch rate", &Law::rate_kp_1_s);
    law.optional_gain("attitude.rate_ki", "the same per its integral", &Law::rate_ki_1_s2);
    law.gain("attitude.yaw_rate_kp", "angular acceleration per error of the yaw rate", &Law::yaw_rate_kp_1_s);
    law.optional_gain("attitude.yaw_rate_ki", "the same per its integral", &Law::yaw_rate_ki_1_s2);
    law.limit("attitude.integral_limit_rad_s2", "most that an integral of the rates adds", 1e-3, 1e4,
              &Law::rate_integral_limit_rad_s2);
    law.limit("attitude.direction_rate_filter_s", "time constant of the derivative of the wanted direction", 0, 10,
              &Law::direction_rate_filter_s);
    law.flag("attitude.rate_feed_forward", "adds the derivative of the rate demand", &Law::rate_feed_forward);
    law.limit("attitude.max_rate_deg_s", "largest demanded roll and pitch rate", 1, 36000, &Law::max_rate_rad_s);
    law.limit("attitude.max_yaw_rate_deg_s", "largest demanded yaw rate", 1, 36000, &Law::max_yaw_rate_rad_s);
    law.limit("max_tilt_deg", "the demanded tilt is clipped to this", 0.01, 89, &Law::max_tilt_rad);
    law.limit("rotor_lead", "share by which rotors with a lag are asked for more than they lack", 0, 10,
              &Law::rotor_lead);
    law.limit("observer_gain_1_s",
              "1 / time constant with which unexplained forces and torques are "
              "estimated; 0: none",
              0, 1e4, &Law::observer_gain_1_s);
    law.limit("min_vertical_force_ratio", "least vertical force of the inversion over the weight", 1e-3, 1,
              &Law::min_vertical_force_ratio);
    law.flag("feed_forward", "divides rotor commands by the thrust ratios at the rotors", &Law::feed_forward);
    law.vector("feed_forward_offset_m", "of the map's surfaces from their nominal places", &Law::feed_forward_offset_m);
}

void add_px4(Rows& rows) {
    using Law = Px4Cascade;
    LawRows<Law> law(rows);
    law.optional_gain("position_p_1_s", "speed per horizontal position error (MPC_XY_P)", &Law::position_p_1_s);
    law.optional_gain("height_p_1_s", "speed per height error (MPC_Z_P)", &Law::height_p_1_s);
    law.rate_loop("velocity", "horizontal velocity (MPC_XY_VEL_*_ACC)", "m_s2", &Law::velocity);
    law.rate_loop("vertical_velocity", "vertical velocity (MPC_Z_VEL_*_ACC)", "m_s2", &Law::vertical_velocity);
    law.limit("max_speed_m_s", "of the demanded velocity (MPC_XY_VEL_MAX)", 1e-3, 100, &Law::max_speed_m_s);
    law.limit("max_climb_m_s", "upwards (MPC_Z_VEL_MAX_UP)", 1e-3, 100, &Law::max_climb_m_s);
    law.limit("max_descent_m_s", "downwards (MPC_Z_VEL_MAX_DN)", 1e-3, 100, &Law::max_descent_m_s);
    law.limit("max_tilt_deg", "the demanded tilt is clipped to this", 0.01, 89, &Law::max_tilt_rad);
    law.limit("min_thrust_ratio", "least thrust, of the weight", 1e-3, 0.999, &Law::min_thrust_ratio);
    law.optional_gain("attitude_p_1_s", "rate per attitude error (MC_ROLL_P, MC_PITCH_P)", &Law::attitude_p_1_s);
    law.optional_gain("yaw_p_1_s", "rate per yaw error (MC_YAW_P)", &Law::yaw_p_1_s);
    law.limit("yaw_weight", "weight of yaw beside tilt (MC_YAW_WEIGHT)", 1e-3, 1, &Law::yaw_weight);
    law.limit("max_rate_deg_s", "of the demanded rates (MC_ROLLRATE_MAX)", 1, 36000, &Law::max_rate_rad_s);
    law.limit("max_yaw_rate_deg_s", "of the demanded yaw rate (MC_YAWRATE_MAX)", 1, 36000, &Law::max_yaw_rate_rad_s);
    law.rate_loop("rate", "roll and pitch rate", "rad_s2", &Law::rate);
    law.rate_loop("yaw_rate", "yaw rate", "rad_s2", &Law::yaw_rate);
    law.loop("joints", "every joint of the arm", "rad_s2", &Law::joint);
    law.limit("rotor_lead", "share by which rotors with a lag are asked for more than they lack", 0, 10,
              &Law::rotor_lead);
}

}  // namespace

void add_space_controller_rows(Rows& rows) {
    using parameters::in;
    using parameters::number;
    rows.push_back(parameters::group<SpaceRobot>("controller", "the controller of multirotor and arm").is_required());
    parameters::append(rows, {number<SpaceRobot>("controller.rate_hz", "control ticks per second",
                                                 in(&SpaceRobot::controller, &SpaceController::rate_hz))
                                  .between(10, 1000),
                              number<SpaceRobot>("controller.delay_s",
                                                 "age of the state that the controller sees, at most 64 control "
                                                 "ticks",
                                                 in(&SpaceRobot::controller, &SpaceController::delay_s))
                                  .between(0, 0.3)});
    add_type(rows);
    add_inversion(rows);
    add_px4(rows);
    // What every law has needs no condition.
    for (Parameter<SpaceRobot>& row : rows) {
        SpaceRobot inverting, cascaded;
        cascaded.controller.law = Px4Cascade{};
        if (row.path.starts_with("controller.") && row.applies && row.applies(inverting, 0) &&
            row.applies(cascaded, 0)) {
            row.condition.clear();
            row.applies = {};
        }
    }
}

}  // namespace downwash
