// How often plans of a known failure probability pass the test for a certificate, in simulated searches. Prints
// Markdown.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "../support/measuring.hpp"
#include "downwash/bench/machine.hpp"
#include "downwash/planner/certificate.hpp"

using namespace downwash;

namespace {

constexpr double max_failure_probability = 0.01;
constexpr double confidence = 0.95;
constexpr std::uint64_t attempts = 20;

/// What came of a plan in the test.
struct Outcome {
    bool passes = false;
    std::uint64_t worlds = 0;
};

/// Flies a plan in worlds until it is known whether it passes: each flight fails by itself with probability p.
Outcome tested(const CertificateTest& test, double p, std::mt19937_64& random) {
    std::geometric_distribution<std::uint64_t> successes_before_failure(p);
    Outcome outcome;
    for (std::uint64_t failures = 0; failures <= CertificateTest::most_failures; ++failures) {
        const std::uint64_t failed_at = outcome.worlds + successes_before_failure(random) + 1;
        if (failed_at > test.stage_worlds(failures)) {
            return {true, test.stage_worlds(failures)};
        }
        outcome.worlds = failed_at;
    }
    return outcome;
}

/// Searches whose plans ask for a certificate one after the other.
struct Searches {
    std::uint64_t number = 0;
    std::uint64_t passed_at_once = 0;
    std::uint64_t passed = 0;
    std::uint64_t wrongly = 0;  ///< of them with a plan that fails more often than it may
    double worlds = 0;
};

/// @param next_p failure probability of the next plan of a search
Searches simulated(std::uint64_t number, std::uint64_t seed, const std::function<double(std::mt19937_64&)>& next_p) {
    std::vector<CertificateTest> tests;
    for (std::uint64_t attempt = 1; attempt <= attempts; ++attempt) {
        tests.emplace_back(max_failure_probability, confidence, attempt);
    }
    std::mt19937_64 random(seed);
    Searches searches{number};
    for (std::uint64_t i = 0; i < number; ++i) {
        for (std::size_t attempt = 0; attempt < tests.size(); ++attempt) {
            const double p = next_p(random);
            const Outcome outcome = tested(tests[attempt], p, random);
            searches.worlds += static_cast<double>(outcome.worlds);
            if (outcome.passes) {
                searches.passed_at_once += attempt == 0 ? 1 : 0;
                ++searches.passed;
                searches.wrongly += p > max_failure_probability ? 1 : 0;
                break;
            }
        }
    }
    return searches;
}

void print_row(const std::string& what, const Searches& searches) {
    const auto percent = [&](std::uint64_t count) {
        const FailureInterval share = failure_interval(count, searches.number, 0.95);
        return fmt::format("{:.2f} [{:.2f}, {:.2f}]", 100 * share.estimate, 100 * share.low, 100 * share.high);
    };
    fmt::print("| {} | {} | {} | {} | {:.0f} |\n", what, percent(searches.passed_at_once), percent(searches.passed),
               percent(searches.wrongly), searches.worlds / static_cast<double>(searches.number));
}

void run(std::uint64_t number) {
    fmt::print(
        "# The test for a certificate\n\nCommit {}; {} simulated searches in each row, {} plans in each at most, for a "
        "failure probability of at most 1 % with a confidence of 95 %. Shares of searches in percent, with 95 % "
        "intervals (Clopper and Pearson 1934). *Wrongly*: the certified plan fails more often than 1 %; that may be so "
        "in 5 % of the searches. `bench/certificate_test.sh` writes this page; [model.md "
        "9](../../docs/model.md#9-worlds) has the test and its proof.\n\n| failure probability of the plans | first "
        "plan passes | some plan passes | wrongly | worlds flown, mean |\n| --- | --: | --: | --: | --: |\n",
        bench::source_commit(), number, attempts);
    std::uint64_t seed = 0;
    for (const double percent : {0.01, 0.1, 0.3, 0.5, 0.8, 1.0, 1.000001, 1.1, 1.3, 1.6, 2.0, 3.0, 5.0, 10.0}) {
        print_row(fmt::format("{} %", percent),
                  simulated(number, ++seed, [&](std::mt19937_64&) { return percent / 100; }));
    }
    const auto spread = [](double low, double high) {
        return [low, high](std::mt19937_64& random) {
            return std::exp(std::uniform_real_distribution(std::log(low), std::log(high))(random));
        };
    };
    print_row("drawn from 0.3 to 3 %, evenly in the logarithm", simulated(number, ++seed, spread(0.003, 0.03)));
    print_row("drawn from 1 to 2 %, evenly in the logarithm", simulated(number, ++seed, spread(0.010001, 0.02)));
}

}  // namespace

int main(int argc, char** argv) {
    std::uint64_t number = 100'000;
    CLI::App program("How often plans pass the test for a certificate, as Markdown");
    program.add_option("--searches", number, "simulated searches in each row")->check(CLI::Range(1, 10'000'000));
    return bench::run_program(program, argc, argv, [&number] { run(number); });
}
