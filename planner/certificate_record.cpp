#include "downwash/planner/certificate_record.hpp"

#include <algorithm>
#include <string>

#include "downwash/base/quantile.hpp"

namespace downwash::planning {
namespace {

bool is_failure(const WorldSample& sample) {
    return sample.outcome != Outcome::ok;
}

bool comes_nearer(const WorldSample& a, const WorldSample& b) {
    return a.min_clearance_m < b.min_clearance_m;
}

}  // namespace

std::uint64_t CertificateRecord::worlds_wanted() const noexcept {
    if (has_failed()) {
        return 0;
    }
    const std::uint64_t stage = test_.stage_worlds(forgiven_ ? 0 : failures_);
    return stage > worlds() ? stage - worlds() : 0;
}

void CertificateRecord::give_up_if_hopeless() noexcept {
    constexpr double confidence = 0.8, least_probability = 0.1;
    if (failures_ > 0 && !forgiven_) {
        const double low = 1 - failure_bound(worlds() - failures_, worlds(), 1 - confidence);
        is_given_up_ = test_.passing_probability(failures_, worlds(), low) < least_probability;
    }
}

void CertificateRecord::add(const WorldSample& sample) {
    count(sample);
    samples_.push_back(sample);
}

void CertificateRecord::count(const WorldSample& sample) {
    if (is_failure(sample)) {
        ++(sample.goal < first_goal_ ? failures_before_ : failures_);
    }
}

std::vector<WorldSample> CertificateRecord::nearest_successes(std::size_t count) const {
    std::vector<WorldSample> nearest;
    std::copy_if(samples_.begin(), samples_.end(), std::back_inserter(nearest),
                 [](const WorldSample& sample) { return !is_failure(sample); });
    const auto end = nearest.begin() + static_cast<std::ptrdiff_t>(std::min(count, nearest.size()));
    std::partial_sort(nearest.begin(), end, nearest.end(), comes_nearer);
    nearest.erase(end, nearest.end());
    return nearest;
}

bool CertificateRecord::replace(const std::vector<WorldSample>& samples) {
    bool has_failure = false;
    for (const WorldSample& better : samples) {
        for (WorldSample& known : samples_) {
            if (known.world == better.world) {
                if (!is_failure(known)) {
                    count(better);
                }
                known = better;
            }
        }
        has_failure = has_failure || is_failure(better);
    }
    return has_failure;
}

Certificate CertificateRecord::certificate(bool is_given) const {
    constexpr std::size_t most_listed = 10;
    const std::string lateral_collision = "lateral_collision";
    Certificate certificate;
    certificate.is_given = is_given && passes();
    certificate.worlds = worlds();
    certificate.failures = failures_;
    certificate.is_refused = has_failed();
    certificate.max_failure_probability = max_failure_probability_;
    certificate.confidence = confidence_;
    certificate.attempts = attempt_;
    certificate.failure_probability = failure_interval(failures_, worlds(), confidence_);
    std::vector<double> clearances_m;
    for (const WorldSample& sample : samples_) {
        clearances_m.push_back(sample.min_clearance_m);
        if (is_failure(sample)) {
            ++certificate
                  .causes[sample.is_lateral_collision ? lateral_collision : std::string(name_of(sample.outcome))];
        }
    }
    if (!samples_.empty()) {
        certificate.clearance_m = {quantile(clearances_m, 0.01), quantile(clearances_m, 0.1),
                                   quantile(clearances_m, 0.5)};
    }
    certificate.worst = samples_;
    std::stable_sort(certificate.worst.begin(), certificate.worst.end(),
                     [](const WorldSample& a, const WorldSample& b) {
                         return is_failure(a) != is_failure(b) ? is_failure(a) : comes_nearer(a, b);
                     });
    certificate.worst.resize(std::min(most_listed, certificate.worst.size()));
    return certificate;
}

}  // namespace downwash::planning
