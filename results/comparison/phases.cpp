#include "downwash/comparison/phases.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace downwash {

std::string_view name_of(FlightPhase phase) noexcept {
    switch (phase) {
        case FlightPhase::climb:
            return "climb";
        case FlightPhase::transit:
            return "transit";
        case FlightPhase::approach:
            return "approach";
        case FlightPhase::hover:
            return "hover";
    }
    return "";
}

std::vector<FlightPhase> phases_of(const PlannedFlight& planned) {
    const std::size_t count = planned.rows.size();
    std::vector<FlightPhase> phases(count, FlightPhase::transit);
    const auto rests = [&planned](std::size_t i) {
        const Vector3& v = planned.rows[i].reference_velocity_m_s;
        return dot(v, v) < rest_speed_m_s * rest_speed_m_s;
    };
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        end = begin + 1;
        if (!rests(begin)) {
            continue;
        }
        while (end < count && rests(end)) {
            ++end;
        }
        const double lasts_s = static_cast<double>(end - begin) * planned.tick_s;
        for (std::size_t i = begin; i < end && lasts_s >= least_hover_s; ++i) {
            phases[i] = FlightPhase::hover;
        }
    }
    // From the end: how far it is to the next hover.
    double to_hover_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = count; i-- > 0;) {
        if (phases[i] == FlightPhase::hover) {
            to_hover_m = 0;
            continue;
        }
        const Vector3& v = planned.rows[i].reference_velocity_m_s;
        to_hover_m += planned.tick_s * std::sqrt(dot(v, v));
        if (to_hover_m <= approach_m) {
            phases[i] = FlightPhase::approach;
        } else if (std::abs(v[2]) >= std::hypot(v[0], v[1]) && !rests(i)) {
            phases[i] = FlightPhase::climb;
        }
    }
    return phases;
}

}  // namespace downwash
