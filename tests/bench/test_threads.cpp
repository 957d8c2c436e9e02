#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "../../bench/threads/schedule.hpp"
#include "../support/random.hpp"
#include "../support/same_bytes.hpp"
#include "../support/test_problem.hpp"
#include "downwash/planner/solve.hpp"

// The simulated schedule of bench/threads, against cases that are easily reckoned; and the record it starts from.

using namespace downwash;
using namespace downwash::bench;
using namespace downwash::test;

namespace {

constexpr TickTime second_a_tick{1, 1, 0};

WorkItem serial(double work_s) {
    WorkItem item;
    item.work_s = work_s;
    return item;
}

WorkItem batch(std::vector<std::int64_t> ticks, const TickTime& tick = second_a_tick) {
    WorkItem item;
    item.kind = WorkItem::Kind::batch;
    item.work_s = one_thread_time_s(ticks, tick);
    item.ticks = std::move(ticks);
    item.tick = tick;
    return item;
}

/// A search that is nothing but this, before its first plan.
SearchWork only(WorkChain chain) {
    return {{{std::move(chain), {}}}};
}

/// A search of one round.
SearchWork round_of(std::vector<WorkChain> execution, std::vector<WorkChain> tree, std::vector<WorkChain> refinement) {
    return {{{{}, {{std::move(execution), std::move(tree), std::move(refinement)}}}}};
}

SchedulePolicy on(int threads) {
    SchedulePolicy policy;
    policy.threads = threads;
    return policy;
}

double wall_s(const SearchWork& work, const SchedulePolicy& policy) {
    return simulate(work, policy).wall_s;
}

WorkPiece piece(WorkPiece::Kind kind, double begin_s, double end_s, int task = 0) {
    WorkPiece made;
    made.kind = kind;
    made.begin_s = begin_s;
    made.end_s = end_s;
    made.task = task;
    return made;
}

WorkPiece batch_piece(double begin_s, double end_s, std::vector<std::int64_t> ticks) {
    WorkPiece made = piece(WorkPiece::Kind::batch, begin_s, end_s);
    made.lane_ticks[ticks.size() - 1] = ticks.front();
    made.job_ticks = std::move(ticks);
    return made;
}

/// Work of a few rounds, drawn at random.
SearchWork random_work(std::uint64_t seed) {
    Random random(seed);
    const auto chain = [&] {
        WorkChain items;
        for (int i = random.integer(1, 4); i > 0; --i) {
            items.push_back(serial(random.uniform(0.1, 5)));
            std::vector<std::int64_t> ticks;
            for (int job = random.integer(1, 40); job > 0; --job) {
                ticks.push_back(random.integer(1, 30));
            }
            items.push_back(batch(std::move(ticks), {0.5, 1, 0.05}));
        }
        return items;
    };
    const auto steps = [&] {
        std::vector<WorkChain> all;
        for (int i = random.integer(0, 5); i > 0; --i) {
            all.push_back(chain());
        }
        return all;
    };
    SearchWork work;
    for (int i = 0; i < 4; ++i) {
        work.stages.push_back({chain(), {{steps(), steps(), steps()}}});
    }
    return work;
}

}  // namespace

TEST_CASE("equal flights are shared out evenly") {
    const SearchWork work = only({batch(std::vector<std::int64_t>(64, 100))});
    CHECK(wall_s(work, on(1)) == Approx(800));
    CHECK(wall_s(work, on(2)) == Approx(400));
    CHECK(wall_s(work, on(8)) == Approx(100));
    CHECK(wall_s(work, on(64)) == Approx(100));  // nothing is shorter than a flight
    // Two flights are not worth a second thread, and fewer lanes may be faster.
    CHECK(wall_s(only({batch({100, 100}, {1, 1, 0.5})}), on(2)) == Approx(200));
    CHECK(wall_s(only({batch({100, 100, 100, 100}, {1, 1, 0.5})}), on(2)) == Approx(200));
    CHECK(wall_s(only({batch({100, 100, 100, 100}, {1, 1, 0.5})}), on(1)) == Approx(300));
}

TEST_CASE("one long flight is waited for, while its thread's other lanes take the next jobs") {
    std::vector<std::int64_t> ticks(16, 10);
    ticks[0] = 1000;
    CHECK(wall_s(only({batch(ticks)}), on(1)) == Approx(1000));
    CHECK(wall_s(only({batch(ticks)}), on(2)) == Approx(1000));
    ticks[0] = 10;
    ticks[15] = 1000;  // begun last
    CHECK(wall_s(only({batch(ticks)}), on(1)) == Approx(1010));
    CHECK(wall_s(only({batch(ticks)}), on(2)) == Approx(1000));
}

TEST_CASE("serial work is done by one thread, and others take their time to wake") {
    SchedulePolicy policy = on(4);
    const SearchWork work = only({serial(50), batch(std::vector<std::int64_t>(32, 100))});
    CHECK(wall_s(work, on(1)) == Approx(450));
    CHECK(wall_s(work, policy) == Approx(150));
    policy.wake_s = 5;
    CHECK(wall_s(work, policy) == Approx(155));
    WorkItem directly = serial(60);
    directly.kind = WorkItem::Kind::parallel;
    directly.items = 3;
    CHECK(wall_s(only({directly}), on(1)) == Approx(60));
    CHECK(wall_s(only({directly}), on(2)) == Approx(40));
    CHECK(wall_s(only({directly}), on(4)) == Approx(20));
}

TEST_CASE("tasks of a round run side by side, as many as there are workers") {
    const SearchWork equal = round_of({{serial(10)}}, {{serial(10)}}, {{serial(10)}});
    CHECK(wall_s(equal, on(1)) == Approx(30));
    CHECK(wall_s(equal, on(2)) == Approx(20));
    CHECK(wall_s(equal, on(3)) == Approx(10));
    SchedulePolicy two_workers = on(3);
    two_workers.max_workers = 2;
    CHECK(wall_s(equal, two_workers) == Approx(20));
    // After the tree's first step the refinement has had less time, and the first worker that is free does the second.
    const SearchWork stepped = round_of({{serial(10)}}, {{serial(5)}, {serial(5)}}, {{serial(10)}});
    CHECK(wall_s(stepped, on(2)) == Approx(15));
    // The round ends with its longest task; the idle time of the other thread is at its end.
    const Schedule uneven = simulate(round_of({}, {{serial(10)}}, {{serial(4)}}), on(2));
    CHECK(uneven.wall_s == Approx(10));
    CHECK(uneven.round_end.serial_s == Approx(6));
    CHECK(uneven.idle_s() == Approx(6));
}

TEST_CASE("threads split between tree and refinement all go to the task that is left") {
    const auto flights = [](std::size_t batches) {
        return std::vector<WorkChain>(batches, {batch(std::vector<std::int64_t>(16, 100))});
    };
    // Side by side one thread each, 200 s a batch; then both for one, 100 s a batch.
    CHECK(wall_s(round_of({}, flights(1), flights(3)), on(2)) == Approx(200 + 2 * 100));
    // With nothing to refine the tree has all from its second batch on.
    CHECK(wall_s(round_of({}, flights(4), {WorkChain{}}), on(2)) == Approx(200 + 3 * 100));
}

TEST_CASE("processors are shared evenly where more threads want to run") {
    // The execution's batch wants both, the tree one: 3 threads at 2/3, and when the tree has had its 20 s, both for
    // it.
    const SearchWork work = round_of({{batch(std::vector<std::int64_t>(16, 100))}}, {{serial(20)}}, {});
    CHECK(wall_s(work, on(2)) == Approx((200 + 20) / 2.0));
}

TEST_CASE("a direct flight goes on beside the certificate") {
    const SearchWork work = round_of({{serial(60), batch(std::vector<std::int64_t>(16, 100)), serial(5)}}, {}, {});
    CHECK(wall_s(work, on(1)) == Approx(60 + 200 + 5));
    // Four threads on three processors for 80 s, which leaves the certificate 40 s.
    CHECK(wall_s(work, on(3)) == Approx(80 + 40 + 5));
    SchedulePolicy before = on(3);
    before.flies_beside = false;
    CHECK(wall_s(work, before) == Approx(60 + 100 + 5));
}

TEST_CASE("many threads fly chunks of a certificate at once") {
    const TickTime by_kernel{1, 2, 0};  // 4 lanes take half as long as 8
    const WorkChain chunk{batch(std::vector<std::int64_t>(64, 10), by_kernel),
                          batch(std::vector<std::int64_t>(64, 100), by_kernel)};
    WorkChain certificate = chunk;
    certificate.insert(certificate.end(), chunk.begin(), chunk.end());
    const SearchWork work = round_of({certificate}, {}, {});
    CHECK(wall_s(work, on(1)) == Approx(2 * 16 * 110));
    CHECK(wall_s(work, on(16)) == Approx(2 * 110));
    CHECK(wall_s(work, on(32)) == Approx(110));
    SchedulePolicy before = on(32);
    before.flies_ahead = false;
    CHECK(wall_s(work, before) == Approx(2 * 110));
}

TEST_CASE("steps in flight overlap, and merged steps fill more lanes") {
    const std::vector<WorkChain> steps(4, {serial(10), batch({100, 100, 100, 100}, {1, 1.5, 0})});
    const SearchWork work = round_of({}, steps, {});
    CHECK(wall_s(work, on(1)) == Approx(440));
    SchedulePolicy in_flight = on(4);
    in_flight.steps_in_flight = 4;
    CHECK(wall_s(work, in_flight) == Approx(110));
    SchedulePolicy merged = on(1);
    merged.steps_merged = 2;
    CHECK(wall_s(work, merged) == Approx(2 * (20 + 150)));
    SchedulePolicy divided = on(4);
    divided.divided_share = 0.5;
    CHECK(wall_s(work, divided) < wall_s(work, on(4)));
}

TEST_CASE("no schedule beats its bounds, and all time of the processors is accounted for") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const SearchWork work = random_work(seed);
        const double alone_s = wall_s(work, on(1));
        CHECK(alone_s == Approx(shares_of(work).all_s()));
        for (const int threads : {1, 2, 3, 8, 32}) {
            for (const int in_flight : {1, 3}) {
                SchedulePolicy policy = on(threads);
                policy.steps_in_flight = in_flight;
                policy.wake_s = 0.01;
                const Schedule schedule = simulate(work, policy);
                INFO("seed " << seed << ", threads " << threads << ", steps in flight " << in_flight);
                CHECK(schedule.work_s + schedule.narrow_s + schedule.idle_s() == Approx(threads * schedule.wall_s));
                CHECK(schedule.wall_s <= alone_s * 1.1 + 10);
                for (const WorkStage& stage : work.stages) {
                    for (const WorkItem& item : stage.before) {
                        const std::int64_t longest =
                            item.ticks.empty() ? 0 : *std::max_element(item.ticks.begin(), item.ticks.end());
                        CHECK(schedule.wall_s >= static_cast<double>(longest) * item.tick.at(1));
                    }
                }
            }
        }
    }
}

TEST_CASE("tick times are found again from batches that follow them") {
    const TickTime truth{2e-6, 3e-6, 0.25e-6};
    Random random(3);
    std::vector<WorkPiece> pieces;
    for (int i = 0; i < 50; ++i) {
        WorkPiece made = piece(WorkPiece::Kind::batch, 0, 0);
        for (std::size_t lanes = 1; lanes <= WorkPiece::max_lanes; ++lanes) {
            made.lane_ticks[lanes - 1] = random.integer(0, 500);
            made.end_s += static_cast<double>(made.lane_ticks[lanes - 1]) * truth.at(static_cast<int>(lanes));
        }
        pieces.push_back(made);
    }
    std::vector<const WorkPiece*> batches;
    for (const WorkPiece& each : pieces) {
        batches.push_back(&each);
    }
    const TickTime found = fitted_tick_time(batches);
    CHECK(found.few_s == Approx(truth.few_s));
    CHECK(found.many_s == Approx(truth.many_s));
    CHECK(found.lane_s == Approx(truth.lane_s));
}

TEST_CASE("a record becomes rounds of steps, and what lies between pieces is serial") {
    using Kind = WorkPiece::Kind;
    const std::vector<WorkPiece> pieces{
        batch_piece(1, 3, {200}),      // before the first plan
        batch_piece(5, 6, {100}),      // of the tree's step
        piece(Kind::step, 4, 7, 1),    //
        batch_piece(7.5, 8.5, {100}),  // of the refinement's
        piece(Kind::step, 7, 9, 2),    //
        piece(Kind::round, 4, 9),      //
        batch_piece(11, 12, {100}),    // at the end
    };
    const SearchWork work = search_work(pieces, 0, 13);
    REQUIRE(work.stages.size() == 2);
    const WorkShares shares = shares_of(work);
    CHECK(shares.outside_serial_s == Approx(1 + 1 + 2 + 1));
    CHECK(shares.outside_flights_s == Approx(2 + 1));
    CHECK(shares.task_serial_s[1] == Approx(2));
    CHECK(shares.task_flights_s[1] == Approx(1));
    CHECK(shares.task_serial_s[2] == Approx(1));
    CHECK(shares.all_s() == Approx(13));
    CHECK(shares.rounds == 1);
    CHECK(shares.steps == 2);
    CHECK(shares.batches == 4);
    CHECK(shares.jobs == 4);
    CHECK(wall_s(work, on(1)) == Approx(13));
    CHECK(wall_s(work, on(2)) == Approx(13 - 2));
}

TEST_CASE("a recorded search plans the same, and its record has every tick that was flown") {
    Problem problem = ceiling_problem();
    problem.planner.max_iterations = 400;
    problem.planner.time_limit_s.reset();
    const Solution unrecorded = solve(problem);
    REQUIRE(unrecorded.status == Status::solved);
    const auto model = make_flight_model(problem);
    for (const int threads : {1, 3}) {
        WorkRecorder recorder;
        SolveOptions options;
        options.threads = threads;
        options.recorder = &recorder;
        const double begin_s = WorkRecorder::now_s();
        const Solution solution = solve(problem, options);
        const double end_s = WorkRecorder::now_s();
        CHECK(same_bytes(*solution.plan, *unrecorded.plan));
        CHECK(same_bytes(*solution.execution, *unrecorded.execution));
        CHECK(solution.planning.edges_simulated == unrecorded.planning.edges_simulated);
        const std::vector<WorkPiece> pieces = recorder.take();
        CHECK(recorder.take().empty());
        std::int64_t ticks = 0, lane_ticks = 0;
        std::size_t rounds = 0, ends = 0;
        for (const WorkPiece& each : pieces) {
            ticks = std::accumulate(each.job_ticks.begin(), each.job_ticks.end(), ticks);
            for (std::size_t i = 0; i < each.lane_ticks.size(); ++i) {
                lane_ticks += each.lane_ticks[i] * static_cast<std::int64_t>(i + 1);
            }
            rounds += each.kind == WorkPiece::Kind::round ? 1 : 0;
            ends += each.kind == WorkPiece::Kind::step && !each.goes_on ? 1 : 0;
        }
        CHECK(ticks == std::llround(solution.planning.simulated_s / model->tick().tick_s));
        CHECK(lane_ticks == ticks);
        CHECK(rounds > 0);
        CHECK(ends == 3 * rounds);
        if (threads == 1) {
            const WorkShares shares = shares_of(search_work(pieces, begin_s, end_s));
            CHECK(shares.rounds == rounds);
            CHECK(shares.all_s() <= end_s - begin_s);
            CHECK(shares.all_s() > 0.95 * (end_s - begin_s));
            CHECK(wall_s(search_work(pieces, begin_s, end_s), on(1)) == Approx(shares.all_s()).epsilon(1e-6));
        }
    }
}
