#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "../support/random.hpp"
#include "downwash/planner/certificate.hpp"
#include "downwash/planner/certificate_record.hpp"

// The test in stages that a plan has to pass for its certificate.

using namespace downwash;

namespace {

/// The share of searches in which some plan passes, all of which fail with probability p; ten plans in each.
double share_that_passes(double p, double max_p, double confidence, int searches) {
    test::Random random(4);
    std::vector<CertificateTest> tests;
    for (std::uint64_t attempt = 1; attempt <= 10; ++attempt) {
        tests.emplace_back(max_p, confidence, attempt);
    }
    int passed = 0;
    for (int i = 0; i < searches; ++i) {
        bool passes = false;
        for (std::size_t attempt = 0; attempt < tests.size() && !passes; ++attempt) {
            std::uint64_t failures = 0;
            for (std::uint64_t worlds = 1; failures <= CertificateTest::most_failures && !passes; ++worlds) {
                failures += random.uniform(0, 1) < p ? 1 : 0;
                passes = failures <= CertificateTest::most_failures && worlds >= tests[attempt].stage_worlds(failures);
            }
        }
        passed += passes ? 1 : 0;
    }
    return static_cast<double>(passed) / searches;
}

}  // namespace

TEST_CASE("Bounds of a failure probability are those of Clopper and Pearson") {
    CHECK(binomial_probability(0, 299, 0.01) == Approx(std::pow(0.99, 299)).epsilon(1e-12));
    CHECK(binomial_probability(0, 298, 0.01) > 0.05);
    CHECK(binomial_probability(0, 299, 0.01) < 0.05);
    CHECK(binomial_probability(2, 4, 0.5) == Approx(11.0 / 16));
    // Two-sided 95 % intervals as tabulated: 5 of 100, 0 of 20, 20 of 20, 10 of 1000.
    CHECK(failure_bound(5, 100, 0.025) == Approx(0.11283).margin(1e-5));
    CHECK(1 - failure_bound(95, 100, 0.025) == Approx(0.01643).margin(1e-5));
    CHECK(failure_bound(0, 20, 0.025) == Approx(0.16843).margin(1e-5));
    CHECK(failure_bound(20, 20, 0.025) == 1);
    CHECK(failure_bound(10, 1000, 0.025) == Approx(0.01831).margin(1e-5));
    // Where (1 - p)^n is no double any more.
    CHECK(binomial_probability(5000, 10000, 0.5) == Approx(0.504).margin(1e-3));
}

TEST_CASE("Stages are the least numbers of worlds that are enough, for rare failures too") {
    const CertificateTest usual(0.01, 0.95, 1);
    CHECK(usual.stage_worlds(0) == 368);
    const double alphas[] = {0.05 / 2, 0.05 / 8, 0.05 / 32, 0.05 / 96};
    double sum = 0;
    for (std::uint64_t failures = 0; failures <= CertificateTest::most_failures; ++failures) {
        CHECK(binomial_probability(failures, usual.stage_worlds(failures), 0.01) <= alphas[failures]);
        CHECK(binomial_probability(failures, usual.stage_worlds(failures) - 1, 0.01) > alphas[failures]);
        sum += alphas[failures];
    }
    CHECK(sum == Approx(0.05 * 2 / 3));
    const CertificateTest rare(1e-4, 0.999, 50);
    CHECK(rare.stage_worlds(0) == Approx(std::log(3 * 50 * 49 / (0.75 * 0.001)) / 1e-4).epsilon(1e-3));
}

TEST_CASE("The probability to pass is the share of simulated tests that do") {
    const CertificateTest test(0.01, 0.95, 2);
    test::Random random(11);
    for (const auto& [failures, worlds, p] : std::vector<std::tuple<std::uint64_t, std::uint64_t, double>>{
             {0, 0, 0.003}, {1, 100, 0.002}, {2, 400, 0.004}, {3, 1500, 0.005}}) {
        constexpr int trials = 4000;
        int passed = 0;
        for (int i = 0; i < trials; ++i) {
            std::uint64_t failed = failures;
            std::uint64_t flown = worlds;
            while (failed <= CertificateTest::most_failures && flown < test.stage_worlds(failed)) {
                failed += random.uniform(0, 1) < p ? 1 : 0;
                ++flown;
            }
            passed += failed <= CertificateTest::most_failures ? 1 : 0;
        }
        const double probability = test.passing_probability(failures, worlds, p);
        CAPTURE(failures, probability);
        CHECK(probability > 0.05);
        CHECK(probability < 0.95);
        const double deviation = std::sqrt(probability * (1 - probability) / trials);
        CHECK(static_cast<double>(passed) / trials == Approx(probability).margin(4 * deviation));
    }
    CHECK(test.passing_probability(0, 0, 0) == 1);
    CHECK(test.passing_probability(3, test.stage_worlds(3), 0.5) == 1);
    CHECK(test.passing_probability(CertificateTest::most_failures + 1, 10, 0) == 0);
}

TEST_CASE("A test is given up once the plan is unlikely to pass, and not for the failures of chance") {
    const auto is_refused = [](std::uint64_t failures, std::uint64_t worlds,
                               std::optional<std::uint64_t> forgiven = {}) {
        planning::CertificateRecord record(0.01, 0.95, 1, 0, forgiven);
        for (std::uint64_t world = 0; world < worlds; ++world) {
            record.add({world, world < failures ? Outcome::collision : Outcome::ok, 1, 0, false});
        }
        record.give_up_if_hopeless();
        return record.certificate(false).is_refused;
    };
    CHECK_FALSE(is_refused(0, 64));
    CHECK_FALSE(is_refused(1, 64));
    CHECK_FALSE(is_refused(2, 512));
    CHECK(is_refused(2, 64));
    CHECK(is_refused(3, 448));
    CHECK(is_refused(4, 1300));
    // With failures forgiven, so many do not matter, and one more ends it.
    CHECK_FALSE(is_refused(2, 64, 2));
    CHECK(is_refused(3, 64, 2));
}

TEST_CASE("The interval of a plan that passes does not exceed the failure probability that is allowed") {
    for (const double p : {0.2, 0.01, 0.001}) {
        for (const std::uint64_t attempt : {1, 2, 3, 20}) {
            const CertificateTest test(p, 0.95, attempt);
            for (std::uint64_t failures = 0; failures <= CertificateTest::most_failures; ++failures) {
                CHECK(failure_interval(failures, test.stage_worlds(failures), 0.95).high <= p);
            }
        }
    }
}

TEST_CASE("Plans that fail too often do not pass by luck more often than allowed, however many try") {
    CHECK(share_that_passes(0.0101, 0.01, 0.95, 1500) < 0.05 + 3 * std::sqrt(0.05 * 0.95 / 1500));
    CHECK(share_that_passes(0.055, 0.05, 0.8, 1500) < 0.2 + 3 * std::sqrt(0.2 * 0.8 / 1500));
    CHECK(share_that_passes(0.0005, 0.01, 0.95, 300) > 0.95);  // good ones do
}
