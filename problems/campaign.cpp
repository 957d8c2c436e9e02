#include "downwash/problems/campaign.hpp"

#include <utility>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Campaign>>;

std::vector<std::pair<Variant, std::string_view>> named_variants() {
    std::vector<std::pair<Variant, std::string_view>> named;
    for (const Variant variant : {Variant::mp_arm, Variant::mp_arm_da, Variant::mp_arm_ada}) {
        named.emplace_back(variant, name_of(variant));
    }
    return named;
}

std::vector<std::pair<Objective, std::string_view>> named_objectives() {
    std::vector<std::pair<Objective, std::string_view>> named;
    named.reserve(all_objectives.size());
    for (const Objective objective : all_objectives) {
        named.emplace_back(objective, name_of(objective));
    }
    return named;
}

std::vector<std::string_view> algorithm_names() {
    std::vector<std::string_view> names;
    for (const AlgorithmInfo& algorithm : algorithms()) {
        names.push_back(algorithm.name);
    }
    return names;
}

void add_what_runs(Rows& rows) {
    rows.push_back(parameters::files<Campaign>(
                       "problems", "problem files", [](auto& c) -> auto& { return c.problems; })
                       .is_required());
    rows.push_back(parameters::choices<Campaign>(
        "variants", "what the planner knows of the physics", named_variants(),
        [](auto& c) -> auto& { return c.variants; }));
    rows.push_back(parameters::choices<Campaign>(
        "algorithms", "tree planners", algorithm_names(), [](auto& c) -> auto& { return c.algorithms; }));
    rows.push_back(parameters::choices<Campaign>(
        "objectives", "what plans should keep small; null: each problem's own objective", named_objectives(),
        [](auto& c) -> auto& { return c.objectives; }));
    rows.push_back(
        parameters::samples<Campaign>(
            "margins_m", "safety margins; null: each problem's own", [](auto& c) -> auto& { return c.margins_m; })
            .at_least(0)
            .at_most(100));
}

void add_algorithm_parameters(Rows& rows) {
    rows.push_back(parameters::list<Campaign>(
        "parameters", "sets of algorithm parameters, see `downwash planners`; without it each problem's own",
        [](auto& c) -> auto& { return c.parameters; }));
    for (const auto& [parameter, algorithms] : known_parameters()) {
        auto row = parameters::row<Campaign>(ParameterKind::number, "parameters[]." + std::string(parameter->name),
                                             parameter->description);
        row.range = {parameter->low, parameter->high};
        row.nullable = true;
        row.get = [name = parameter->name](const Campaign& c, std::size_t i) {
            const auto set = c.parameters[i].find(name);
            return set != c.parameters[i].end() ? Value(set->second) : Value();
        };
        row.set = [name = std::string(parameter->name)](Campaign& c, std::size_t i, const Value& value) {
            if (const double* number = std::get_if<double>(&value)) {
                c.parameters[i][name] = *number;
            }
        };
        rows.push_back(std::move(row));
    }
}

void add_seeds(Rows& rows) {
    constexpr double highest = 4294967295.0;
    auto seeds = parameters::group<Campaign>("seeds", "seeds that every search is run with").at_least(0);
    seeds.range.high = highest;
    seeds.can_be_integers = true;
    seeds.set = [](Campaign& c, std::size_t, const Value& value) {
        c.seeds.list = std::get<std::vector<std::uint64_t>>(value);
    };
    rows.push_back(std::move(seeds));
    rows.push_back(parameters::integer<Campaign>(
                       "seeds.first", "the first one", [](auto& c) -> auto& { return c.seeds.first; })
                       .at_least(0)
                       .at_most(highest));
    rows.push_back(parameters::integer<Campaign>(
                       "seeds.count", "how many follow each other", [](auto& c) -> auto& { return c.seeds.count; })
                       .at_least(1)
                       .at_most(static_cast<double>(max_campaign_runs)));
}

void add_limits(Rows& rows) {
    rows.push_back(parameters::number<Campaign>(
                       "time_limit_s", "wall time of one search; null: 10 s, or none where max_iterations is set",
                       [](auto& c) -> auto& { return c.time_limit_s; })
                       .above(0)
                       .at_most(1e6));
    rows.push_back(parameters::integer<Campaign>(
                       "max_iterations", "limit of one search", [](auto& c) -> auto& { return c.max_iterations; })
                       .at_least(1)
                       .at_most(1e15));
    rows.push_back(parameters::flag<Campaign>(
        "stop_at_first_solution", "end a search with the first plan that is accepted",
        [](auto& c) -> auto& { return c.stop_at_first_solution; }));
    rows.push_back(parameters::flag<Campaign>(
        "as_believed", "plan as with `uncertainty: none`; evaluation_worlds stay those of each problem's uncertainty",
        [](auto& c) -> auto& { return c.as_believed; }));
    rows.push_back(parameters::integer<Campaign>(
                       "evaluation_worlds",
                       "worlds of its problem's uncertainty in which every reported plan is flown; no "
                       "search has seen them, and they are the same for all plans of a problem",
                       [](auto& c) -> auto& { return c.evaluation_worlds; })
                       .at_least(0)
                       .at_most(1e6));
    rows.push_back(parameters::integer<Campaign>(
                       "jobs", "searches that run at a time, one thread each; null: one per processor, in a shard one",
                       [](auto& c) -> auto& { return c.jobs; })
                       .at_least(1)
                       .at_most(256));
}

void add_expectations(Rows& rows) {
    rows.push_back(parameters::list<Campaign>(
        "expect", "bars that the report holds a variant to, on every problem",
        [](auto& c) -> auto& { return c.expect; }));
    const auto bar = [](auto& c, std::size_t i) -> auto& {
        return c.expect[i];
    };
    rows.push_back(parameters::choice<Campaign>(
                       "expect[].variant", "one that the campaign runs",
                       named_variants(), [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).variant; })
                       .is_required());
    rows.push_back(parameters::choice<Campaign>(
        "expect[].algorithm", "one that the campaign runs; null: all of them",
        algorithm_names(), [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).algorithm; }));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].solved_ratio", "least share of seeds that are solved",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).solved_ratio; })
                       .at_least(0)
                       .at_most(1));
    rows.push_back(parameters::integer<Campaign>(
                       "expect[].failed_flights", "most seeds whose reported plan fails in its flight",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).failed_flights; })
                       .at_least(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].first_solution_median_s", "longest median time to a first solution",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).first_solution_median_s; })
                       .above(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].first_solution_95_s", "longest time to a first solution in 95 % of the seeds",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).first_solution_95_s; })
                       .above(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].verified_median_s", "longest median time to a first plan that may be reported",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).verified_median_s; })
                       .above(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].cost_after_s", "time of the search at which cost_to_best and cheaper_than look",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).cost_after_s; })
                       .above(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].cost_to_best",
                       "greatest median cost, in units of the least that any run of the campaign has flown there",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).cost_to_best; })
                       .at_least(1));
    rows.push_back(parameters::choice<Campaign>(
        "expect[].cheaper_than", "algorithm whose median cost is to be beaten",
        algorithm_names(), [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).cheaper_than; }));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].cheaper_than_after_s", "time of its search at which that one is looked at",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).cheaper_than_after_s; })
                       .above(0));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].max_failure_share", "greatest share of failed flights in the evaluation worlds",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).max_failure_share; })
                       .at_least(0)
                       .at_most(1));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].certified_ratio", "least share of seeds whose plan has a certificate",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).certified_ratio; })
                       .at_least(0)
                       .at_most(1));
    rows.push_back(parameters::number<Campaign>(
                       "expect[].first_certified_median_s", "longest median time to a first plan with a certificate",
                       [bar](auto& c, std::size_t i) -> auto& { return bar(c, i).first_certified_median_s; })
                       .above(0));
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<Campaign>("schema", "format and version of a campaign file", "downwash/campaign/v1")
            .is_required());
    rows.push_back(parameters::identifier<Campaign>(
        "name", "name of the campaign; it becomes part of a path", [](auto& c) -> auto& { return c.name; }));
    rows.push_back(parameters::text<Campaign>(
        "description", "what the campaign is about", [](auto& c) -> auto& { return c.description; }));
    add_what_runs(rows);
    add_algorithm_parameters(rows);
    add_seeds(rows);
    add_limits(rows);
    add_expectations(rows);
    return rows;
}

}  // namespace

std::vector<std::uint32_t> CampaignSeeds::all() const {
    std::vector<std::uint32_t> seeds;
    if (!list.empty()) {
        for (const std::uint64_t seed : list) {
            seeds.push_back(static_cast<std::uint32_t>(seed));
        }
        return seeds;
    }
    for (std::uint64_t i = 0; i < count; ++i) {
        seeds.push_back(static_cast<std::uint32_t>(first + i));
    }
    return seeds;
}

const ParameterTable<Campaign>& campaign_parameters() {
    static const ParameterTable<Campaign> table(all_rows());
    return table;
}

}  // namespace downwash
