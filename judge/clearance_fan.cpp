#include "downwash/judge/clearance_fan.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "downwash/base/quantile.hpp"

namespace downwash::judge {

ClearanceTrace clearance_trace(const JudgedFlight& flight, double step_s) {
    ClearanceTrace trace;
    for (const JudgedRow& row : flight.rows) {
        // A tick that is a step's boundary but for rounding belongs to the later step.
        const auto step = static_cast<std::size_t>(std::floor(row.t_s / step_s + 1e-6));
        // A vehicle that is lost, with a clearance that is no number, counts as one in contact.
        const auto clearance_m = static_cast<float>(row.clearance_m > 0 ? row.clearance_m : 0);
        while (trace.size() <= step) {
            trace.push_back(clearance_m);
        }
        trace[step] = std::min(trace[step], clearance_m);
    }
    // Contact may have been between two ticks.
    if (flight.outcome == Outcome::collision && !trace.empty()) {
        trace.back() = 0;
    }
    return trace;
}

ClearanceFan clearance_fan(const std::vector<ClearanceTrace>& traces, double step_s) {
    ClearanceFan fan;
    fan.step_s = step_s;
    std::size_t steps = 0;
    for (const ClearanceTrace& trace : traces) {
        steps = std::max(steps, trace.size());
    }
    for (std::size_t step = 0; step < steps; ++step) {
        std::vector<double> at_step;
        at_step.reserve(traces.size());
        for (const ClearanceTrace& trace : traces) {
            at_step.push_back(trace[std::min(step, trace.size() - 1)]);
        }
        std::sort(at_step.begin(), at_step.end());
        fan.minimum.push_back(at_step.front());
        fan.p01.push_back(quantile(at_step, 0.01));
        fan.p10.push_back(quantile(at_step, 0.1));
        fan.p50.push_back(quantile(at_step, 0.5));
    }
    return fan;
}

}  // namespace downwash::judge
