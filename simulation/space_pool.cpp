#include "downwash/simulation/space_pool.hpp"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "downwash/base/key_error.hpp"
#include "downwash/simulation/lane_pool.hpp"
#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/space_kernel.hpp"
#include "downwash/simulation/space_lane.hpp"

#ifndef DOWNWASH_MAX_JOINTS
#error "the build says how many joints an arm in space may have"
#endif

namespace downwash {

struct SpacePool::Impl {
    Impl() = default;
    virtual ~Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    [[nodiscard]] virtual AnySpaceState state_at(const SpaceMotion& motion, const SpaceWorld* world,
                                                 const SpaceCarry& carry) const = 0;
    virtual void fly(std::span<SpaceFlightJob> jobs, std::span<SpaceFlightChain* const> chains) = 0;
    virtual void use_threads(int threads) = 0;
};

namespace {

using simulation::lane_count;
using simulation::SpaceKernel;
using simulation::SpaceKernelModel;
using simulation::SpaceLane;
using simulation::SpaceLanes;
using simulation::SpaceSetting;

/// The kernel for many lanes, and the one for so few that half the registers would do.
template <int n>
struct SpaceKernels {
    SpaceKernel<n> for_many, for_few;
};

template <int n>
SpaceKernels<n> space_kernels_for(Instructions instructions, std::size_t law) {
#ifdef DOWNWASH_HAS_AVX2_KERNEL
    if (instructions == Instructions::avx2) {
        return {simulation::avx2_space_kernel<n>(law), simulation::avx2_space_kernel<n>(law)};
    }
#endif
#ifdef DOWNWASH_HAS_AVX512_KERNEL
    if (instructions == Instructions::avx512) {
        return {simulation::avx512_space_kernel<n>(law), simulation::avx2_space_kernel<n>(law)};
    }
#endif
    assert(instructions == Instructions::baseline);
    static_cast<void>(instructions);
    return {simulation::baseline_space_kernel<n>(law), simulation::baseline_space_kernel<n>(law)};
}

/// How far a motion moves any point of a robot, hubs included.
SpaceReach reach_of(const SpacePoolSetup& setup) {
    SpaceReach reach = setup.checker != nullptr ? setup.checker->reach() : SpaceReach{};
    SpaceReach::Body& multirotor = reach.bodies[0];
    multirotor.can_touch = true;
    for (const SpaceRotor& rotor : setup.robot.plant.rotors) {
        multirotor.center_m = std::max(multirotor.center_m, std::sqrt(dot(rotor.position_m, rotor.position_m)));
    }
    return reach;
}

/// See SpaceLookAround. @param flights a std::vector of SpaceLane<n>
template <int n>
void look_around(void* flights, unsigned int lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
        (*static_cast<std::vector<SpaceLane<n>>*>(flights))[static_cast<std::size_t>(std::countr_zero(lanes))]
            .look_around();
    }
}

constexpr simulation::AskedSpaceEffect asked_effect{
    [](simulation::SpaceEffect* effect, int rotor, const dynamics::LaneVector<double>& hub_m,
       const dynamics::LaneRotation<double>& attitude) { return effect->at_turned_rotor(rotor, hub_m, attitude); },
    [](simulation::SpaceEffect* effect, const dynamics::LaneVector<double>& center_m,
       const dynamics::LaneRotation<double>& attitude) { return effect->at_turned_body(center_m, attitude); },
    [](simulation::SpaceEffect* effect, const dynamics::LaneVector<double>& center_m) {
        return effect->wall_nearness(center_m);
    }};

/// The family of vehicles that fly in space with an arm of n joints.
template <int n>
struct SpaceFamily {
    using Job = SpaceFlightJob;
    using Chain = SpaceFlightChain;

    SpaceFamily(const SpacePoolSetup& setup, Instructions instructions)
        : setting{setup, {}, make_space_world<n>(setup.robot, {})},
          model(make_model(setup)),
          kernels(space_kernels_for<n>(instructions, setup.robot.controller.law.index())) {
        model.law = std::visit([](const auto& law) { return static_cast<const void*>(&law); }, model.tick.law);
    }
    SpaceFamily(const SpaceFamily&) = delete;
    SpaceFamily& operator=(const SpaceFamily&) = delete;

    [[nodiscard]] bool is_over() const { return setting.setup.is_over && setting.setup.is_over(); }

    /// Chooses how much flights remember in these jobs.
    void prepare(std::span<const SpaceFlightJob> jobs) {
        const SpaceController& controller = setting.setup.robot.controller;
        double longest_ticks = setting.nominal.numbers.delay_ticks;
        for (const SpaceFlightJob& job : jobs) {
            if (job.world != nullptr) {
                longest_ticks = std::max(longest_ticks, simulation::delay_ticks(controller.delay_s + job.world->delay_s,
                                                                                controller.rate_hz));
            }
        }
        model.track_ticks = simulation::recent_ticks + static_cast<int>(simulation::older_ticks(longest_ticks));
    }

    /// See FlightFamily.
    class Lanes {
     public:
        explicit Lanes(const SpaceFamily& family)
            : family_(family),
              track_(static_cast<std::size_t>(family.model.track_ticks + simulation::max_space_ticks)),
              patches_(static_cast<std::size_t>(family.model.volumes.patches())) {
            if (family.setting.setup.make_effect) {
                effect_ = family.setting.setup.make_effect();
            }
            std::fill(std::begin(lanes_.track), std::end(lanes_.track), track_.data());
            std::fill(std::begin(lanes_.patches), std::end(lanes_.patches), patches_.data());
            std::fill(std::begin(lanes_.effect), std::end(lanes_.effect), effect_.get());
            flights_.reserve(lane_count);
            for (int i = 0; i < lane_count; ++i) {
                flights_.emplace_back(family.setting, family.model, lanes_, track_.data(), i);
            }
            std::fill(std::begin(lanes_.flights), std::end(lanes_.flights), &flights_);
        }
        Lanes(const Lanes&) = delete;
        Lanes& operator=(const Lanes&) = delete;

        std::vector<SpaceLane<n>>& flights() noexcept { return flights_; }

        void fly(int busy) {
            const SpaceKernels<n>& kernels = family_.kernels;
            (busy > lane_count / 2 ? kernels.for_many : kernels.for_few)(family_.model, lanes_,
                                                                         simulation::max_space_ticks);
        }

     private:
        const SpaceFamily& family_;
        SpaceLanes<n> lanes_{};
        std::vector<simulation::SpaceTrackRow<n>> track_;
        std::vector<VolumePatches<lane_count>> patches_;
        std::unique_ptr<simulation::SpaceEffect> effect_;
        std::vector<SpaceLane<n>> flights_;
    };

    static SpaceKernelModel<n> make_model(const SpacePoolSetup& setup) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        SpaceKernelModel<n> model{};
        model.tick = simulation::make_space_tick_model<n>(setup.robot, setup.aero);
        model.step = {dynamics::joint_steps(model.tick.nominal.plant, model.tick.tick_s)};
        model.reach = reach_of(setup);
        const double beyond_rad = setup.rules && setup.rules->keeps_joint_limits ? 0 : joint_swing_rad;
        for (int i = 0; i < n; ++i) {
            const SpaceLinkLimits& link = setup.robot.links[static_cast<std::size_t>(i)];
            const bool counts = setup.checker != nullptr && link.is_limited;
            model.joint_low_rad[i] = counts ? link.lower_limit_rad - beyond_rad : -infinity;
            model.joint_high_rad[i] = counts ? link.upper_limit_rad + beyond_rad : infinity;
        }
        model.least_upright_cosine = lane::sin_cos(unstable_pitch_rad).cosine;
        model.max_state = max_state;
        model.max_result = max_result;
        if (setup.volumes != nullptr) {
            model.volumes = simulation::views_of(*setup.volumes, setup.robot);
        }
        model.ask = asked_effect;
        model.normal_levels = simulation::normal_levels();
        model.look_around = look_around<n>;
        return model;
    }

    SpaceSetting<n> setting;
    SpaceKernelModel<n> model;
    SpaceKernels<n> kernels;
};

template <int n>
class SpacePoolOf final : public SpacePool::Impl {
 public:
    SpacePoolOf(const SpacePoolSetup& setup, int threads, Instructions instructions)
        : family_(setup, instructions), pool_(family_, threads) {}

    [[nodiscard]] AnySpaceState state_at(const SpaceMotion& motion, const SpaceWorld* world,
                                         const SpaceCarry& carry) const override {
        simulation::SpaceFlightState<double, n> state{};
        static_cast<simulation::SpaceVehicle<double, n>&>(state) =
            simulation::vehicle_at(family_.model.tick, motion, carry);
        state.world = memory_at_start(
            world != nullptr ? make_space_world<n>(family_.setting.setup.robot, *world) : family_.setting.nominal,
            state.plant);
        AnySpaceState any{};
        simulation::copy_common(state, any);
        return any;
    }
    void fly(std::span<SpaceFlightJob> jobs, std::span<SpaceFlightChain* const> chains) override {
        family_.prepare(jobs);
        pool_.fly(jobs, chains);
    }
    void use_threads(int threads) override { pool_.use_threads(threads); }

 private:
    SpaceFamily<n> family_;
    simulation::LanePool<SpaceFamily<n>> pool_;
};

template <int... n>
std::unique_ptr<SpacePool::Impl> made(const SpacePoolSetup& setup, int threads, Instructions instructions,
                                      std::integer_sequence<int, n...> /*built*/) {
    using Make = std::unique_ptr<SpacePool::Impl> (*)(const SpacePoolSetup&, int, Instructions);
    static constexpr Make make[] = {[](const SpacePoolSetup& its, int its_threads,
                                       Instructions its_instructions) -> std::unique_ptr<SpacePool::Impl> {
        return std::make_unique<SpacePoolOf<n>>(its, its_threads, its_instructions);
    }...};
    return make[setup.robot.joints()](setup, threads, instructions);
}

}  // namespace

SpacePool::SpacePool(const SpacePoolSetup& setup, int threads, Instructions instructions) {
    simulation::require_built_joints(setup.robot);
    impl_ = made(setup, threads, instructions, std::make_integer_sequence<int, DOWNWASH_MAX_JOINTS + 1>());
}

SpacePool::~SpacePool() = default;

AnySpaceState SpacePool::state_at(const SpaceMotion& motion, const SpaceWorld* world, const SpaceCarry& carry) const {
    return impl_->state_at(motion, world, carry);
}

void SpacePool::fly(std::span<SpaceFlightJob> jobs) {
    impl_->fly(jobs, {});
}

void SpacePool::fly(std::span<SpaceFlightChain* const> chains) {
    impl_->fly({}, chains);
}

void SpacePool::use_threads(int threads) {
    impl_->use_threads(threads);
}

}  // namespace downwash
