#include "downwash/comparison/world_envelope.hpp"

#include <algorithm>
#include <mutex>

#include "downwash/base/parallel.hpp"

namespace downwash {

WorldEnvelope world_envelope(const ComparedPlan& plan, double tick_s, const EnvelopeWorlds& worlds) {
    WorldEnvelope envelope;
    envelope.seed = worlds.seed;
    envelope.first = worlds.first;
    envelope.tick_s = tick_s;
    std::mutex mutex;
    run_parallel(static_cast<std::size_t>(worlds.count), worlds.threads, [&](std::size_t i) {
        if (worlds.stop.stop_requested()) {
            return;
        }
        const std::vector<Vector3> places = plan.fly_in_world(worlds.seed, worlds.first + i);
        const std::scoped_lock lock(mutex);  // least and greatest numbers know no order
        ++envelope.flown;
        const std::size_t common = std::min(places.size(), envelope.low_m.size());
        for (std::size_t tick = 0; tick < common; ++tick) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                envelope.low_m[tick][axis] = std::min(envelope.low_m[tick][axis], places[tick][axis]);
                envelope.high_m[tick][axis] = std::max(envelope.high_m[tick][axis], places[tick][axis]);
            }
        }
        for (std::size_t tick = common; tick < places.size(); ++tick) {
            envelope.low_m.push_back(places[tick]);
            envelope.high_m.push_back(places[tick]);
        }
    });
    return envelope;
}

}  // namespace downwash
