#include "volume.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "downwash/aeromap/volume_map.hpp"
#include "downwash/planner/solve.hpp"
#include "measuring.hpp"
#include "scenes.hpp"

namespace downwash::bench {
namespace {

/// A block of space as a VolumeMap holds it: 30 m3 under the deck of the bridge, its underside, the walkway's top and
/// edges, the cross girder.
struct UnderDeck {
    Bounds extent{-8, -2, 8, 10};
    double lateral_m = 1.25;  ///< to either side
};

/// Flyable hubs of a block, in the world.
class RandomHubs {
 public:
    RandomHubs(const FlightModel& model, const UnderDeck& block) : model_(model), block_(block) {}

    Vector3 one() {
        const Bounds& all = block_.extent;
        while (true) {
            const Vector3 at{uniform(all.x_low_m, all.x_high_m), uniform(-block_.lateral_m, block_.lateral_m),
                             uniform(all.z_low_m, all.z_high_m)};
            if (is_flyable(at)) {
                return at;
            }
        }
    }
    std::vector<Vector3> scattered(std::size_t count) {
        std::vector<Vector3> hubs(count);
        std::generate(hubs.begin(), hubs.end(), [this] { return in_world(one()); });
        return hubs;
    }
    /// Along straight flights of 1 m/s in any direction, looked up at 500 Hz.
    std::vector<Vector3> in_flight_order(std::size_t count) {
        constexpr double step_m = 0.002;
        std::vector<Vector3> hubs;
        while (hubs.size() < count) {
            Vector3 at = one();
            const double angle = uniform(-3.14, 3.14);
            const double climb = uniform(-0.5, 0.5);
            while (hubs.size() < count && is_flyable(at)) {
                hubs.push_back(in_world(at));
                at = {at[0] + step_m * std::cos(angle) * std::cos(climb),
                      at[1] + step_m * std::sin(angle) * std::cos(climb), at[2] + step_m * std::sin(climb)};
            }
        }
        return hubs;
    }

 private:
    double uniform(double low, double high) { return uniform_between(engine_, low, high); }
    [[nodiscard]] Vector3 in_world(const Vector3& at) const { return model_.plane().to_world(at[0], at[1], at[2]); }
    [[nodiscard]] bool is_flyable(const Vector3& at) const {
        const Bounds& all = block_.extent;
        return at[0] >= all.x_low_m && at[0] <= all.x_high_m && std::abs(at[1]) <= block_.lateral_m &&
               at[2] >= all.z_low_m && at[2] <= all.z_high_m && model_.effect(0).is_flyable(in_world(at));
    }

    const FlightModel& model_;
    const UnderDeck& block_;
    std::mt19937_64 engine_{1};
};

}  // namespace

VolumeFigures measured_volume(const Problem& bridge, int repetitions) {
    const UnderDeck block;
    const auto model = make_flight_model(bridge);
    const auto effect = std::make_shared<const DirectEffect>(model->effect(0));
    std::unique_ptr<const VolumeMap> map;
    const auto build = [&] {
        map =
            std::make_unique<const VolumeMap>(effect, model->plane(), block.extent, -block.lateral_m, block.lateral_m);
    };
    VolumeFigures f;
    f.growth_bytes = peak_growth_bytes(build);
    f.build_s = best_of(std::min(2, repetitions), build);
    f.bytes = static_cast<double>(map->memory_bytes());
    RandomHubs random(*model, block);
    const auto mean_of = [](int times, const std::vector<Vector3>& hubs, const auto& factor) {
        return best_of(times,
                       [&] {
                           double sum = 0;
                           for (const Vector3& hub_m : hubs) {
                               sum += factor(hub_m);
                           }
                           keep(sum);
                       }) /
               static_cast<double>(hubs.size());
    };
    const auto look_up_hub = [&map](const Vector3& hub_m) { return map->factor(hub_m); };
    constexpr int cold_batches = 20;
    for (int i = 0; i < cold_batches; ++i) {
        const std::vector<Vector3> hubs = random.scattered(1024);
        empty_caches();
        double touched = 0;
        for (const Vector3& hub_m : hubs) {
            touched += hub_m[0];
        }
        keep(touched);
        f.cold_s += mean_of(1, hubs, look_up_hub) / cold_batches;
    }
    constexpr std::size_t many = std::size_t{1} << 16U;
    constexpr int times = 30;
    f.scattered_s = mean_of(times, random.scattered(many), look_up_hub);
    f.in_flight_order_s = mean_of(times, random.in_flight_order(many), look_up_hub);
    f.direct_s =
        mean_of(repetitions, random.scattered(8192), [&effect](const Vector3& hub_m) { return effect->factor(hub_m); });
    return f;
}

}  // namespace downwash::bench
