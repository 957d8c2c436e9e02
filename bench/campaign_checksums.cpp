#include "downwash/bench/campaign_checksums.hpp"

#include <map>
#include <string_view>
#include <type_traits>

#include "downwash/base/sha256.hpp"

namespace downwash::bench {
namespace {

/// Collects the bytes of values, each with its length where that is not fixed. Structs are taken apart by structured
/// bindings: a member that is added does not compile until it is part of the checksum.
class Bytes {
 public:
    template <class... Values>
    void add(const Values&... values) {
        (put(values), ...);
    }
    [[nodiscard]] std::string digest() const { return sha256_hex(bytes_); }

 private:
    template <class Number>
    void put(const Number& number) requires(std::is_arithmetic_v<Number> || std::is_enum_v<Number>) {
        if constexpr (std::is_floating_point_v<Number>) {
            put_bytes(number + 0.0);  // SQLite stores -0 as 0
        } else {
            put_bytes(static_cast<std::uint64_t>(number));
        }
    }
    template <class Number>
    void put_bytes(Number number) {
        bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
    void put(const std::string& text) {
        put(text.size());
        bytes_ += text;
    }
    template <class Value>
    void put(const std::optional<Value>& value) {
        put(value.has_value());
        if (value) {
            put(*value);
        }
    }
    template <class First, class Second>
    void put(const std::pair<First, Second>& both) {
        add(both.first, both.second);
    }
    template <class Value>
    void put(const std::vector<Value>& values) {
        put_all(values);
    }
    template <class Key, class Value, class Less>
    void put(const std::map<Key, Value, Less>& values) {
        put_all(values);
    }
    template <class Values>
    void put_all(const Values& values) {
        put(values.size());
        for (const auto& value : values) {
            put(value);
        }
    }

    void put(const Improvement& improvement) {
        const auto& [wall_s, iteration, cost, flown_cost] = improvement;
        add(wall_s, iteration, cost, flown_cost);
    }
    void put(const FlightFigures& flight) {
        const auto& [outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m] = flight;
        add(outcome, cost, energy_j, duration_s, length_m, min_clearance_m, goal_error_m);
    }
    void put(const CertificateFigures& certificate) {
        const auto& [is_given, worlds, failures, attempts] = certificate;
        add(is_given, worlds, failures, attempts);
    }
    void put(const ParameterFlights& flights) {
        const auto& [parameter, fails_low, fails_high] = flights;
        add(parameter, fails_low, fails_high);
    }
    void put(const WorldFigures& figures) {
        const auto& [worlds, failures, alone] = figures;
        add(worlds, failures, alone);
    }
    void put(const RunMachine& made_on) {
        const auto& [machine, load] = made_on;
        const auto& [host, processor, instruction_set] = machine;
        add(host, processor, instruction_set, load);
    }
    void put(const ShardPlan& shards) {
        const auto& [count, cell_costs_us] = shards;
        add(count, cell_costs_us);
    }
    void put(const Experiment& experiment) {
        const auto& [problem, objective] = experiment;
        add(problem, objective);
    }
    void put(const PlannerSetup& planner) {
        const auto& [variant, algorithm, margin_m, parameters] = planner;
        add(variant, algorithm, margin_m, parameters);
    }
    void put(const CampaignExpectation& target) {
        const auto& [variant, algorithm, solved, failed, first_median_s, first_95_s, verified_s, after_s, to_best,
                     cheaper_than, cheaper_after_s, failure_share, certified, certified_median_s] = target;
        add(variant, algorithm, solved, failed, first_median_s, first_95_s, verified_s, after_s, to_best, cheaper_than,
            cheaper_after_s, failure_share, certified, certified_median_s);
    }

    std::string bytes_;
};

}  // namespace

std::string checksum_of(const Run& run) {
    const auto& [experiment, planner, seed, status, wall_s, first_solution_s, cost, nearest_approach_m, iterations,
                 edges_simulated, states_checked, simulated_s, discarded, improvements, rejections, flight, error,
                 certificate, first_certified_s, in_worlds, made_on] = run;
    Bytes bytes;
    bytes.add(experiment, planner, seed, status, wall_s, first_solution_s, cost, nearest_approach_m, iterations,
              edges_simulated, states_checked, simulated_s, discarded, improvements, rejections, flight, error,
              certificate, first_certified_s, in_worlds);
    if (made_on) {
        bytes.add(*made_on);
    }
    return bytes.digest();
}

std::string checksum_of(const CampaignPlan& plan) {
    const auto& [settings, experiments, planners, seeds, expectations, left_out, time_limit_s, stops_at_first, worlds,
                 shards] = plan;
    Bytes bytes;
    bytes.add(settings, experiments, planners, seeds, expectations, left_out, time_limit_s, stops_at_first, worlds);
    if (shards) {
        bytes.add(*shards);
    }
    return bytes.digest();
}

}  // namespace downwash::bench
