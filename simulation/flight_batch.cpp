#include "downwash/simulation/flight_batch.hpp"

#include <algorithm>
#include <atomic>
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

/// The kernel for many lanes, and the one for so few that half a wide register would do.
struct Kernels {
    simulation::FlightKernel for_many, for_few;
};

constexpr int few_lanes = lane_count / 2;

Kernels kernels_for(Instructions instructions, const FlownLaw& flown) {
    const std::size_t law = flown.index();
    const bool is_aided = controllers::aids_of(flown).are_any();
#ifdef DOWNWASH_HAS_AVX2_KERNEL
    if (instructions == Instructions::avx2) {
        return {simulation::avx2_kernel(law, is_aided), simulation::avx2_kernel(law, is_aided)};
    }
#endif
#ifdef DOWNWASH_HAS_AVX512_KERNEL
    if (instructions == Instructions::avx512) {
        return {simulation::avx512_kernel(law, is_aided), simulation::avx2_kernel(law, is_aided)};
    }
#endif
    assert(instructions == Instructions::baseline);
    static_cast<void>(instructions);
    return {simulation::baseline_kernel(law, is_aided), simulation::baseline_kernel(law, is_aided)};
}

FlightKernelModel make_kernel_model(const FlightSetting& setting) {
    const simulation::TickModel& tick = setting.model.tick();
    const PlantModel& plant = tick.plant;
    FlightKernelModel kernel{};
    kernel.tick = &tick;
    kernel.law = std::visit([](const auto& law) { return static_cast<const void*>(&law); }, tick.law);
    kernel.limits = simulation::rule_limits(setting.rules, setting.model.robot().arm);
    kernel.reach = simulation::motion_reach(setting.model);
    for (int i = 0; i < plant.rotor_count; ++i) {
        const double hub_m =
            std::sqrt(plant.rotor_x_m[i] * plant.rotor_x_m[i] + plant.rotor_z_m[i] * plant.rotor_z_m[i]);
        kernel.reach.body_m = std::max(kernel.reach.body_m, hub_m);
    }
    kernel.has_map = setting.map != nullptr;
    if (kernel.has_map) {
        kernel.maps = simulation::rotor_maps(setting.model, *setting.map);
    }
    kernel.normal_levels = simulation::normal_levels();
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
          kernels(kernels_for(instructions, model.tick().law)) {}

    /// Flies jobs until none is left. Several threads may call it at once.
    void work() {
        FlightLanes lanes{};
        std::vector<FlightLane> flights;
        flights.reserve(lane_count);
        for (int i = 0; i < lane_count; ++i) {
            flights.emplace_back(setting, lanes, i);
        }
        for (;;) {
            for (FlightLane& lane : std::span(flights).first(lanes_used)) {
                while (lane.is_free()) {
                    const std::size_t job = next_job++;
                    if (job >= jobs.size()) {
                        break;
                    }
                    lane.begin(jobs[job]);
                }
            }
            const int busy = move_together(flights);
            if (busy == 0) {
                return;
            }
            for (FlightLane& lane : flights) {
                if (lane.is_free()) {
                    lane.idle_like(flights.front());
                }
            }
            (busy > few_lanes ? kernels.for_many : kernels.for_few)(kernel_model, lanes, max_ticks_per_call);
            const bool is_interrupted = rules.is_over && rules.is_over();
            for (FlightLane& lane : flights) {
                if (!lane.is_free()) {
                    lane.look(is_interrupted);
                }
            }
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

    /// See FlightPool::fly().
    void fly(std::span<FlightJob> all);

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
    Kernels kernels;

    std::span<FlightJob> jobs;
    std::size_t lanes_used = lane_count;  ///< of every thread: few jobs are shared out evenly
    std::atomic<std::size_t> next_job{0};

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
    impl_->fly(jobs);
}

void FlightPool::Impl::fly(std::span<FlightJob> all) {
    jobs = all;
    next_job = 0;
    const auto world_of = [&](const FlightJob& job) { return flown_world(setting.model, job.world); };
    kernel_model.is_in_worlds =
        std::any_of(jobs.begin(), jobs.end(), [&](const FlightJob& job) { return world_of(job) != nullptr; });
    kernel_model.has_noise = std::any_of(jobs.begin(), jobs.end(), [&](const FlightJob& job) {
        return world_of(job) != nullptr && world_of(job)->has_noise;
    });
    // One lane takes as long as two: two flights are not worth waking other threads.
    const std::size_t asked = jobs.size() <= 2 ? 0 : allowed.load();
    lanes_used = std::clamp<std::size_t>((jobs.size() + asked) / (asked + 1), 1, lane_count);
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
