#include "downwash/simulation/flight_batch.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "downwash/simulation/flight_kernel.hpp"
#include "downwash/simulation/flight_lane.hpp"
#include "downwash/simulation/lane_pool.hpp"
#include "downwash/simulation/noise.hpp"

namespace downwash {
namespace {

using simulation::FlightKernelModel;
using simulation::FlightLane;
using simulation::FlightLanes;
using simulation::FlightSetting;
using simulation::lane_count;

constexpr int max_ticks_per_call = 1024;

/// The kernel for many lanes, and the one for so few that half the registers would do.
struct Kernels {
    simulation::FlightKernel for_many, for_few;
};

constexpr int few_lanes = lane_count / 2;

Kernels kernels_for(Instructions instructions, std::size_t law) {
#ifdef DOWNWASH_HAS_AVX2_KERNEL
    if (instructions == Instructions::avx2) {
        return {simulation::avx2_kernel(law), simulation::avx2_kernel(law)};
    }
#endif
#ifdef DOWNWASH_HAS_AVX512_KERNEL
    if (instructions == Instructions::avx512) {
        return {simulation::avx512_kernel(law), simulation::avx2_kernel(law)};
    }
#endif
    assert(instructions == Instructions::baseline);
    static_cast<void>(instructions);
    return {simulation::baseline_kernel(law), simulation::baseline_kernel(law)};
}

/// See LookAround. @param flights a std::vector of FlightLane
void look_around(void* flights, unsigned int lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
        (*static_cast<std::vector<FlightLane>*>(flights))[static_cast<std::size_t>(std::countr_zero(lanes))]
            .look_around();
    }
}

FlightKernelModel make_kernel_model(const FlightSetting& setting) {
    const simulation::TickModel& tick = setting.model.tick();
    const PlantModel& plant = tick.plant;
    FlightKernelModel kernel{};
    kernel.tick = tick;
    kernel.law = std::visit([](const auto& law) { return static_cast<const void*>(&law); }, tick.law);
    kernel.limits = simulation::rule_limits(setting.rules, setting.model.robot().arm);
    kernel.reach = simulation::motion_reach(setting.model);
    for (int i = 0; i < plant.rotor_count; ++i) {
        const double hub_m =
            std::sqrt(plant.rotor_x_m[i] * plant.rotor_x_m[i] + plant.rotor_z_m[i] * plant.rotor_z_m[i]);
        kernel.reach.body_m = std::max(kernel.reach.body_m, hub_m);
    }
    if (setting.map != nullptr) {
        kernel.maps = simulation::rotor_maps(setting.model, *setting.map);
    } else {
        kernel.maps = simulation::no_rotor_maps();
        kernel.tick.tilt_loss = no_tilt_loss;
    }
    kernel.delay_ticks = setting.model.nominal_world().numbers.delay_ticks;
    kernel.keeps_past = !setting.model.flies_plainly();
    kernel.normal_levels = simulation::normal_levels();
    kernel.look_around = look_around;
    return kernel;
}

/// The family of vehicles that fly in a vertical plane.
struct PlanarFamily {
    using Job = FlightJob;
    using Chain = FlightChain;
    class Lanes;

    PlanarFamily(const FlightModel& model, const AeroMap* map, FlightRules the_rules, const Goal* goal,
                 Instructions instructions)
        : rules(std::move(the_rules)),
          setting{model, map, rules, goal},
          kernel_model(make_kernel_model(setting)),
          has_wash(model.tick().slipstreams.count > 0 && model.tick().plant.has_drag),
          kernels(kernels_for(instructions, model.tick().law.index())) {}

    [[nodiscard]] bool is_over() const { return rules.is_over && rules.is_over(); }

    /// Chooses what the kernel does for these jobs.
    void prepare(std::span<const FlightJob> jobs);

    FlightRules rules;
    FlightSetting setting;
    FlightKernelModel kernel_model;
    bool has_wash;  ///< some slipstream may meet the arm
    Kernels kernels;
};

void PlanarFamily::prepare(std::span<const FlightJob> jobs) {
    const bool are_in_worlds =
        std::any_of(jobs.begin(), jobs.end(), [&](const FlightJob& job) { return job.world != nullptr; });
    kernel_model.kind = has_wash        ? simulation::TickKind::in_wash
                        : are_in_worlds ? simulation::TickKind::in_world
                                        : simulation::TickKind::nominal;
    kernel_model.has_noise = std::any_of(
        jobs.begin(), jobs.end(), [&](const FlightJob& job) { return job.world != nullptr && job.world->has_noise; });
    double longest_delay_ticks = kernel_model.delay_ticks;
    for (const FlightJob& job : jobs) {
        if (job.world != nullptr) {
            longest_delay_ticks = std::max(longest_delay_ticks, job.world->numbers.delay_ticks);
        }
    }
    const auto older = static_cast<int>(simulation::older_ticks(longest_delay_ticks));
    kernel_model.track_ticks = older > 0 ? simulation::recent_ticks + older : 0;
}

/// See FlightFamily.
class PlanarFamily::Lanes {
 public:
    explicit Lanes(const PlanarFamily& family)
        : family_(family),
          track_(family.kernel_model.track_ticks > 0
                     ? static_cast<std::size_t>(family.kernel_model.track_ticks + simulation::max_track_ticks)
                     : 0) {
        std::fill(std::begin(lanes_.track), std::end(lanes_.track), track_.data());
        flights_.reserve(lane_count);
        for (int i = 0; i < lane_count; ++i) {
            flights_.emplace_back(family.setting, lanes_, i,
                                  simulation::LaneTrack{track_.data(), family.kernel_model.track_ticks});
        }
        std::fill(std::begin(lanes_.flights), std::end(lanes_.flights), &flights_);
    }
    Lanes(const Lanes&) = delete;
    Lanes& operator=(const Lanes&) = delete;

    std::vector<FlightLane>& flights() noexcept { return flights_; }

    void fly(int busy) {
        const int max_ticks = track_.empty() ? max_ticks_per_call : simulation::max_track_ticks;
        (busy > few_lanes ? family_.kernels.for_many : family_.kernels.for_few)(family_.kernel_model, lanes_,
                                                                                max_ticks);
    }

 private:
    const PlanarFamily& family_;
    FlightLanes lanes_{};
    std::vector<simulation::TrackRow> track_;
    std::vector<FlightLane> flights_;
};

}  // namespace

struct FlightPool::Impl {
    Impl(const FlightModel& model, const AeroMap* map, FlightRules rules, const Goal* goal, int threads,
         Instructions instructions)
        : family(model, map, std::move(rules), goal, instructions), pool(family, threads) {}

    PlanarFamily family;
    simulation::LanePool<PlanarFamily> pool;
};

FlightPool::FlightPool(const FlightModel& model, const AeroMap* map, FlightRules rules, const Goal* goal, int threads,
                       Instructions instructions)
    : impl_(std::make_unique<Impl>(model, map, std::move(rules), goal, threads, instructions)) {}

FlightPool::~FlightPool() = default;

void FlightPool::use_threads(int threads) {
    impl_->pool.use_threads(threads);
}

const FlightRules& FlightPool::rules() const noexcept {
    return impl_->family.rules;
}

void FlightPool::fly(std::span<FlightJob> jobs) {
    impl_->family.prepare(jobs);
    impl_->pool.fly(jobs, {});
}

void FlightPool::fly(std::span<FlightChain* const> chains) {
    impl_->family.prepare({});
    impl_->pool.fly({}, chains);
}

}  // namespace downwash
