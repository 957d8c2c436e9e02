#include <catch2/catch.hpp>
#include <deque>
#include <vector>

#include "../support/flight_fixture.hpp"
#include "downwash/search/flight_tree.hpp"

using namespace downwash;
using planning::FlightNode;

namespace {

struct Fixture : test::FlightFixture {
    using FlightFixture::FlightFixture;

    std::optional<planning::FlightTree::Flown> flown(const FlightNode& from, const Configuration& to) {
        const planning::FlightTree::Edge edge{&from, at_rest(task.space.seen_from(from.configuration, to))};
        return tree.flown({&edge, 1}).front();
    }
    FlightNode* fly(FlightNode& from, const Configuration& to) {
        const auto flight = flown(from, to);
        return flight ? &tree.add(from, *flight) : nullptr;
    }
    /// The node where such a flight ends; the test fails without one.
    FlightNode& reached(FlightNode& from, const Configuration& to) {
        FlightNode* node = fly(from, to);
        REQUIRE(node != nullptr);
        return *node;
    }
    bool rewire(FlightNode& node, FlightNode& parent) {
        const planning::FlightTree::Rewiring rewiring{&node, &parent};
        return tree.rewire({&rewiring, 1}) == 1;
    }
    void verify(const FlightNode& node) const { flights.verify(planning::FlightTree::moments_to(node)); }
    /// The hold at a node, or nullptr.
    FlightNode* hold(FlightNode& node) {
        const std::size_t before = tree.holds().size();
        FlightNode* const nodes[] = {&node};
        tree.add_holds(nodes);
        return tree.holds().size() > before ? tree.holds().back() : nullptr;
    }

    planning::FlightTree tree{planning::start_point(task), flights};
};

/// The vehicle 1.2 m below the goal of the ceiling problem, its arm upright.
constexpr Configuration below_the_goal{3, 3.6, -test::quarter_turn};

bool same_bytes(const FlightState& a, const FlightState& b) {
    return downwash::is_same(a, b);
}

/// Edges from one node after the other to the same place, until one of them gets there.
class AnyWay final : public planning::FlightTree::EdgeChain {
 public:
    AnyWay(std::vector<FlightNode*> nodes, const planning::SearchTask& task, const Configuration& to)
        : nodes_(std::move(nodes)), task_(task), to_(to) {}

    std::optional<planning::FlightTree::Edge> next() override {
        if (found || tries == nodes_.size()) {
            return std::nullopt;
        }
        const FlightNode* const from = nodes_[tries++];
        return planning::FlightTree::Edge{from, at_rest(task_.space.seen_from(from->configuration, to_))};
    }
    void note(std::optional<planning::FlightTree::Flown> flight) override { found = std::move(flight); }

    std::optional<planning::FlightTree::Flown> found;
    std::size_t tries = 0;

 private:
    std::vector<FlightNode*> nodes_;
    const planning::SearchTask& task_;
    Configuration to_;
};

}  // namespace

TEST_CASE("chains of edges come to the same, and to the same counts, whether they wait for one another or not") {
    Fixture side_by_side;
    Fixture in_rounds;
    // An objective that is not the flights' own, although the same, is asked by one thread only.
    const planning::ProblemObjective objective(in_rounds.task);
    in_rounds.flights.pay_by(&objective);
    REQUIRE(side_by_side.flights.can_fly_chains());
    REQUIRE(!in_rounds.flights.can_fly_chains());
    std::size_t least_tries = 100, most_tries = 0;
    for (int batch = 0; batch < 6; ++batch) {
        std::vector<std::deque<AnyWay>> both(2);
        for (Fixture* f : {&side_by_side, &in_rounds}) {
            planning::Random random(static_cast<std::uint64_t>(batch) + 5);
            std::deque<AnyWay>& ways = both[f == &side_by_side ? 0 : 1];
            std::vector<planning::FlightTree::EdgeChain*> chains;
            for (int i = 0; i < 20; ++i) {
                const Configuration to = i % 4 == 0 ? *f->flights.goal().sample(random) : f->task.space.sample(random);
                chains.push_back(&ways.emplace_back(f->tree.nearest(to, 6), f->task, to));
            }
            f->tree.fly(chains);
        }
        for (std::size_t i = 0; i < both[0].size(); ++i) {
            CAPTURE(batch, i);
            const AnyWay& a = both[0][i];
            const AnyWay& b = both[1][i];
            REQUIRE(a.tries == b.tries);
            REQUIRE(a.found.has_value() == b.found.has_value());
            least_tries = std::min(least_tries, a.tries);
            most_tries = std::max(most_tries, a.tries);
            if (a.found) {
                REQUIRE(a.found->cost == b.found->cost);
                REQUIRE(same_bytes(a.found->fleet.front(), b.found->fleet.front()));
                side_by_side.tree.add(side_by_side.tree.root(), *a.found);
                in_rounds.tree.add(in_rounds.tree.root(), *b.found);
            }
        }
        const planning::FlightStatistics& a = side_by_side.flights.statistics();
        const planning::FlightStatistics& b = in_rounds.flights.statistics();
        CHECK(a.edges == b.edges);
        CHECK(a.ticks == b.ticks);
        CHECK(a.states_checked == b.states_checked);
        CHECK(a.rejected == b.rejected);
        REQUIRE(a.obstruction.has_value() == b.obstruction.has_value());
        if (a.obstruction) {
            CHECK(a.obstruction->at == b.obstruction->at);
            CHECK(a.obstruction->cause == b.obstruction->cause);
        }
    }
    CHECK(least_tries == 1);
    CHECK(most_tries > 2);  // or no chain had to go on
}

TEST_CASE("re-flying from the start reproduces every node of a random tree bit for bit, after rewirings too") {
    Fixture f;
    planning::Random random(7);
    int rewired = 0;
    for (int i = 0; i < 120; ++i) {
        const Configuration to = f.task.space.sample(random);
        const auto near = f.tree.nearest(to, 8);
        FlightNode* node = f.fly(*near.front(), to);
        if (node == nullptr) {
            continue;
        }
        for (FlightNode* neighbour : near) {
            if (neighbour != &f.tree.root() && neighbour != node->parent &&
                node->cost + f.tree.estimated_cost(*node, neighbour->configuration) < neighbour->cost) {
                rewired += f.rewire(*neighbour, *node) ? 1 : 0;
            }
        }
    }
    REQUIRE(f.tree.size() > 20);
    REQUIRE(rewired > 0);
    for (const FlightNode* node : f.tree.nodes()) {
        CHECK_NOTHROW(f.verify(*node));
    }
    // A tampered state is noticed.
    FlightNode& tampered = *f.tree.nodes().back();
    tampered.fleet[0].plant.q[0] = std::nextafter(tampered.fleet[0].plant.q[0], 100.0);
    CHECK_THROWS_AS(f.verify(tampered), std::logic_error);
}

TEST_CASE("an edge starts from the whole vehicle state of its parent, not from rest") {
    Fixture f;
    const FlightNode& first = f.reached(f.tree.root(), {-1, 2.5, 0.5});
    FlightNode rested = first;
    rested.fleet[0] = f.model->state_at(level_at(first.configuration));
    const auto from_flight = f.flown(first, {1, 3, 0});
    const auto from_rest = f.flown(rested, {1, 3, 0});
    REQUIRE(from_flight);
    REQUIRE(from_rest);
    CHECK_FALSE(same_bytes(from_flight->fleet[0], from_rest->fleet[0]));
}

TEST_CASE("a rewiring that does not pay leaves the tree untouched") {
    Fixture f;
    FlightNode& direct = f.reached(f.tree.root(), {1, 2, 1});
    FlightNode& detour = f.reached(f.tree.root(), {-4, 4, 1});
    const FlightNode& child = f.reached(direct, {3, 2, 1});
    const FlightState before = direct.fleet[0];
    const FlightState child_before = child.fleet[0];
    CHECK_FALSE(f.rewire(direct, detour));
    CHECK(direct.parent == &f.tree.root());
    CHECK(same_bytes(direct.fleet[0], before));
    CHECK(same_bytes(child.fleet[0], child_before));
}

TEST_CASE("a rewiring that pays flies the whole subtree again") {
    Fixture f;
    FlightNode& detour = f.reached(f.tree.root(), {-4, 4, 1.5});
    FlightNode& node = f.reached(detour, {1, 2.5, 1});
    const FlightNode& child = f.reached(node, {3, 2, 0});
    const double cost = node.cost;
    const double child_cost = child.cost;
    REQUIRE(f.rewire(node, f.tree.root()));
    CHECK(node.parent == &f.tree.root());
    CHECK(detour.children.empty());
    CHECK(node.cost < cost);
    CHECK(child.cost < child_cost);
    CHECK_NOTHROW(f.verify(child));
}

TEST_CASE("a vehicle cannot be sent into an obstacle, and the rejection is counted") {
    Fixture f(test::walled_problem());
    const auto before = f.flights.statistics().rejected.at("collision");
    CHECK(f.fly(f.tree.root(), {3, 2, 1.5}) == nullptr);
    CHECK(f.flights.statistics().rejected.at("collision") == before + 1);
    CHECK(f.tree.size() == 1);
}

TEST_CASE("hovering right under a wide ceiling is found out by flying, hold included") {
    // The surface acts as a negative stiffness that the position loop cannot hold against (docs/model.md 5.3).
    Fixture f;
    const double under_the_ceiling_m = 5 - 0.06 - 0.15;  // rotors 0.15 m below it
    FlightNode* node = f.fly(f.tree.root(), {-3, under_the_ceiling_m, 1.5});
    if (node != nullptr) {
        node->reference = at_rest({-3, under_the_ceiling_m, 1.5});
    }
    CHECK((node == nullptr || f.hold(*node) == nullptr));
    const auto& rejected = f.flights.statistics().rejected;
    CHECK(rejected.at("collision") + rejected.at("flyable_area") + rejected.at("tracking") +
              rejected.at("goal_missed") >
          0);
}

TEST_CASE("the nearest nodes come in the order of distance, an unlimited arm going the shorter way round") {
    Fixture f;
    f.fly(f.tree.root(), {-2, 2, 3.0});
    f.fly(f.tree.root(), {-2, 2, 0.0});
    REQUIRE(f.tree.size() == 3);
    const Configuration query{-2, 2, -3.0};
    const auto nearest = f.tree.nearest(query, 2);
    REQUIRE(nearest.size() == 2);
    CHECK(f.task.space.distance_m(nearest[0]->configuration, query) == Approx(0.6 * (2 * 3.14159265358979 - 6)));
    CHECK(f.task.space.distance_m(nearest[0]->configuration, query) <=
          f.task.space.distance_m(nearest[1]->configuration, query));
}

TEST_CASE("goal samples meet the goal with the arm on either side") {
    Fixture f;
    planning::Random random(3);
    bool left = false;
    bool right = false;
    int found = 0;
    int exact = 0;
    for (int i = 0; i < 200; ++i) {
        if (const auto sample = f.task.space.sample_goal(random)) {
            ++found;
            CHECK(f.task.space.is_near_goal(*sample));
            exact += f.task.space.error(*sample).distance_m < 1e-9 ? 1 : 0;
            CHECK(f.task.space.is_valid(*sample));
            left = left || (*sample)[plane::x] < test::end_effector(f.problem.goal).x_m;
            right = right || (*sample)[plane::x] > test::end_effector(f.problem.goal).x_m;
        }
    }
    CHECK(found > 100);
    CHECK(exact > found / 4);
    CHECK(left);
    CHECK(right);
}

TEST_CASE("a parent that an earlier rewiring has moved is flown from anew, or not at all") {
    Fixture f;
    FlightNode& detour = f.reached(f.tree.root(), {-4, 4, 1.5});
    FlightNode& parent = f.reached(detour, {-1, 2.5, 1});
    FlightNode& node = f.reached(f.reached(detour, {-5, 1, 3}), {1, 2, 1});
    // The second is flown from the parent's old state, and the first moves the parent.
    const planning::FlightTree::Rewiring both[] = {{&parent, &f.tree.root()}, {&node, &parent}};
    CHECK(f.tree.rewire(both) >= 1);
    CHECK(parent.parent == &f.tree.root());
    for (const FlightNode* n : f.tree.nodes()) {
        CHECK_NOTHROW(f.verify(*n));
    }
    CHECK((node.parent == &parent || f.rewire(node, parent)));
    CHECK_NOTHROW(f.verify(node));
}

TEST_CASE("a discarded hold that is rewired has a new chance") {
    Fixture f;
    FlightNode& node = f.reached(f.reached(f.tree.root(), {-4, 4, 1.5}), {1, 2.5, 0});
    FlightNode* hold = f.hold(f.reached(node, below_the_goal));
    REQUIRE(hold != nullptr);
    hold->is_discarded = true;
    const double cost = hold->cost;
    REQUIRE(f.rewire(node, f.tree.root()));
    CHECK_FALSE(hold->is_discarded);
    CHECK(hold->cost < cost);
    CHECK_NOTHROW(f.verify(*hold));
}

TEST_CASE("a rewiring that fails in a descendant leaves every field as it was") {
    Fixture f;
    FlightNode& detour = f.reached(f.tree.root(), {-4, 4, 1.5});
    FlightNode& node = f.reached(detour, {1, 2.5, 0});
    FlightNode& arrival = f.reached(node, below_the_goal);
    FlightNode* hold = f.hold(arrival);
    REQUIRE(hold != nullptr);
    FlightNode& last = f.reached(arrival, {3, 2, 0});
    hold->is_discarded = true;
    last.cost = 0;  // no flight can cost less, so the rewiring ends here when all before it has been flown again
    const FlightNode* const nodes[] = {&detour, &node, &arrival, hold, &last};
    const std::vector<FlightNode> before{detour, node, arrival, *hold, last};
    CHECK_FALSE(f.rewire(node, f.tree.root()));
    for (std::size_t i = 0; i < before.size(); ++i) {
        INFO("node " << i);
        CHECK(same_bytes(nodes[i]->fleet[0], before[i].fleet[0]));
        CHECK(nodes[i]->cost == before[i].cost);
        CHECK(nodes[i]->ticks == before[i].ticks);
        CHECK(nodes[i]->ticks_from_start == before[i].ticks_from_start);
        CHECK(nodes[i]->is_discarded == before[i].is_discarded);
        CHECK(nodes[i]->parent == before[i].parent);
        CHECK(nodes[i]->children == before[i].children);
    }
    CHECK_NOTHROW(f.verify(*hold));
}
