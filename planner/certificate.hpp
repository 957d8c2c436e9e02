#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/simulation/execution.hpp"

namespace downwash {

/// A failure probability and its interval (Clopper and Pearson 1934).
struct FailureInterval {
    double estimate = 0, low = 0, high = 1;
};

/// How a plan flew in one world.
struct WorldSample {
    std::uint64_t world = 0;  ///< index, as of draw_world() with the problem's seed
    Outcome outcome = Outcome::ok;
    double min_clearance_m = 0;  ///< up to where the flight ended; infinity without obstacles
    std::size_t goal =
        0;  ///< number from 0 of the goal that a failed flight was on the way to, or missed. Not in files
    bool is_lateral_collision = false;  ///< in its plane the vehicle would have touched nothing. Not in files
};

/// When a plan passes: a test in stages. A plan passes stage k with at most k failures in stage_worlds(k); with more
/// failures than stages it fails. All plans of a search together pass by luck with probability 1 - confidence at most:
/// the first attempt gets two thirds of it, attempt a > 1 a third of 1 / (a (a - 1)); and each stage three quarters of
/// what is left of that. These weights are fixed before any flight: docs/model.md 9 has the proof. No stage gets more
/// than half of 1 - confidence, so the failure_interval() of a plan that passes never exceeds max_failure_probability.
class DOWNWASH_EXPORT CertificateTest {
 public:
    static constexpr std::uint64_t most_failures = 3;

    /// @param attempt from 1
    CertificateTest(double max_failure_probability, double confidence, std::uint64_t attempt);

    /// Worlds after which so many failures are few enough. @param failures at most most_failures
    [[nodiscard]] std::uint64_t stage_worlds(std::uint64_t failures) const noexcept { return stages_[failures]; }
    /// The probability that a plan passes that has failed in some of its first worlds, if it fails in others with
    /// probability p.
    [[nodiscard]] double passing_probability(std::uint64_t failures, std::uint64_t worlds, double p) const noexcept;

 private:
    std::uint64_t stages_[most_failures + 1] = {};
};

/// What flights of a plan in worlds that no search has seen say about it.
struct Certificate {
    bool is_given = false;  ///< the failure probability is at most max_failure_probability, with this confidence
    std::uint64_t worlds = 0;
    std::uint64_t failures = 0;
    /// The share of all worlds in which the plan fails, with the confidence below, by these flights alone: only
    /// is_given counts that the test has stages and that several plans asked.
    FailureInterval failure_probability;
    double max_failure_probability = 0;
    double confidence = 0;
    std::uint64_t attempts = 0;                   ///< plans of the search that asked for one; they share the error
    std::map<std::string, std::uint64_t> causes;  ///< failures by outcome; some collisions as lateral_collision
    struct {
        double p01, p10, p50;
    } clearance_m{0, 0, 0};          ///< quantiles of the least clearance of each flight
    std::vector<WorldSample> worst;  ///< failed flights first, then those that came nearest to an obstacle
    bool is_refused = false;         ///< it failed too often to pass or, in space, to be likely to. Not in files
};

/// The probability of at most `failures` among so many worlds, if each fails with probability p.
[[nodiscard]] DOWNWASH_EXPORT double binomial_probability(std::uint64_t failures, std::uint64_t worlds,
                                                          double p) noexcept;

/// The greatest p for which at most so many failures are not less likely than alpha (Clopper and Pearson 1934).
[[nodiscard]] DOWNWASH_EXPORT double failure_bound(std::uint64_t failures, std::uint64_t worlds, double alpha) noexcept;

/// What so many failures say about the failure probability; both ends together have the confidence.
[[nodiscard]] DOWNWASH_EXPORT FailureInterval failure_interval(std::uint64_t failures, std::uint64_t worlds,
                                                               double confidence) noexcept;

}  // namespace downwash
