#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "downwash/base/export.hpp"
#include "downwash/planner/certificate.hpp"

namespace downwash::planning {

/// Flights of a plan in worlds, as they come, and what they say about it.
class DOWNWASH_EXPORT CertificateRecord {
 public:
    /// @param attempt from 1
    /// @param first_goal failures on the way to goals before it are counted apart, and just may not be too many
    /// @param forgiven if given, the test has its first stage alone, and so many failures do not matter in it
    CertificateRecord(double max_failure_probability, double confidence, std::uint64_t attempt,
                      std::size_t first_goal = 0, std::optional<std::uint64_t> forgiven = {})
        : test_(max_failure_probability, confidence, attempt),
          max_failure_probability_(max_failure_probability),
          confidence_(confidence),
          attempt_(attempt),
          first_goal_(first_goal),
          forgiven_(forgiven) {}

    [[nodiscard]] std::uint64_t worlds() const noexcept { return samples_.size(); }
    [[nodiscard]] std::uint64_t failures() const noexcept { return failures_ + failures_before_; }
    /// Few enough failures in enough worlds.
    [[nodiscard]] bool passes() const noexcept { return !has_failed() && worlds_wanted() == 0; }
    /// How many more worlds it takes to pass, if no other flight fails; 0 once nothing can change.
    [[nodiscard]] std::uint64_t worlds_wanted() const noexcept;
    /// Gives up where the plan is unlikely to pass: with a failure probability at the lower end of its interval. A test
    /// that ends early refuses good plans more often, and lets no more of the bad ones pass.
    void give_up_if_hopeless() noexcept;

    void add(const WorldSample& sample);
    /// The flights without a failure that came nearest to an obstacle.
    [[nodiscard]] std::vector<WorldSample> nearest_successes(std::size_t count) const;
    /// Takes flights again that are known better now. @return whether one of them failed
    bool replace(const std::vector<WorldSample>& samples);

    /// @param is_given as far as the caller is concerned; it takes enough worlds, too
    [[nodiscard]] Certificate certificate(bool is_given) const;

 private:
    [[nodiscard]] bool has_failed() const noexcept {
        return is_given_up_ || failures_ > most_failures() || failures_before_ > CertificateTest::most_failures;
    }
    [[nodiscard]] std::uint64_t most_failures() const noexcept {
        return forgiven_.value_or(CertificateTest::most_failures);
    }
    void count(const WorldSample& sample);

    CertificateTest test_;
    double max_failure_probability_;
    double confidence_;
    std::uint64_t attempt_;
    std::size_t first_goal_;
    std::optional<std::uint64_t> forgiven_;
    std::uint64_t failures_ = 0;
    bool is_given_up_ = false;
    std::uint64_t failures_before_ = 0;  ///< on the way to goals before the first
    std::vector<WorldSample> samples_;
};

}  // namespace downwash::planning
