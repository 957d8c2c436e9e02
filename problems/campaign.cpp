#include "downwash/problems/campaign.hpp"

#include <utility>

#include "downwash/base/parameter_factories.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_model.hpp"

namespace downwash {
namespace {

using Rows = std::vector<Parameter<Campaign>>;
using parameters::append;
using parameters::in;
using parameters::named;

template <class Member>
Parameter<Campaign> number(std::string_view path, std::string_view description, Member member) {
    return parameters::number<Campaign>(path, description, member);
}
template <class Member>
Parameter<Campaign> integer(std::string_view path, std::string_view description, Member member) {
    return parameters::integer<Campaign>(path, description, member);
}

void add_what_runs(Rows& rows) {
    append(
        rows,
        {parameters::files<Campaign>("problems", "problem files", &Campaign::problems).is_required(),
         parameters::choices<Campaign>("variants", "what the planner knows of the physics", named(all_variants),
                                       &Campaign::variants),
         parameters::choices<Campaign>("algorithms", "tree planners", algorithm_names(), &Campaign::algorithms),
         parameters::choices<Campaign>("objectives", "what plans should keep small; null: each problem's own objective",
                                       named(all_objectives), &Campaign::objectives),
         parameters::samples<Campaign>("margins_m", "safety margins; null: each problem's own", &Campaign::margins_m)
             .between(0, 100)});
}

void add_algorithm_parameters(Rows& rows) {
    rows.push_back(parameters::list<Campaign>(
        "parameters", "sets of algorithm parameters, see `downwash planners`; without it each problem's own",
        &Campaign::parameters));
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
    append(rows,
           {integer("seeds.first", "the first one", in(&Campaign::seeds, &CampaignSeeds::first)).between(0, highest),
            integer("seeds.count", "how many follow each other", in(&Campaign::seeds, &CampaignSeeds::count))
                .between(1, static_cast<double>(max_campaign_runs))});
}

void add_limits(Rows& rows) {
    append(rows,
           {number("time_limit_s", "wall time of one search; null: 10 s, or none where max_iterations is set",
                   &Campaign::time_limit_s)
                .above(0)
                .at_most(1e6),
            integer("max_iterations", "limit of one search", &Campaign::max_iterations).between(1, 1e15),
            parameters::flag<Campaign>("stop_at_first_solution", "end a search with the first plan that is accepted",
                                       &Campaign::stop_at_first_solution),
            parameters::flag<Campaign>(
                "as_believed",
                "plan as with `uncertainty: none`; evaluation_worlds stay those of each problem's uncertainty",
                &Campaign::as_believed),
            parameters::flag<Campaign>("check_execution",
                                       "false: plans count without being executed; true: each problem's own",
                                       &Campaign::check_execution),
            parameters::flag<Campaign>("certify", "false: plans count without a certificate; true: each problem's own",
                                       &Campaign::certify),
            integer("evaluation_worlds",
                    "worlds of its problem's uncertainty in which every reported plan is flown; no "
                    "search has seen them, and they are the same for all plans of a problem",
                    &Campaign::evaluation_worlds)
                .between(0, 1e6),
            integer("jobs", "searches that run at a time, one thread each; null: one per processor, in a shard one",
                    &Campaign::jobs)
                .between(1, 256)});
}

void add_expectations(Rows& rows) {
    using Bar = CampaignExpectation;
    const auto of = [](auto member) { return parameters::in_each(&Campaign::expect, member); };
    append(
        rows,
        {parameters::list<Campaign>("expect", "bars that the report holds a variant to, on every problem",
                                    &Campaign::expect),
         parameters::choice<Campaign>("expect[].variant", "one that the campaign runs", named(all_variants),
                                      of(&Bar::variant))
             .is_required(),
         parameters::choice<Campaign>("expect[].algorithm", "one that the campaign runs; null: all of them",
                                      algorithm_names(), of(&Bar::algorithm)),
         number("expect[].solved_ratio", "least share of seeds that are solved", of(&Bar::solved_ratio)).between(0, 1),
         integer("expect[].failed_flights", "most seeds whose reported plan fails in its flight",
                 of(&Bar::failed_flights))
             .at_least(0),
         number("expect[].first_solution_median_s", "longest median time to a first solution",
                of(&Bar::first_solution_median_s))
             .above(0),
         number("expect[].first_solution_95_s", "longest time to a first solution in 95 % of the seeds",
                of(&Bar::first_solution_95_s))
             .above(0),
         number("expect[].verified_median_s", "longest median time to a first plan that may be reported",
                of(&Bar::verified_median_s))
             .above(0),
         number("expect[].cost_after_s", "time of the search at which cost_to_best and cheaper_than look",
                of(&Bar::cost_after_s))
             .above(0),
         number("expect[].cost_to_best",
                "greatest median cost, in units of the least that any run of the campaign has flown there",
                of(&Bar::cost_to_best))
             .at_least(1),
         parameters::choice<Campaign>("expect[].cheaper_than", "algorithm whose median cost is to be beaten",
                                      algorithm_names(), of(&Bar::cheaper_than)),
         number("expect[].cheaper_than_after_s", "time of its search at which that one is looked at",
                of(&Bar::cheaper_than_after_s))
             .above(0),
         number("expect[].max_failure_share", "greatest share of failed flights in the evaluation worlds",
                of(&Bar::max_failure_share))
             .between(0, 1),
         number("expect[].certified_ratio", "least share of seeds whose plan has a certificate",
                of(&Bar::certified_ratio))
             .between(0, 1),
         number("expect[].first_certified_median_s", "longest median time to a first plan with a certificate",
                of(&Bar::first_certified_median_s))
             .above(0)});
}

Rows all_rows() {
    Rows rows;
    rows.push_back(
        parameters::constant<Campaign>("schema", "format and version of a campaign file", "downwash/campaign/v1")
            .is_required());
    append(rows, {parameters::identifier<Campaign>("name", "name of the campaign; it becomes part of a path",
                                                   &Campaign::name),
                  parameters::text<Campaign>("description", "what the campaign is about", &Campaign::description)});
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
