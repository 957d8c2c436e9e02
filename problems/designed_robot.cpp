#include "downwash/problems/designed_robot.hpp"

#include <utility>
#include <vector>

#include "downwash/base/text.hpp"
#include "downwash/problems/located_error.hpp"
#include "downwash/problems/problem_parameters.hpp"
#include "downwash/problems/space_problem_parameters.hpp"
#include "downwash/problems/space_problem_reader.hpp"
#include "downwash/problems/tree_reader.hpp"
#include "downwash/problems/tree_writer.hpp"
#include "downwash/simulation/robot_parameters.hpp"
#include "downwash/simulation/space_design.hpp"
#include "downwash/simulation/space_robot_parameters.hpp"

namespace downwash {
namespace {

constexpr std::string_view controller = "robot.controller";

/// Gains that people can read: four digits are more than any measurement of a loop has.
template <class R>
void round_gains(const ParameterTable<R>& table, R& robot) {
    struct Rounded {
        const Parameter<R>& row;
        std::size_t index;
        double number;
    };
    std::vector<Rounded> all;
    for_each_value(
        table, robot,
        [&](const Parameter<R>& row, const std::string& /*key*/, std::size_t index) {
            const Value value = row.get(robot, index);
            const auto* number = std::get_if<double>(&value);
            if (number != nullptr && !is_in_degrees(row.path) && row.path != "controller.rate_hz" &&
                row.path != "controller.delay_s") {
                all.push_back({row, index, parse_number<double>(to_text(*number, 4)).value_or(*number)});
            }
        },
        "controller", "controller");
    for (const Rounded& rounded : all) {
        rounded.row.set(robot, rounded.index, Value(rounded.number));
    }
}

/// Takes over gains. @return what stands in the way
std::vector<KeyError> design(Robot& robot, const SpaceBandwidths& bandwidths, const std::optional<std::string>& law) {
    if (law && *law != ModelInversion::name) {
        return {{std::string(controller) + ".type", "of a robot in a vertical plane has gains from bandwidths for " +
                                                        std::string(ModelInversion::name) + " alone: " + *law +
                                                        " is for robots in space"}};
    }
    if (!law && !std::holds_alternative<ModelInversion>(robot.controller.law)) {
        return {{std::string(controller) + ".type", "has no gains from bandwidths: expected " +
                                                        std::string(ModelInversion::name) +
                                                        ", which --law asks for whatever the file says"}};
    }
    robot.controller.law = planar_gains_for(robot.rotors.time_constant_s, bandwidths);
    round_gains(robot_parameters(), robot);
    return {};
}

std::vector<KeyError> design(SpaceRobot& robot, const SpaceBandwidths& bandwidths,
                             const std::optional<std::string>& law) {
    design_controller(robot, bandwidths, law);
    return {};
}

/// @param further what else is wrong with a robot: further_robot_errors()
template <class Model, class Further>
auto read(const ParameterTable<Model>& table, const std::filesystem::path& file, const SpaceBandwidths& bandwidths,
          const std::optional<std::string>& law, const Further& further) {
    problems::TreeReader<Model> reader(table);
    reader.may_lack(std::string(controller));
    reader.read(file, "robot");
    WrongKeys wrong = reader.wrong_keys();
    std::vector<KeyError> errors;
    if (!wrong.touch(std::string(controller) + ".type")) {
        reader.adjust([&](Model& model) { errors = design(model.robot, bandwidths, law); });
    }
    reader.add(errors);
    if (errors.empty() && !reader.is_full()) {
        reader.add(further(reader.model().robot, wrong, "robot."));
    }
    if (auto found = reader.errors(); !found.empty()) {
        throw ProblemFileError(std::move(found));
    }
    return reader.model().robot;
}

}  // namespace

void design_controller(SpaceRobot& robot, const SpaceBandwidths& bandwidths, const std::optional<std::string>& law) {
    const bool is_cascade = law ? *law == Px4Cascade::name : std::holds_alternative<Px4Cascade>(robot.controller.law);
    if (is_cascade) {
        robot.controller.law = designed_cascade(robot, bandwidths);
    } else {
        robot.controller.law = designed_inversion(robot, bandwidths);
    }
    round_gains(space_robot_parameters(), robot);
}

AnyRobot read_robot_for_design(const std::filesystem::path& file, const SpaceBandwidths& bandwidths,
                               const std::optional<std::string>& law) {
    if (is_space_robot_file(file)) {
        return read(space_problem_parameters(), file, bandwidths, law, further_space_robot_errors);
    }
    return read(problem_parameters(), file, bandwidths, law, further_robot_errors);
}

std::string controller_yaml(const AnyRobot& robot) {
    const auto written = [](const auto& table, const auto& one) {
        using R = std::decay_t<decltype(one)>;
        const auto no_file = [](const Parameter<R>&, std::size_t) { return std::string(); };
        return problems::TreeWriter<R>(table, one, no_file).written("controller");
    };
    if (const auto* in_space = std::get_if<SpaceRobot>(&robot)) {
        return written(space_robot_parameters(), *in_space);
    }
    return written(robot_parameters(), std::get<Robot>(robot));
}

}  // namespace downwash
