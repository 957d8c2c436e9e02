#include "downwash/planner/certificate.hpp"

#include <utility>

namespace downwash {

double binomial_probability(std::uint64_t failures, std::uint64_t worlds, double p) noexcept {
    if (failures >= worlds) {
        return 1;
    }
    // (1 - p)^n may be too small for a double: powers of 2^-512 are counted apart.
    double power = 1;
    int scale = 0;  // powers of 2^-512 that are left out
    constexpr double tiny = 0x1p-512;
    for (std::uint64_t i = 0; i < worlds; ++i) {
        power *= 1 - p;
        if (power < tiny) {
            power /= tiny;
            ++scale;
        }
    }
    double term = power;
    double sum = term;
    for (std::uint64_t k = 1; k <= failures; ++k) {
        term *= static_cast<double>(worlds - k + 1) / static_cast<double>(k) * p / (1 - p);
        sum += term;
        if (scale > 0 && sum > 1 / tiny) {
            term *= tiny;
            sum *= tiny;
            --scale;
        }
    }
    for (; scale > 0; --scale) {
        sum *= tiny;
    }
    return sum < 1 ? sum : 1;
}

double failure_bound(std::uint64_t failures, std::uint64_t worlds, double alpha) noexcept {
    if (failures >= worlds) {
        return 1;
    }
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (binomial_probability(failures, worlds, middle) >= alpha ? low : high) = middle;
    }
    return high;
}

FailureInterval failure_interval(std::uint64_t failures, std::uint64_t worlds, double confidence) noexcept {
    if (worlds == 0) {
        return {};
    }
    const double alpha = 0.5 * (1 - confidence);
    return {static_cast<double>(failures) / static_cast<double>(worlds),
            failures == 0 ? 0 : 1 - failure_bound(worlds - failures, worlds, alpha),
            failure_bound(failures, worlds, alpha)};
}

CertificateTest::CertificateTest(double max_failure_probability, double confidence, std::uint64_t attempt) {
    constexpr double first_attempt = 2.0 / 3;
    constexpr double first_stage = 3.0 / 4;  // the two multiply to the half that one end of failure_interval() has
    const auto a = static_cast<double>(attempt);
    double left = (1 - confidence) * (attempt == 1 ? first_attempt : (1 - first_attempt) / (a * (a - 1)));
    std::uint64_t worlds = 1;
    for (std::uint64_t failures = 0; failures <= most_failures; ++failures) {
        const double alpha = failures < most_failures ? first_stage * left : left;
        left -= alpha;
        // The probability falls with the number of worlds: double it until it is enough, then halve what is between.
        const auto is_enough = [&](std::uint64_t number) {
            return binomial_probability(failures, number, max_failure_probability) <= alpha;
        };
        std::uint64_t too_few = worlds;
        while (!is_enough(worlds)) {
            too_few = worlds;
            worlds *= 2;
        }
        while (worlds - too_few > 1) {
            const std::uint64_t middle = too_few + (worlds - too_few) / 2;
            (is_enough(middle) ? worlds : too_few) = middle;
        }
        stages_[failures] = worlds;
    }
}

double CertificateTest::passing_probability(std::uint64_t failures, std::uint64_t worlds, double p) const noexcept {
    double passed = 0;
    double flying[most_failures + 1] = {};  // by failures: the probability of them, and not to have passed
    if (failures <= most_failures) {
        flying[failures] = 1;
    }
    for (std::uint64_t flown = worlds; flown <= stages_[most_failures]; ++flown) {
        for (std::uint64_t k = failures; k <= most_failures; ++k) {
            passed += flown >= stages_[k] ? std::exchange(flying[k], 0.0) : 0.0;
        }
        for (std::uint64_t k = most_failures; k > failures; --k) {
            flying[k] = (1 - p) * flying[k] + p * flying[k - 1];
        }
        if (failures <= most_failures) {
            flying[failures] *= 1 - p;
        }
    }
    return passed;
}

}  // namespace downwash
