#include "downwash/simulation/flight_batch.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "downwash/base/parallel.hpp"
#include "downwash/simulation/flight_kernel.hpp"
#include "downwash/simulation/flight_lane.hpp"
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

}  // namespace

std::span<const Instructions> known_instructions() noexcept {
    static constexpr Instructions all[] = {Instructions::baseline, Instructions::avx2, Instructions::avx512};
    std::size_t known = 1;
#ifdef DOWNWASH_HAS_AVX2_KERNEL
    known += __builtin_cpu_supports("avx2") != 0 ? 1 : 0;
#endif
#ifdef DOWNWASH_HAS_AVX512_KERNEL
    known += known == 2 && __builtin_cpu_supports("avx512f") != 0 ? 1 : 0;
#endif
    return {all, known};
}

struct FlightPool::Impl {
    Impl(const FlightModel& model, const AeroMap* map, FlightRules the_rules, const Goal* goal,
         Instructions instructions)
        : rules(std::move(the_rules)),
          setting{model, map, rules, goal},
          kernel_model(make_kernel_model(setting)),
          has_wash(model.tick().slipstreams.count > 0 && model.tick().plant.has_drag),
          kernels(kernels_for(instructions, model.tick().law.index())) {}

    /// Flies jobs until none is left. Several threads may call it at once.
    void work() {
        FlightLanes lanes{};
        const int track_ticks = kernel_model.track_ticks;
        std::vector<simulation::TrackRow> track(
            track_ticks > 0 ? static_cast<std::size_t>(track_ticks + simulation::max_track_ticks) : 0);
        std::fill(std::begin(lanes.track), std::end(lanes.track), track.data());
        const int max_ticks = track_ticks > 0 ? simulation::max_track_ticks : max_ticks_per_call;
        std::vector<FlightLane> flights;
        flights.reserve(lane_count);
        for (int i = 0; i < lane_count; ++i) {
            flights.emplace_back(setting, lanes, i, simulation::LaneTrack{track.data(), track_ticks});
        }
        std::fill(std::begin(lanes.flights), std::end(lanes.flights), &flights);
        for (;;) {
            for (FlightLane& lane : std::span(flights).first(lanes_used)) {
                while (lane.is_free() && go_on(lane)) {
                }
            }
            const int busy = move_together(flights);
            if (busy == 0) {
                return;
            }
            for (FlightLane& lane : flights) {
                if (!lane.can_fly()) {
                    lane.idle_like(flights.front());
                }
            }
            (busy > few_lanes ? kernels.for_many : kernels.for_few)(kernel_model, lanes, max_ticks);
            const bool is_interrupted = rules.is_over && rules.is_over();
            for (FlightLane& lane : flights) {
                if (!lane.is_free()) {
                    lane.look(is_interrupted);
                }
            }
        }
    }

    /// Gives a free lane the next job: of its chain or, once that has ended, of those that nobody has begun.
    /// @return false if there is none
    bool go_on(FlightLane& lane) {
        for (;;) {
            if (FlightChain* const chain = lane.chain()) {
                if (FlightJob* const job = chain->next()) {
                    lane.begin(*job);
                    return true;
                }
                lane.follow(nullptr);
            }
            const std::size_t next = next_job++;
            if (next < jobs.size()) {
                lane.begin(jobs[next]);
                return true;
            }
            if (next >= chains.size()) {
                return false;
            }
            lane.follow(chains[next]);
        }
    }

    /// Moves the flights into the first lanes, and says how many there are.
    static int move_together(std::vector<FlightLane>& flights) {
        int busy = 0;
        for (FlightLane& lane : flights) {
            if (lane.is_free()) {
                continue;
            }
            FlightLane& first_free = flights[static_cast<std::size_t>(busy++)];
            if (first_free.is_free()) {
                first_free.move_from(lane);
            }
        }
        return busy;
    }

    /// See FlightPool::fly(). Either jobs or chains.
    void fly(std::span<FlightJob> all_jobs, std::span<FlightChain* const> all_chains);

    /// Waits for batches until the pool is closed.
    /// @param number of the thread, 1 for the first beside the calling one
    void stand_by(std::size_t number) {
        std::uint64_t seen = 0;
        for (;;) {
            {
                std::unique_lock lock(mutex);
                called.wait(lock, [&] { return is_closed || batch != seen; });
                if (is_closed) {
                    return;
                }
                seen = batch;
                if (number > helpers) {
                    continue;
                }
            }
            std::exception_ptr thrown;
            try {
                work();
            } catch (...) {
                thrown = std::current_exception();
            }
            const std::scoped_lock lock(mutex);
            if (thrown) {
                failure = thrown;
            }
            if (--working == 0) {
                done.notify_one();
            }
        }
    }

    FlightRules rules;
    FlightSetting setting;
    FlightKernelModel kernel_model;
    bool has_wash;  ///< some slipstream may meet the arm
    Kernels kernels;

    std::span<FlightJob> jobs;
    std::span<FlightChain* const> chains;
    std::size_t lanes_used = lane_count;   ///< of every thread: few jobs are shared out evenly
    std::atomic<std::size_t> next_job{0};  ///< or chain

    std::mutex mutex;
    std::condition_variable called, done;
    std::uint64_t batch = 0;
    std::atomic<std::size_t> allowed{0};  ///< threads beside the calling one that may fly
    std::size_t helpers = 0;              ///< that fly this batch
    std::size_t working = 0;              ///< of them, still at it
    std::exception_ptr failure;           ///< of a thread beside the calling one
    bool is_closed = false;
    std::vector<std::jthread> others;
};

FlightPool::FlightPool(const FlightModel& model, const AeroMap* map, FlightRules rules, const Goal* goal, int threads,
                       Instructions instructions)
    : impl_(std::make_unique<Impl>(model, map, std::move(rules), goal, instructions)) {
    impl_->others =
        start_threads(threads - 1, [impl = impl_.get()](int i) { impl->stand_by(static_cast<std::size_t>(i)); });
    use_threads(threads);
}

FlightPool::~FlightPool() {
    {
        const std::scoped_lock lock(impl_->mutex);
        impl_->is_closed = true;
    }
    impl_->called.notify_all();
    impl_->others.clear();  // joins
}

void FlightPool::use_threads(int threads) {
    impl_->allowed = std::min(static_cast<std::size_t>(threads - 1), impl_->others.size());
}

const FlightRules& FlightPool::rules() const noexcept {
    return impl_->rules;
}

void FlightPool::fly(std::span<FlightJob> jobs) {
    impl_->fly(jobs, {});
}

void FlightPool::fly(std::span<FlightChain* const> chains) {
    impl_->fly({}, chains);
}

void FlightPool::Impl::fly(std::span<FlightJob> all_jobs, std::span<FlightChain* const> all_chains) {
    jobs = all_jobs;
    chains = all_chains;
    next_job = 0;
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
    // One lane takes as long as two: two flights are not worth waking other threads.
    const std::size_t count = jobs.size() + chains.size();
    const std::size_t asked = count <= 2 ? 0 : allowed.load();
    lanes_used = std::clamp<std::size_t>((count + asked) / (asked + 1), 1, lane_count);
    if (asked == 0) {
        work();
        return;
    }
    {
        const std::scoped_lock lock(mutex);
        ++batch;
        helpers = asked;
        working = asked;
    }
    called.notify_all();
    std::exception_ptr own;
    try {
        work();
    } catch (...) {
        own = std::current_exception();  // the others still fly the jobs
    }
    std::unique_lock lock(mutex);
    done.wait(lock, [this] { return working == 0; });
    if (std::exception_ptr other = std::exchange(failure, nullptr); other && !own) {
        own = std::move(other);
    }
    if (own) {
        std::rethrow_exception(own);
    }
}

}  // namespace downwash
