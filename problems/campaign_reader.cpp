#include "downwash/problems/campaign_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "downwash/base/text.hpp"
#include "downwash/controllers/plan.hpp"
#include "downwash/problems/algorithms.hpp"
#include "downwash/problems/problem_reader.hpp"
#include "downwash/problems/tree_reader.hpp"

namespace downwash {
namespace {

std::uint64_t run_count(const Campaign& c) {
    const std::uint64_t seeds = c.seeds.list.empty() ? c.seeds.count : c.seeds.list.size();
    double product = static_cast<double>(seeds);
    for (const std::size_t factor :
         {c.problems.size(), c.variants.size(), c.algorithms.size(), c.objectives ? c.objectives->size() : 1,
          c.margins_m ? c.margins_m->size() : 1, std::max<std::size_t>(c.parameters.size(), 1)}) {
        product *= static_cast<double>(factor);
    }
    return product < 1e18 ? static_cast<std::uint64_t>(product) : std::numeric_limits<std::uint64_t>::max();
}

/// What a target asks for that the campaign cannot tell.
void add_errors_of_target(const Campaign& c, std::size_t i, std::vector<KeyError>& errors) {
    const CampaignExpectation& bar = c.expect[i];
    const std::string path = "expect[" + std::to_string(i) + "].";
    for (const auto& [key, algorithm] : {std::pair{"algorithm", bar.algorithm}, {"cheaper_than", bar.cheaper_than}}) {
        if (algorithm && std::find(c.algorithms.begin(), c.algorithms.end(), *algorithm) == c.algorithms.end()) {
            errors.push_back(
                {path + key, "is " + *algorithm + ", which is not run: expected one of the campaign's algorithms"});
        }
    }
    if ((bar.cost_to_best || bar.cheaper_than) && !bar.cost_after_s) {
        errors.push_back({path + (bar.cost_to_best ? "cost_to_best" : "cheaper_than"),
                          "does not say when: expected cost_after_s beside it"});
    }
    if (bar.cheaper_than.has_value() != bar.cheaper_than_after_s.has_value()) {
        errors.push_back({path + (bar.cheaper_than ? "cheaper_than" : "cheaper_than_after_s"),
                          "is half of a comparison: expected cheaper_than and cheaper_than_after_s together"});
    }
    if (bar.max_failure_share && c.evaluation_worlds == 0) {
        errors.push_back({path + "max_failure_share",
                          "asks for flights in worlds, but none are flown: expected evaluation_worlds of at least 1"});
    }
    if (bar.cost_after_s && c.stop_at_first_solution) {
        errors.push_back({path + "cost_after_s",
                          "asks for costs, but searches stop at their first solution: expected stop_at_first_solution: "
                          "false"});
    }
}

/// What is wrong with a set of parameters: no algorithm of the campaign has one, or two sets are the same.
void add_errors_of_parameters(const Campaign& c, std::size_t i, std::vector<KeyError>& errors) {
    const std::string path = "parameters[" + std::to_string(i) + "]";
    for (const auto& [parameter, algorithms] : known_parameters()) {
        const auto set = c.parameters[i].find(parameter->name);
        if (set == c.parameters[i].end()) {
            continue;
        }
        const std::string key = path + "." + set->first;
        if (std::find_first_of(c.algorithms.begin(), c.algorithms.end(), algorithms.begin(), algorithms.end()) ==
            c.algorithms.end()) {
            errors.push_back({key, "has a meaning only with " + joined_names(algorithms) + ": remove it"});
        } else if (parameter->is_whole && set->second != std::floor(set->second)) {
            errors.push_back({key, "is " + to_text(set->second) + ": expected a whole number"});
        }
    }
    const auto begin = c.parameters.begin();
    if (const auto same = std::find(begin, c.parameters.end(), c.parameters[i]); same - begin < std::ptrdiff_t(i)) {
        errors.push_back(
            {path, "is the same as parameters[" + std::to_string(same - begin) + "]: expected every set once"});
    }
}

std::vector<KeyError> campaign_errors(const Campaign& c) {
    std::vector<KeyError> errors;
    if (c.seeds.list.empty() && c.seeds.first + c.seeds.count - 1 > std::numeric_limits<std::uint32_t>::max()) {
        errors.push_back({"seeds", "go beyond 4294967295, the highest seed: expected a smaller first or count"});
    }
    if (run_count(c) > max_campaign_runs) {
        errors.push_back(
            {"seeds", "make more than " + std::to_string(max_campaign_runs) +
                          " runs with all problems, variants, algorithms, objectives, margins and parameters: "
                          "expected fewer of one of them"});
    }
    for (std::size_t i = 0; i < c.parameters.size(); ++i) {
        add_errors_of_parameters(c, i, errors);
    }
    for (std::size_t i = 0; i < c.expect.size(); ++i) {
        add_errors_of_target(c, i, errors);
        if (std::find(c.variants.begin(), c.variants.end(), c.expect[i].variant) == c.variants.end()) {
            errors.push_back({"expect[" + std::to_string(i) + "].variant",
                              "is " + std::string(name_of(c.expect[i].variant)) +
                                  ", which is not run: expected one of the campaign's variants"});
        }
    }
    return errors;
}

/// Reads the problems; two of one name could not be told apart in results.
/// @param located collects errors that have their place in a problem's file
std::vector<KeyError> read_problems(const Campaign& campaign, std::vector<AnyProblem>& problems,
                                    std::vector<LocatedError>& located,
                                    const std::function<void(const LocatedError&)>& on_outdated,
                                    const std::function<void(const LocatedError&)>& on_warning,
                                    const FurtherSpaceErrors& further_errors) {
    std::vector<KeyError> errors;
    for (const std::string& path : campaign.problems) {
        try {
            AnyProblem problem = read_any_problem(path, on_outdated, on_warning, further_errors);
            const std::string& name = problem_name(problem);
            if (std::ranges::any_of(problems, [&](const AnyProblem& other) { return problem_name(other) == name; })) {
                std::string message = "name '" + path;
                message.append("', which has the name of another, ").append(name);
                message += ": expected every problem once, with a name of its own";
                errors.push_back({"problems", std::move(message)});
            }
            problems.push_back(std::move(problem));
        } catch (const ProblemFileError& error) {
            located.insert(located.end(), error.errors().begin(), error.errors().end());
        }
    }
    return errors;
}

}  // namespace

ReadCampaign read_campaign(const std::filesystem::path& file,
                           const std::function<void(const LocatedError&)>& on_outdated,
                           const std::function<void(const LocatedError&)>& on_warning,
                           const FurtherSpaceErrors& further_errors) {
    problems::TreeReader<Campaign> reader(campaign_parameters());
    reader.read(file);
    ReadCampaign read{reader.model(), {}};
    std::vector<LocatedError> in_problems;
    std::set<std::string> told;  // a robot of several problems is warned of once
    const auto on_warning_once = [&](const LocatedError& warning) {
        if (on_warning && told.insert(to_text(warning)).second) {
            on_warning(warning);
        }
    };
    if (reader.errors().empty()) {
        reader.add(campaign_errors(read.campaign));
        reader.add(
            read_problems(read.campaign, read.problems, in_problems, on_outdated, on_warning_once, further_errors));
    }
    std::vector<LocatedError> errors = reader.errors();
    errors.insert(errors.end(), in_problems.begin(), in_problems.end());
    if (!errors.empty()) {
        throw ProblemFileError(std::move(errors));
    }
    if (read.campaign.as_believed) {
        read.evaluated_in = read.problems;
        for (AnyProblem& problem : read.problems) {
            uncertainty_of(problem).reset();
        }
    }
    return read;
}

}  // namespace downwash
