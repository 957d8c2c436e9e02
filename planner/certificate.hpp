#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "downwash/base/export.hpp"

namespace downwash {

/// A flight of a plan in a world that failed.
struct FailedWorld {
    std::uint64_t world = 0;  ///< index, as of draw_world() with the problem's seed
    std::string cause;        ///< a Rejection by its name
};

/// What flights of a plan in worlds that no search has seen say about it.
struct Certificate {
    bool is_given = false;  ///< the failure probability is at most max_failure_probability, with this confidence
    std::uint64_t worlds = 0;
    std::uint64_t failures = 0;
    /// Clopper and Pearson's interval (1934) for the share of worlds in which the plan fails; both ends together have
    /// the confidence below.
    struct {
        double estimate, low, high;
    } failure_probability{0, 0, 1};
    double max_failure_probability = 0;
    double confidence = 0;
    std::uint64_t attempts = 0;  ///< plans of the search that asked for one; they share the error
    std::map<std::string, std::uint64_t> causes;
    std::vector<FailedWorld> failed;  ///< the first of them
};

/// The probability of at most `failures` among so many worlds, if each fails with probability p.
[[nodiscard]] DOWNWASH_EXPORT double binomial_probability(std::uint64_t failures, std::uint64_t worlds,
                                                          double p) noexcept;

/// The greatest p for which at most so many failures are not less likely than alpha (Clopper and Pearson 1934).
[[nodiscard]] DOWNWASH_EXPORT double failure_bound(std::uint64_t failures, std::uint64_t worlds, double alpha) noexcept;

/// When a plan passes: a test in stages. A plan passes stage k with at most k failures in stage_worlds(k); with more
/// failures than stages it fails. All plans of a search together pass by luck with probability 1 - confidence at most:
/// attempt a gets the share 1 / (a (a + 1)) of it, and each stage of it half of what is left.
class DOWNWASH_EXPORT CertificateTest {
 public:
    static constexpr std::uint64_t most_failures = 3;

    /// @param attempt from 1
    CertificateTest(double max_failure_probability, double confidence, std::uint64_t attempt);

    /// Worlds after which so many failures are few enough. @param failures at most most_failures
    [[nodiscard]] std::uint64_t stage_worlds(std::uint64_t failures) const noexcept { return stages_[failures]; }

 private:
    std::uint64_t stages_[most_failures + 1] = {};
};

}  // namespace downwash
