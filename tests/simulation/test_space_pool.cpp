#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <deque>
#include <map>
#include <memory>

#include "../support/error_of.hpp"
#include "../support/space_robots.hpp"
#include "downwash/scene/scene.hpp"
#include "downwash/simulation/space_flight.hpp"
#include "downwash/simulation/space_pool.hpp"

// Flights in space side by side: every job ends as one flight alone, whatever it flies with.

using namespace downwash;
using namespace downwash::test;

namespace {

/// Instructions and numbers of threads.
std::vector<std::pair<Instructions, int>> ways_to_fly() {
    std::vector<std::pair<Instructions, int>> ways{{best_instructions(), 3}};
    for (const Instructions instructions : known_instructions()) {
        ways.emplace_back(instructions, 1);
    }
    return ways;
}

bool is_same(const SpaceFlightLeg& a, const SpaceFlightLeg& b) {
    return a.flight.rejection == b.flight.rejection && a.flight.ticks == b.flight.ticks &&
           a.flight.max_tracking_error_m == b.flight.max_tracking_error_m &&
           a.flight.max_saturation == b.flight.max_saturation && a.flight.length_m == b.flight.length_m &&
           a.flight.max_tilt_rate_rad_s == b.flight.max_tilt_rate_rad_s && downwash::is_same(a.end, b.end);
}

bool is_same(const SpaceFlightJob& a, const SpaceFlightJob& b) {
    return std::equal(a.legs.begin(), a.legs.end(), b.legs.begin(), b.legs.end(),
                      [](const SpaceFlightLeg& x, const SpaceFlightLeg& y) { return is_same(x, y); });
}

/// Whether a vehicle is in a motion, to the last bit.
bool is_in(const SpaceMotion& motion, const AnySpaceState& state) {
    const double* q = state.plant.q;
    const double* u = state.plant.u;
    return std::equal(q, q + 3, motion.position_m.begin()) && std::equal(q + 3, q + 7, motion.attitude.begin()) &&
           std::equal(q + 7, q + 13, motion.joints_rad.begin()) && std::equal(u, u + 3, motion.velocity_m_s.begin()) &&
           std::equal(u + 3, u + 6, motion.body_rates_rad_s.begin()) &&
           std::equal(u + 6, u + 12, motion.joint_rates_rad_s.begin());
}

/// Worlds that differ in everything, some of them with noise, gusts and long delays. The first is the nominal one.
std::vector<SpaceWorld> some_worlds() {
    std::vector<SpaceWorld> worlds(11);
    for (std::size_t i = 1; i < worlds.size(); ++i) {
        const double s = static_cast<double>(i);
        SpaceWorld& world = worlds[i];
        world.ceiling_scale = 0.03 * s;
        world.ground_scale = -0.02 * s;
        world.scene_m = {0.01 * s, -0.02 * s, 0.005 * s};
        world.scene_yaw_rad = 0.01 * s;
        world.mass_scale = 0.01 * s;
        world.inertia_scale = -0.01 * s;
        world.link_mass_scale[1] = 0.02 * s;
        world.center_of_mass_m = {0.001 * s, -0.0005 * s, 0.002};
        world.thrust_scale = -0.004 * s;
        world.rotor_thrust_scale[i % 6] = -0.02;
        world.rotor_time_constant_s = 0.0005 * s;
        world.delay_s = i == 5 ? 0.04 : (i % 2 == 0 ? 0.004 : 0.012);
        world.position_bias_m = {0.002 * s, 0, -0.001 * s};
        world.attitude_bias_rad = {0.001 * s, 0.002, 0};
        world.joint_offset_rad[0] = 0.003 * s;
        world.wind_m_s = {0.1 * s, -0.3, 0.05};
        world.position_noise_m = i % 3 == 0 ? 0.003 : 0;
        world.gyro_noise_rad_s = i % 3 == 0 ? 0.02 : 0;
        world.gust_m_s = i % 2 == 0 ? 0.4 : 0;
        world.gust_length_level_m = 20;
        world.gust_length_up_m = 8;
        world.tape = 100 + i;
    }
    return worlds;
}

/// Flights along beginnings of the reference, each in a world of its own.
std::vector<SpaceFlightJob> some_jobs(const SpacePool& pool, const SpacePlan& plan,
                                      const std::vector<SpaceWorld>& worlds, std::size_t count) {
    std::vector<SpaceFlightJob> jobs;
    const std::vector<SpaceSegment> segments = plan.segments();
    for (std::size_t i = 0; i < count; ++i) {
        const SpaceWorld* const world = i % worlds.size() == 0 ? nullptr : &worlds[i % worlds.size()];
        SpaceFlightJob job{pool.state_at(motion_at_rest(plan.reference.front().point), world), {}, world, 7};
        for (std::size_t k = 0; k < 1 + i % segments.size(); ++k) {
            job.legs.push_back({segments[k]});
        }
        jobs.push_back(std::move(job));
    }
    return jobs;
}

/// The jobs by some instructions and threads.
std::vector<SpaceFlightJob> flown(const SpacePoolSetup& setup, std::vector<SpaceFlightJob> jobs,
                                  Instructions instructions = Instructions::baseline, int threads = 1) {
    SpacePool(setup, threads, instructions).fly(jobs);
    return jobs;
}

/// Whether a job ended as a flight alone.
void check_as_alone(const SpaceFlightJob& job, const SpaceFlight& alone) {
    const Rejection rejection = job.rejection();
    CHECK((rejection == Rejection::over_budget ? alone.outcome == Outcome::over_budget : rejection == alone.rejection));
    std::int64_t ticks = 0;
    double max_error_m = 0;
    for (const SpaceFlightLeg& leg : job.legs) {
        ticks += leg.flight.ticks;
        max_error_m = std::max(max_error_m, leg.flight.max_tracking_error_m);
    }
    const AnySpaceState& end = job.rejected_leg() != nullptr ? job.rejected_leg()->end : job.end();
    REQUIRE(static_cast<std::size_t>(ticks) + 1 == alone.rows.size());
    CHECK(max_error_m == alone.max_tracking_error_m);
    REQUIRE(is_in(alone.rows.back().motion, end));
    REQUIRE(alone.energy_j == end.plant.energy_j);
}

/// A deck over part of the reference, and a post beside it.
std::shared_ptr<const Scene> deck_and_post() {
    return std::make_shared<const Scene>(std::vector<Obstacle>{{"deck", Box{{1.4, 3, 0.2}}, {0.3, 0, 2.75}, {}},
                                                               {"post", Box{{0.2, 0.2, 3}}, {1.95, -0.55, 1.5}, {}}});
}

}  // namespace

TEST_CASE("flights in space side by side are those of the loop to the last bit, in any world and under either law") {
    const int joints = GENERATE(range(0, max_built_joints() + 1));
    const int law = GENERATE(0, 1);
    SpaceRobot robot = space_robot(joints);
    if (law == 1) {
        robot.controller.law = cascade_gains_for(robot.plant.time_constant_s, {});
    } else {
        std::get<SpaceInversion>(robot.controller.law).observer_gain_1_s = 3;
        robot.controller.delay_s = 0.013;
        if (joints == 2) {  // several steps in a tick
            robot.plant.links[0].viscous_friction_nm_s = 0.3;
            robot.plant.links[1].coulomb_friction_nm = 0.002;
        }
    }
    CAPTURE(joints, law);
    const SpacePlan plan = space_plan(joints);
    const std::vector<SpaceWorld> worlds = some_worlds();
    const SpacePoolSetup setup{robot};
    const std::vector<SpaceFlightJob> jobs = some_jobs(SpacePool(setup), plan, worlds, 2 * worlds.size() + 1);
    const std::vector<SpaceFlightJob> expected = flown(setup, jobs);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        INFO("job " << i);
        simulation::NoEffectInSpace none;
        const auto loop =
            simulation::make_space_loop({robot, worlds[i % worlds.size()], none, {}, /*is_refined=*/false});
        loop->start(motion_at_rest(plan.reference.front().point));
        std::int64_t tick = jobs[i].first_tick;
        double max_saturation = 0;
        for (const SpaceFlightLeg& leg : expected[i].legs) {
            // So long a delay may be more than a vehicle bears; what it does until then counts.
            REQUIRE((leg.flight.ticks == leg.segment.ticks() || i % worlds.size() == 5));
            max_saturation = 0;
            for (std::int64_t k = 0; k < leg.flight.ticks; ++k) {
                SpaceFlightRow row;
                loop->tick(tick++, leg.segment.at_tick(k), row);
                max_saturation = std::max(max_saturation, row.saturation);
            }
            REQUIRE(is_in(loop->motion(), leg.end));
            REQUIRE(loop->energy_j() == leg.end.plant.energy_j);
            REQUIRE(max_saturation == leg.flight.max_saturation);
            if (leg.flight.rejection != Rejection::none) {
                break;
            }
        }
    }
    for (const auto& [instructions, threads] : ways_to_fly()) {
        const std::vector<SpaceFlightJob> others = flown(setup, jobs, instructions, threads);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            INFO("job " << i << " with instructions " << static_cast<int>(instructions) << ", threads " << threads);
            REQUIRE(is_same(others[i], expected[i]));
        }
    }
}

TEST_CASE("a job in space depends neither on the others nor on their order, nor on where it is divided") {
    SpaceRobot robot = space_robot(2);
    std::get<SpaceInversion>(robot.controller.law).observer_gain_1_s = 3;
    const SpacePlan plan = space_plan(2);
    const std::vector<SpaceWorld> worlds = some_worlds();
    const SpacePoolSetup setup{robot};
    const std::vector<SpaceFlightJob> jobs = some_jobs(SpacePool(setup), plan, worlds, 23);
    const std::vector<SpaceFlightJob> expected = flown(setup, jobs, best_instructions());

    std::vector<SpaceFlightJob> reversed(jobs.rbegin(), jobs.rend());
    reversed = flown(setup, reversed, best_instructions(), 2);
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        REQUIRE(is_same(reversed[jobs.size() - 1 - i], expected[i]));
        REQUIRE(is_same(flown(setup, {jobs[i]}, best_instructions()).front(), expected[i]));
    }
    // Leg by leg: the state at the end of one is all that the next one needs, older motions included.
    for (std::size_t i = 3; i < jobs.size(); i += 4) {
        SpaceFlightJob part = jobs[i];
        for (const SpaceFlightLeg& leg : expected[i].legs) {
            part.legs = std::vector<SpaceFlightLeg>{{leg.segment}};
            SpacePool(setup).fly({&part, 1});
            REQUIRE(downwash::is_same(part.end(), leg.end));
            part.start = part.end();
            part.first_tick += leg.segment.ticks();
        }
    }
}

TEST_CASE("flights in space side by side end where one flight alone does, and for the same reason") {
    const int joints = GENERATE(0, 2);
    const bool looks_for_collisions = GENERATE(false, true);
    CAPTURE(joints, looks_for_collisions);
    SpaceRobot robot = space_robot(joints);
    const SpacePlan plan = space_plan(joints);
    const auto scene = deck_and_post();
    AeroSettings aero;
    aero.wall = {0.02, 0.04, 0.7};
    const SurfaceVolumes volumes(scene, aero, robot, PlaneOfMotion({0, 0, 0}, 0.3), {-2, 3, 0, 4}, -2.5, 2.5);
    SpaceRobotShape shape{{{Box{{0.9, 0.9, 0.1}}, {0, 0, 0}}}, {}};
    if (joints == 2) {
        robot.links[1].is_limited = true;
        robot.links[1].lower_limit_rad = -0.3;
        robot.links[1].upper_limit_rad = 0.25;
        robot.links[0].body = {{Box{{0.03, 0.03, 0.1}}, {0, 0, -0.08}}};
        robot.links[1].body = {{Box{{0.03, 0.03, 0.1}}, {0, 0, -0.08}}};
        robot.body = shape.bodies;
        shape = shape_of(robot);
    }
    const SpaceChecker checker(scene, shape);

    std::vector<SpaceWorld> worlds = some_worlds();
    for (int i = 0; i < 12; ++i) {  // nearer to the deck, nearer to the post, too weak, and too late
        SpaceWorld world;
        world.scene_m = i < 4 ? Vector3{0, 0, -0.1 * i} : Vector3{-0.07 * (i - 4), 0.02 * i, 0};
        world.thrust_scale = i == 10 ? -0.55 : 0;
        world.delay_s = i == 11 ? 0.085 : 0;
        worlds.push_back(world);
    }
    SpacePoolSetup setup{robot, simulation::space_aero(aero, robot.rotor_radius_m)};
    setup.volumes = &volumes;
    setup.checker = looks_for_collisions ? &checker : nullptr;
    SpaceFlightSettings settings;
    settings.aero = setup.aero;
    settings.checker = setup.checker;
    settings.is_refined = false;
    settings.first_tick = 7;
    std::vector<SpaceFlightJob> jobs;
    {
        const SpacePool pool(setup);
        for (std::size_t i = 0; i < worlds.size(); ++i) {
            SpaceFlightJob job{
                pool.state_at(motion_at_rest(plan.reference.front().point), &worlds[i]), {}, &worlds[i], 7};
            for (const SpaceSegment& segment : plan.segments()) {
                job.legs.push_back({segment});
            }
            jobs.push_back(job);
        }
    }
    const double budget_j = 1.02 * flown({robot}, {jobs[0]}).front().end().plant.energy_j;
    setup.energy_budget_j = settings.energy_budget_j = budget_j;
    const std::vector<SpaceFlightJob> expected = flown(setup, jobs);
    std::map<Rejection, int> ends;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        INFO("job " << i);
        simulation::VolumeSpaceEffect effect(volumes, robot);
        settings.effect = &effect;
        settings.world = worlds[i];
        const SpaceFlight alone = fly(robot, plan, motion_at_rest(plan.reference.front().point), settings);
        const SpaceFlightJob& job = expected[i];
        ++ends[job.rejection()];
        check_as_alone(job, alone);
    }
    CHECK(ends[Rejection::none] > 0);
    CHECK((looks_for_collisions || ends[Rejection::unstable] > 0));  // what is lost meets something before
    CHECK(ends[looks_for_collisions ? Rejection::collision : Rejection::flyable_area] > 1);
    CHECK(ends[Rejection::over_budget] > 0);
    for (const auto& [instructions, threads] : ways_to_fly()) {
        const std::vector<SpaceFlightJob> others = flown(setup, jobs, instructions, threads);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            INFO("job " << i << " with instructions " << static_cast<int>(instructions) << ", threads " << threads);
            REQUIRE(is_same(others[i], expected[i]));
        }
    }
}

TEST_CASE("surfaces act on flights in space side by side as on one alone, whatever the model and the field") {
    const int joints = GENERATE(0, 2);
    const SpaceRobot robot = space_robot(joints);
    const auto scene =
        std::make_shared<const Scene>(std::vector<Obstacle>{{"floor", Box{{20, 20, 1}}, {0, 0, -0.5}, {}},
                                                            {"step", Box{{2, 20, 0.4}}, {1.2, 0, 0.2}, {}},
                                                            {"plate", Box{{3, 2, 0.1}}, {0, 1.1, 1.1}, {0, 0, 0.3}},
                                                            {"wall", Box{{0.1, 4, 2}}, {-0.9, 0, 1}, {}}});
    SpacePoint from, to;
    from.position[space::x] = -0.25;
    from.position[space::y] = 0.1;
    from.position[space::z] = 0.6;
    to.position[space::x] = -0.05;
    to.position[space::y] = 0.25;
    to.position[space::z] = 0.7;
    to.position[space::yaw] = 0.4;
    const int ticks = 60;
    SpacePlan plan;
    plan.tick_s = 0.01;
    plan.joints = joints;
    plan.reference = {{0, from}, {ticks, to}};
    std::vector<SpaceWorld> worlds = some_worlds();
    worlds.erase(worlds.begin() + 7, worlds.end());
    for (const double up_m : {0.0, 0.1, 0.2, 0.21, 0.22}) {  // some lift the step to where rotors may not fly
        worlds.emplace_back().scene_m = {-0.4, 0, up_m};
    }

    std::vector<AeroSettings> all(4);
    all[1].ground = all[1].ceiling = EffectModel::multirotor_images;
    all[2].ground = EffectModel::multirotor_body;
    all[2].tilt_loss.ceiling = 0.2;
    all[3].wall = {0.02, 0.04, 0.7};
    std::vector<AnySpaceState> ends;
    for (std::size_t model = 0; model < all.size(); ++model) {
        const AeroSettings& aero = all[model];
        const SurfaceVolumes volumes(scene, aero, robot, {}, {-1, 0.1, 0.2, 1.2}, -1, 1);  // ends among the rotors
        for (const bool is_direct : {false, true}) {
            CAPTURE(joints, model, is_direct);
            const auto make_effect = [&]() -> std::unique_ptr<simulation::SpaceEffect> {
                if (is_direct) {
                    return std::make_unique<simulation::DirectSpaceEffect>(scene, aero, robot);
                }
                return std::make_unique<simulation::VolumeSpaceEffect>(volumes, robot);
            };
            SpacePoolSetup setup{robot, simulation::space_aero(aero, robot.rotor_radius_m)};
            if (is_direct) {
                setup.make_effect = make_effect;
            } else {
                setup.volumes = &volumes;
            }
            std::vector<SpaceFlightJob> jobs;
            {
                const SpacePool pool(setup);
                for (const SpaceWorld& world : worlds) {
                    jobs.push_back({pool.state_at(motion_at_rest(from), &world), {{plan.segment_to(1)}}, &world, 7});
                }
            }
            const std::vector<SpaceFlightJob> expected = flown(setup, jobs);
            std::map<Rejection, int> rejections;
            for (std::size_t i = 0; i < jobs.size(); ++i) {
                INFO("job " << i);
                const auto effect = make_effect();
                SpaceFlightSettings settings;
                settings.world = worlds[i];
                settings.effect = effect.get();
                settings.aero = setup.aero;
                settings.first_tick = 7;
                settings.is_refined = false;
                check_as_alone(expected[i], fly(robot, plan, motion_at_rest(from), settings));
                ++rejections[expected[i].rejection()];
            }
            CHECK(rejections[Rejection::none] > 6);
            CHECK(rejections[Rejection::flyable_area] > 0);
            for (const auto& [instructions, threads] : ways_to_fly()) {
                const std::vector<SpaceFlightJob> others = flown(setup, jobs, instructions, threads);
                for (std::size_t i = 0; i < jobs.size(); ++i) {
                    INFO("job " << i << " with instructions " << static_cast<int>(instructions) << ", threads "
                                << threads);
                    REQUIRE(is_same(others[i], expected[i]));
                }
            }
            ends.push_back(expected[0].end());
        }
    }
    // Each model and field moved the vehicle in a way of its own, fields of one model nearly alike.
    const auto apart_m = [&](std::size_t i, std::size_t k) {
        const double* a = ends[i].plant.q;
        const double* b = ends[k].plant.q;
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    for (std::size_t i = 0; i < ends.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            CAPTURE(i, k);
            CHECK(apart_m(i, k) > (i / 2 == k / 2 ? 0 : 1e-5));
            CHECK((i / 2 != k / 2 || apart_m(i, k) < 2e-3));
        }
    }
}

TEST_CASE("chains of jobs in space, and flights that are ended from outside") {
    const SpaceRobot robot = space_robot(1);
    const SpacePlan plan = space_plan(1);
    SpacePoolSetup setup{robot};

    /// Flies the reference segment by segment.
    class Chain final : public SpaceFlightChain {
     public:
        Chain(const AnySpaceState& start, const std::vector<SpaceSegment>& segments, std::size_t count)
            : start_(start), segments_(segments), count_(count) {}
        SpaceFlightJob* next() override {
            if (flown_.size() == count_) {
                return nullptr;
            }
            const AnySpaceState& from = flown_.empty() ? start_ : flown_.back().end();
            SpaceFlightJob job{from, {{segments_[flown_.size()]}}};
            flown_.push_back(std::move(job));
            return &flown_.back();
        }
        [[nodiscard]] const AnySpaceState& end() const { return flown_.back().end(); }

     private:
        AnySpaceState start_;
        const std::vector<SpaceSegment>& segments_;
        std::size_t count_;
        std::deque<SpaceFlightJob> flown_;
    };
    SpacePool pool(setup, 2);
    const std::vector<SpaceSegment> segments = plan.segments();
    const AnySpaceState start = pool.state_at(motion_at_rest(plan.reference.front().point));
    std::deque<Chain> chains;
    std::vector<SpaceFlightChain*> all;
    for (std::size_t i = 0; i < 9; ++i) {
        all.push_back(&chains.emplace_back(start, segments, 1 + i % 4));
    }
    pool.fly(all);
    SpaceFlightJob whole{start, {}};
    for (const SpaceSegment& segment : segments) {
        whole.legs.push_back({segment});
    }
    pool.fly({&whole, 1});
    for (std::size_t i = 0; i < 9; ++i) {
        CHECK(is_same(chains[i].end(), whole.legs[i % 4].end));
    }

    setup.is_over = [] { return true; };
    SpaceFlightJob ended{start, whole.legs};
    SpacePool(setup).fly({&ended, 1});
    CHECK(ended.rejection() == Rejection::interrupted);

    SpaceRobot long_arm = space_robot(3);
    while (long_arm.joints() <= max_built_joints() && long_arm.joints() < max_joints) {
        long_arm.plant.links.push_back(long_arm.plant.links.back());
        long_arm.links.push_back(long_arm.links.back());
    }
    if (long_arm.joints() > max_built_joints()) {
        CHECK(error_of([&] { SpacePool(SpacePoolSetup{long_arm}); }).find("DOWNWASH_MAX_JOINTS") != std::string::npos);
    }
}
