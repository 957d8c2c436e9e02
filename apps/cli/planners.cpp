#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <string_view>
#include <utility>

#include "downwash/cli/common_options.hpp"
#include "downwash/cli/output.hpp"
#include "downwash/planner/solve.hpp"

namespace downwash::cli {
namespace {

Json variants_of(const AlgorithmInfo& algorithm) {
    auto names = Json::array();
    for (const Variant variant : all_variants) {
        if (algorithm.plans_for(variant)) {
            names.push_back(name_of(variant));
        }
    }
    return names;
}

/// Calls visit(parameter, variants) for every parameter of an algorithm.
template <class Visit>
void for_each_parameter(const AlgorithmInfo& algorithm, const Visit& visit) {
    for (const AlgorithmParameter& parameter : algorithm.line_parameters) {
        visit(parameter, Json{name_of(Variant::mp_arm)});
    }
    for (const AlgorithmParameter& parameter : algorithm.flight_parameters) {
        visit(parameter, Json{name_of(Variant::mp_arm_da), name_of(Variant::mp_arm_ada)});
    }
}

void print_planners_as_json() {
    auto list = Json::array();
    for (const AlgorithmInfo& algorithm : algorithms()) {
        auto parameters = Json::array();
        for_each_parameter(algorithm, [&parameters](const AlgorithmParameter& parameter, const auto& variants) {
            parameters.push_back({{"name", parameter.name},
                                  {"value", parameter.value},
                                  {"low", parameter.low},
                                  {"high", parameter.high},
                                  {"variants", variants},
                                  {"description", parameter.description}});
        });
        list.push_back({{"name", algorithm.name},
                        {"kind", algorithm.kind},
                        {"variants", variants_of(algorithm)},
                        {"description", algorithm.description},
                        {"parameters", std::move(parameters)}});
    }
    print_json({{"planners", std::move(list)}});
}

void print_table() {
    for (const AlgorithmInfo& algorithm : algorithms()) {
        fmt::print("{}\n  kind        {}\n  about       {}\n  parameters  ", algorithm.name, algorithm.kind,
                   algorithm.description);
        std::string_view indent;
        for_each_parameter(algorithm, [&indent](const AlgorithmParameter& parameter, const auto& variants) {
            fmt::print("{}{} {} ({} to {}{}): {}\n", indent, parameter.name, parameter.value, parameter.low,
                       parameter.high, variants.size() == 1 ? ", mp-arm" : "", parameter.description);
            indent = "              ";
        });
    }
}

struct PlannersArguments {
    bool as_json = false;
};

ExitCode run(const PlannersArguments& given) {
    given.as_json ? print_planners_as_json() : print_table();
    return ExitCode::done;
}

}  // namespace

void add_planners(Command program, Action& action) {
    auto [command, given] =
        add_command<PlannersArguments>(program, action, "planners", "List the search algorithms", run);
    add_json(command, given.as_json);
}

}  // namespace downwash::cli
