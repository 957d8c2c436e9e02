#include "downwash/logs/candidate_series.hpp"

#include <utility>

namespace downwash::logs {

void choose(std::deque<CandidateSeries>& candidates, FlightLog& log) {
    for (const NamedSeries& each : named_series) {
        CandidateSeries* best = nullptr;
        for (CandidateSeries& candidate : candidates) {
            if (candidate.what == each.series && !candidate.series.empty() &&
                (best == nullptr || candidate.rank < best->rank)) {
                best = &candidate;
            }
        }
        for (const CandidateSeries& candidate : candidates) {
            if (candidate.what == each.series && candidate.invalid_rows > 0) {
                log.remarks.push_back(std::to_string(candidate.invalid_rows) + " rows of " + candidate.series.source +
                                      " (" + std::string(each.name) +
                                      ") are skipped, since the autopilot says that they are not valid");
            }
        }
        if (best == nullptr) {
            continue;
        }
        if (best->late_rows > 0) {
            log.remarks.push_back(std::to_string(best->late_rows) + " rows of " + best->series.source +
                                  " are skipped, since their times are not later than those before");
        }
        if (each.series == &FlightLog::rotor_commands) {
            log.rotor_unit = best->rotor_unit;
        }
        log.*each.series = std::move(best->series);
    }
}

}  // namespace downwash::logs
