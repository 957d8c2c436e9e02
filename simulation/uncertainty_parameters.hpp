#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/base/parameter_factories.hpp"
#include "downwash/simulation/robot_uncertainty.hpp"

namespace downwash {

/// The rows of one group of spreads in the table of a Model that holds them.
template <class Model>
class SpreadRows {
 public:
    /// @param rows where they are added, the group first
    SpreadRows(std::vector<Parameter<Model>>& rows, std::string path, std::string_view description)
        : rows_(rows), path_(std::move(path)) {
        rows_.push_back(parameters::group<Model>(path_, description));
    }

    /// What may be as much more as less than believed.
    void add(std::string_view name, std::string_view description, double most, Spread Model::*spread) {
        push(name, description, {"sd", "range"}, -most, most, spread);
    }
    /// What is never negative; factors are of what the robot has.
    void add_of_robot(std::string_view name, std::string_view description, double most, Spread Model::*spread) {
        push(name, description, {"sd", "range", "factor"}, 0, most, spread);
    }
    /// What is drawn anew all the time.
    void add_noise(std::string_view name, std::string_view description, double most, Spread Model::*spread) {
        push(name, description, {"sd"}, 0, most, spread);
    }

 private:
    void push(std::string_view name, std::string_view description, const std::vector<std::string_view>& forms,
              double low, double high, Spread Model::*spread) {
        rows_.push_back(parameters::spread<Model>(
                            path_ + "." + std::string(name), description,
                            forms, [spread](auto& model) -> auto& { return model.*spread; })
                            .at_least(low)
                            .at_most(high));
    }

    std::vector<Parameter<Model>>& rows_;
    std::string path_;
};

/// The keys `vehicle` and `sensing` with all that is below them. Robots and problems have them under `uncertainty`.
[[nodiscard]] DOWNWASH_EXPORT const std::vector<Parameter<RobotUncertainty>>& robot_uncertainty_rows();

}  // namespace downwash
