#include <catch2/catch.hpp>
#include <deque>
#include <map>

#include "../support/repetitions.hpp"
#include "../support/short_of_memory.hpp"
#include "hover_scenes.hpp"

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

/// Flights of one to three legs all over a scene: through obstacles, too fast, from moving starts.
std::vector<FlightJob> random_jobs(const Problem& problem, const FlightModel& model, int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<FlightJob> jobs;
    while (static_cast<int>(jobs.size()) < count) {
        ReferencePoint from =
            at_rest({random.uniform(problem.bounds.x_low_m, problem.bounds.x_high_m),
                     random.uniform(problem.bounds.z_low_m, problem.bounds.z_high_m), random.uniform(-3, 3)});
        const PlanarPose pose{from.position[0], from.position[1], random.uniform(-0.05, 0.05), from.position[2]};
        const double u[4] = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0, random.uniform(-0.1, 0.1)};
        if (model.collisions().is_nearer_than(pose, 0.05)) {
            continue;
        }
        FlightJob job{model.state_at(pose, u), {}};
        for (int leg = random.integer(1, 3); leg > 0; --leg) {
            ReferencePoint to = from;
            to.position[0] += random.uniform(-3, 3);
            to.position[1] += random.uniform(-1, 1);
            to.position[2] += random.uniform(-1, 1);
            to.velocity[0] = leg > 1 ? random.uniform(-0.3, 0.3) : 0;
            job.legs.push_back({{from, to, random.integer(200, 900), model.tick().tick_s}});
            from = to;
        }
        jobs.push_back(std::move(job));
    }
    return jobs;
}

/// Counts of rejections, after every leg was found the same to the last bit.
std::map<Rejection, int> rejections_of_equal_flights(const Problem& problem, bool is_aware, const FlightRules& rules,
                                                     int count) {
    const auto model = make_flight_model(problem);
    const auto map = is_aware ? model->make_map(problem.bounds) : nullptr;
    const std::vector<FlightJob> jobs = random_jobs(problem, *model, count, 5);
    std::vector<FlightJob> expected = jobs;
    fly_one_by_one(*model, map.get(), rules, expected);
    for (const auto& [instructions, threads] : ways_to_fly()) {
        std::vector<FlightJob> flown = jobs;
        // Several threads fill a map of their own as they go; the others find what was filled before.
        const auto own_map = map && threads > 1 ? model->make_map(problem.bounds) : map;
        FlightPool(*model, own_map.get(), rules, nullptr, threads, instructions).fly(flown);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            INFO("job " << i << " with instructions " << static_cast<int>(instructions) << ", threads " << threads);
            REQUIRE(flown[i].rejection() == expected[i].rejection());
            for (std::size_t leg = 0; leg < jobs[i].legs.size(); ++leg) {
                REQUIRE(is_same(flown[i].legs[leg], expected[i].legs[leg]));
            }
        }
    }
    std::map<Rejection, int> rejections;
    for (const FlightJob& job : expected) {
        ++rejections[job.rejection()];
    }
    return rejections;
}

}  // namespace

TEST_CASE("edges that fly side by side come out bit for bit as one by one, whatever ends them") {
    const Problem problem = cluttered_problem();
    const auto aware = rejections_of_equal_flights(problem, true, rules_of(problem), 300);
    for (const Rejection rejection :
         {Rejection::none, Rejection::collision, Rejection::flyable_area, Rejection::tracking, Rejection::bounds}) {
        INFO("rejection " << static_cast<int>(rejection));
        CHECK(aware.count(rejection) == 1);  // or the comparison has not seen it
    }
    const auto unaware = rejections_of_equal_flights(problem, false, rules_of(problem), 300);
    CHECK(unaware.count(Rejection::flyable_area) == 0);
}

TEST_CASE("edges fly side by side as one by one with rotor lag, a fountain, walls, arm limits and unequal rotors") {
    Problem problem = cluttered_problem();
    problem.robot.rotors.time_constant_s = 0.02;
    problem.robot.rotors.positions_m[0][2] = 0.1;
    limit_arm(problem.robot, -2, 2);
    problem.aero.ground = SurfaceEffect(EffectModel::multirotor_body);
    problem.aero.wall = {0.02, 0.04, 1};
    CHECK(rejections_of_equal_flights(problem, true, rules_of(problem), repetitions(40, 100)).count(Rejection::none) ==
          1);
    // So they do where clearance is measured.
    const Problem plain = cluttered_problem();
    FlightRules rules = rules_of(plain);
    rules.measures_clearance = true;
    CHECK(rejections_of_equal_flights(plain, false, rules, 30).count(Rejection::none) == 1);
}

TEST_CASE("edges fly side by side as one by one with a cascaded PID") {
    Problem problem = cluttered_problem();
    problem.robot.rotors.time_constant_s = 0.012;
    CascadedPid law;
    law.rotor_lead = 1;
    law.pitch_rate_kd = 0.01;
    problem.robot.controller.law = law;
    const auto aware = rejections_of_equal_flights(problem, true, rules_of(problem), repetitions(60, 200));
    CHECK(aware.count(Rejection::none) == 1);
    CHECK(rejections_of_equal_flights(problem, false, rules_of(problem), repetitions(60, 200)).count(Rejection::none) ==
          1);
}

TEST_CASE("edges fly side by side as one by one with an observer and a feed-forward, in a world and in none") {
    for (const double delay_s : {0.0, 0.006}) {
        for (const bool is_cascaded : {false, true}) {
            Problem problem = cluttered_problem();
            problem.robot.rotors.time_constant_s = 0.012;
            problem.robot.controller.delay_s = delay_s;
            problem.aero.ground = EffectModel::multirotor_body;
            if (is_cascaded) {
                problem.robot.controller.law = CascadedPid{};
            }
            give_aids(problem.robot.controller.law,
                      {controllers::DisturbanceObserver{}, controllers::FeedForward{0.02, -0.03}});
            const auto aware = rejections_of_equal_flights(problem, true, rules_of(problem), repetitions(40, 100));
            CHECK(aware.count(Rejection::none) == 1);
        }
    }
}

TEST_CASE(
    "edges in the nominal world fly side by side as one by one with drag, rotor lag, a late controller and aids") {
    // Seen at once, between two ticks, exactly one tick late, and as late as possible.
    for (const double delay_s : {0.0, 0.004, 0.01, 0.017, 0.03}) {
        for (const bool observes : {false, true}) {
            CAPTURE(delay_s, observes);
            Problem problem = cluttered_problem();
            problem.robot.multirotor.drag = {1.0, 0.047};
            problem.robot.arm.drag = {0, 0.0485};
            problem.robot.rotors.time_constant_s = 0.03;
            problem.robot.controller.delay_s = delay_s;
            if (observes) {
                give_aids(problem.robot.controller.law, {controllers::DisturbanceObserver{3}, {}});
            }
            REQUIRE(!make_flight_model(problem)->flies_plainly());
            // With an observer the loop is unstable as late as that.
            const std::size_t some = observes && delay_s > 0.02 ? 0 : 1;
            CHECK(rejections_of_equal_flights(problem, true, rules_of(problem), 60).count(Rejection::none) == some);
            CHECK(rejections_of_equal_flights(problem, false, rules_of(problem), 60).count(Rejection::none) == some);
        }
    }
}

TEST_CASE("edges fly side by side as one by one where the controller sees many ticks late") {
    for (const double delay_s : {0.036, 0.04, 0.1}) {
        CAPTURE(delay_s);
        Problem problem = cluttered_problem();
        problem.robot.controller.delay_s = delay_s;
        for (const bool is_aware : {true, false}) {
            const auto rejections = rejections_of_equal_flights(problem, is_aware, rules_of(problem), 100);
            CHECK((rejections.count(Rejection::none) == 1 || delay_s == 0.1));  // so late the loop is unstable
        }
    }
}

TEST_CASE("few flights and many, and flights that end one after the other, come out the same") {
    const Problem problem = cluttered_problem();
    const auto model = make_flight_model(problem);
    const auto map = model->make_map(problem.bounds);
    std::vector<FlightJob> expected = random_jobs(problem, *model, 40, 9);
    const std::vector<FlightJob> jobs = expected;
    fly_one_by_one(*model, map.get(), rules_of(problem), expected);
    for (const Instructions instructions : known_instructions()) {
        FlightPool pool(*model, map.get(), rules_of(problem), nullptr, 1, instructions);
        for (const std::size_t count : {1U, 2U, 3U, 5U, 8U, 9U, 13U, 16U, 17U, 25U, 40U}) {
            std::vector<FlightJob> flown(jobs.begin(), jobs.begin() + static_cast<std::ptrdiff_t>(count));
            pool.fly(flown);
            for (std::size_t i = 0; i < count; ++i) {
                CAPTURE(i, count, static_cast<int>(instructions));
                for (std::size_t leg = 0; leg < jobs[i].legs.size(); ++leg) {
                    REQUIRE(is_same(flown[i].legs[leg], expected[i].legs[leg]));
                }
            }
        }
    }
}

namespace {

/// Jobs, each from where the one before ended, until one is rejected.
class Relay final : public FlightChain {
 public:
    explicit Relay(std::vector<FlightJob> all) : jobs(std::move(all)) {}

    FlightJob* next() override {
        if (begun == jobs.size() || (begun > 0 && jobs[begun - 1].rejection() != Rejection::none)) {
            return nullptr;
        }
        if (begun > 0) {
            jobs[begun].start = jobs[begun - 1].end();
        }
        return &jobs[begun++];
    }

    std::vector<FlightJob> jobs;
    std::size_t begun = 0;
};

}  // namespace

TEST_CASE("jobs of a chain follow one another, each from what became of the one before") {
    const Problem problem = cluttered_problem();
    const auto model = make_flight_model(problem);
    const FlightRules rules = rules_of(problem);
    // Every leg of a job becomes a job of its own.
    std::vector<FlightJob> whole = random_jobs(problem, *model, 60, 21);
    std::vector<std::vector<FlightJob>> parts;
    for (const FlightJob& job : whole) {
        std::vector<FlightJob>& chain = parts.emplace_back();
        for (const FlightLeg& leg : job.legs) {
            chain.push_back({job.start, {leg}});
        }
    }
    parts.emplace_back();  // a chain that ends before it begins
    fly_one_by_one(*model, nullptr, rules, whole);
    for (const auto& [instructions, threads] : ways_to_fly()) {
        std::deque<Relay> relays(parts.begin(), parts.end());
        std::vector<FlightChain*> chains;
        for (Relay& relay : relays) {
            chains.push_back(&relay);
        }
        FlightPool pool(*model, nullptr, rules, nullptr, threads, instructions);
        pool.fly(chains);
        std::size_t rejected = 0;
        for (std::size_t i = 0; i < whole.size(); ++i) {
            CAPTURE(i, static_cast<int>(instructions), threads);
            std::size_t flown = 0;
            while (flown < whole[i].legs.size() && whole[i].legs[flown].flight.ticks > 0) {
                REQUIRE(is_same(relays[i].jobs[flown].legs[0], whole[i].legs[flown]));
                ++flown;
            }
            CHECK(relays[i].begun == flown);
            rejected += flown < whole[i].legs.size() ? 1 : 0;
        }
        CHECK(rejected > 5);  // or no chain was seen to end early
        CHECK(relays.back().begun == 0);
        std::vector<FlightJob> after = random_jobs(problem, *model, 20, 3);
        std::vector<FlightJob> expected = after;
        fly_one_by_one(*model, nullptr, rules, expected);
        pool.fly(after);  // jobs again
        CHECK(is_same(after.back().legs[0], expected.back().legs[0]));
    }
}

TEST_CASE("edges of unstable vehicles and saturated rotors end side by side as one by one") {
    Problem problem = cluttered_problem();
    problem.robot.rotors.max_thrust_n = 13;
    CHECK(rejections_of_equal_flights(problem, false, rules_of(problem), 60).count(Rejection::saturation) == 1);

    const auto model = make_flight_model(cluttered_problem());
    const PlanarPose tumbling{0, 2, 1.5, 0};
    const ReferencePoint at = at_rest({0, 2, 0});
    std::vector<FlightJob> jobs{{model->state_at(tumbling), {{{at, at, 100, model->tick().tick_s}}}}};
    FlightPool(*model, nullptr, rules_of(problem), nullptr).fly(jobs);
    CHECK(jobs[0].rejection() == Rejection::unstable);
    CHECK(jobs[0].legs[0].flight.ticks == 1);
}

TEST_CASE("a job that has to meet the goal is rejected as soon as it does not") {
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    FlightRules rules = rules_of(problem);
    const ReferencePoint at = at_rest({3, 3.6, -quarter_turn});  // the arm points up to the goal at (3, 4.8)
    FlightJob held{model->state_at(level_at(configuration_of(at))), {{{at, at, 500, model->tick().tick_s}}}, 100};
    FlightJob missed = held;
    missed.legs[0].segment = {at, at, 120, model->tick().tick_s};
    missed.start.plant.q[0] = 3.2;  // twice the tolerance: on its way to the reference, but too late
    FlightJob at_once = missed;
    at_once.legs[0].segment = {at, at, 50, model->tick().tick_s};
    std::vector<FlightJob> jobs{held, missed, at_once};
    rules.max_tracking_error_m = 1;
    FlightPool(*model, nullptr, rules, &problem.goal).fly(jobs);
    CHECK(jobs[0].rejection() == Rejection::none);
    CHECK(jobs[0].legs[0].flight.ticks == 500);
    CHECK(jobs[1].rejection() == Rejection::goal_missed);
    CHECK(jobs[1].legs[0].flight.ticks == 20);
    CHECK(jobs[2].rejection() == Rejection::goal_missed);
    CHECK(jobs[2].legs[0].flight.ticks == 0);  // missed before the first tick
}

TEST_CASE("holds are judged at every tick of their last second, by place, angle and speed") {
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    const FlightRules rules = rules_of(problem);
    const double tick_s = model->tick().tick_s;
    constexpr std::int64_t judged = 100;
    const Goal& goal = problem.goal;
    Random random(5);
    std::vector<FlightJob> jobs, all;
    for (int n = 0; n < 400; ++n) {
        const ReferencePoint at =
            at_rest({3 + random.uniform(-0.08, 0.08), 3.6 + random.uniform(-0.08, 0.08), -quarter_turn});
        const PlanarPose pose{at.position[0] + random.uniform(-0.1, 0.1), at.position[1] + random.uniform(-0.1, 0.1), 0,
                              at.position[2] + random.uniform(-0.1, 0.1)};
        const double u[4] = {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0, random.uniform(-0.2, 0.2)};
        all.push_back({model->state_at(pose, u), {{{at, at, random.integer(80, 500), tick_s}}}, judged});
    }
    int too_fast = 0, elsewhere = 0, met = 0;
    std::vector<std::int64_t> missed_at;
    for (const FlightJob& job : all) {
        const ReferenceSegment& segment = job.legs[0].segment;
        FlightState state = job.start;
        std::int64_t missed = -1;
        bool breaks_rules = false;
        for (std::int64_t tick = 0; tick <= segment.ticks() && missed < 0; ++tick) {
            if (tick > 0) {
                const ReferenceSegment one(segment.from(), segment.from(), 1, tick_s);
                breaks_rules = breaks_rules || fly(*model, nullptr, rules, one, state).rejection != Rejection::none;
            }
            if (tick + judged >= segment.ticks() && !meets_goal(goal, model->tick().plant, state)) {
                missed = tick;
                ++(is_met(goal_error(goal, model->tick().plant, pose_of(state))) ? too_fast : elsewhere);
            }
        }
        if (!breaks_rules) {
            met += missed < 0 ? 1 : 0;
            missed_at.push_back(missed);
            jobs.push_back(job);
        }
    }
    REQUIRE(too_fast > 20);
    REQUIRE(elsewhere > 20);
    REQUIRE(met > 20);
    for (const auto& [instructions, threads] : ways_to_fly()) {
        std::vector<FlightJob> flown = jobs;
        FlightPool(*model, nullptr, rules, &goal, threads, instructions).fly(flown);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            CAPTURE(i, static_cast<int>(instructions), missed_at[i]);
            REQUIRE(flown[i].rejection() == (missed_at[i] < 0 ? Rejection::none : Rejection::goal_missed));
            REQUIRE(flown[i].legs[0].flight.ticks ==
                    (missed_at[i] < 0 ? jobs[i].legs[0].segment.ticks() : missed_at[i]));
        }
    }
}

TEST_CASE("a pool flies one batch after the other, empty ones too, and can be dismissed without any") {
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    FlightPool pool(*model, nullptr, rules_of(problem), nullptr, 3);
    for (const int count : {40, 0, 1, 7, 25}) {
        std::vector<FlightJob> jobs = random_jobs(problem, *model, count, 11);
        std::vector<FlightJob> expected = jobs;
        fly_one_by_one(*model, nullptr, rules_of(problem), expected);
        pool.fly(jobs);
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            CHECK(is_same(jobs[i].legs[0], expected[i].legs[0]));
        }
    }
    const FlightPool idle(*model, nullptr, rules_of(problem), nullptr, 4);
}

TEST_CASE("a batch can be ended from outside") {
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    FlightRules rules = rules_of(problem);
    int questions = 0;
    rules.is_over = [&questions] { return ++questions > 3; };
    const ReferencePoint at = at_rest({0, 2, 0});
    std::vector<FlightJob> jobs(
        5, FlightJob{model->state_at({0, 2, 0, 0}), {{{at, at, 100000000, model->tick().tick_s}}}});
    FlightPool(*model, nullptr, rules, nullptr).fly(jobs);
    for (const FlightJob& job : jobs) {
        CHECK(job.rejection() == Rejection::interrupted);
    }
}

TEST_CASE("flights go on with the threads that there are, with the same bits") {
    if (!can_limit_memory) {
        SUCCEED("not with sanitizers");
        return;
    }
    const Problem problem = ceiling_problem();
    const auto model = make_flight_model(problem);
    const FlightRules rules = rules_of(problem);
    const std::vector<FlightJob> jobs = random_jobs(problem, *model, 100, 3);
    std::vector<FlightJob> expected = jobs;
    fly_one_by_one(*model, nullptr, rules, expected);
    CHECK(succeeds_with_memory_left(100'000'000, [&] {
        std::vector<FlightJob> flown = jobs;
        FlightPool(*model, nullptr, rules, nullptr, 64).fly(flown);
        bool are_same = true;
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            for (std::size_t leg = 0; leg < jobs[i].legs.size(); ++leg) {
                are_same = are_same && is_same(flown[i].legs[leg], expected[i].legs[leg]);
            }
        }
        return are_same;
    }));
}
