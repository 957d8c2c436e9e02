#include <catch2/catch.hpp>
#include <cmath>

#include "../support/random.hpp"
#include "../support/surroundings.hpp"
#include "downwash/dynamics/contact_step.hpp"
#include "random_plant.hpp"

using namespace downwash;
using namespace downwash::test;
using dynamics::ContactLoad;
using dynamics::ContactStep;
using dynamics::ContactTickRecord;
using dynamics::PlanarContact;
using dynamics::PlanePoint;

namespace {

PlanarContact frame_under(double ceiling_m) {
    PlanarContact contact;
    contact.surface_m = {0, ceiling_m};
    contact.normal = {0, -1};
    contact.point_count = 2;
    contact.point_m[0] = {-0.5, 0.1};
    contact.point_m[1] = {0.5, 0.1};
    return contact;
}

PlanarContact tip_before(double wall_m) {
    PlanarContact contact;
    contact.surface_m = {wall_m, 0};
    contact.normal = {-1, 0};
    contact.is_end_effector = true;
    return contact;
}

ContactLoad load_at(const PlantModel& model, const PlanarContact& contact, const double (&q)[4], const double (&u)[4]) {
    return dynamics::contact_load(model, contact, q, u, dynamics::attitude(model, q[2], q[3]));
}

PlanePoint<double> point_of(const PlantModel& model, const PlanarContact& contact, const double (&q)[4]) {
    const auto a = dynamics::attitude(model, q[2], q[3]);
    if (contact.is_end_effector) {
        return dynamics::end_effector_position(model, a, q[0], q[1]);
    }
    const PlanePoint<double> p = contact.point_m[0];
    return {q[0] + a.cos_pitch * p.x + a.sin_pitch * p.z, q[1] - a.sin_pitch * p.x + a.cos_pitch * p.z};
}

double energy_of(const PlantModel& model, const dynamics::PlantState<double>& state) {
    const auto a = dynamics::attitude(model, state.q[2], state.q[3]);
    const auto e = dynamics::motion_at(model, state.q, state.u).equations;
    return dynamics::kinetic_energy(model, e, state.u) + dynamics::potential_energy(model, a, state.q[1]);
}

}  // namespace

TEST_CASE("the generalised forces of a contact do the work of its force at its point") {
    Random random(3);
    for (int sample = 0; sample < 200; ++sample) {
        const PlantModel model = RandomPlant(random).model;
        PlanarContact contact = sample % 2 == 0 ? frame_under(0) : tip_before(0);
        contact.point_count = std::min(contact.point_count, 1);
        double q[4];
        double u[4];
        for (int i = 0; i < 4; ++i) {
            q[i] = random.uniform(-1, 1);
            u[i] = random.uniform(-1, 1);
        }
        // The surface is moved so that the point is a millimetre inside.
        const PlanePoint<double> at = point_of(model, contact, q);
        contact.surface_m = {at.x + 1e-3 * contact.normal.x, at.z + 1e-3 * contact.normal.z};
        const ContactLoad load = load_at(model, contact, q, u);
        REQUIRE(load.depth_m == Approx(1e-3).epsilon(1e-9));
        // Force at the point: that on the position. Levers by differences.
        for (int i = 0; i < 4; ++i) {
            constexpr double step = 1e-6;
            double ahead[4];
            double behind[4];
            std::copy(q, q + 4, ahead);
            std::copy(q, q + 4, behind);
            ahead[i] += step;
            behind[i] -= step;
            const PlanePoint<double> to = point_of(model, contact, ahead);
            const PlanePoint<double> from = point_of(model, contact, behind);
            const double work = (load.force[0] * (to.x - from.x) + load.force[1] * (to.z - from.z)) / (2 * step);
            CHECK(load.force[i] == Approx(work).epsilon(1e-6).margin(1e-6));
        }
    }
}

TEST_CASE("no contact gives energy: 1000 random impacts on a ceiling and on a wall") {
    Random random(5);
    int impacts = 0;
    double deepest_m = 0;
    while (impacts < 1000) {
        const PlantModel model = RandomPlant(random).model;
        const bool is_frame = random.uniform(0, 1) < 0.5;
        PlanarContact contact = is_frame ? frame_under(0) : tip_before(0);
        dynamics::PlantState<double> state{};
        state.q[2] = random.uniform(-0.2, 0.2);
        state.q[3] = random.uniform(-0.3, 0.3);
        state.u[0] = is_frame ? random.uniform(-0.2, 0.2) : random.uniform(0.05, 0.3);
        state.u[1] = is_frame ? random.uniform(0.2, 0.5) : random.uniform(-0.2, 0.2);
        state.u[2] = random.uniform(-0.3, 0.3);
        double q[4];
        std::copy(std::begin(state.q), std::end(state.q), q);
        const double still[4] = {};
        const double distance_m = -load_at(model, contact, q, still).depth_m;
        contact.surface_m =
            is_frame ? PlanePoint<double>{0, 1e-4 - distance_m} : PlanePoint<double>{1e-4 - distance_m, 0};
        const double before_j = energy_of(model, state);
        double impulse_n_s = 0;
        ContactTickRecord record;
        const ContactStep step{contact, {0, 0}, record};
        const dynamics::PlantCommand<double> command{};
        bool is_apart = false;
        for (int t = 0; t < 30 && !is_apart; ++t) {
            state = step(model, state, dynamics::motion_at(model, state.q, state.u), command, 0.01, FreeAir{});
            impulse_n_s += record.normal_impulse_n_s;
            deepest_m = std::max(deepest_m, record.depth_m);
            double now[4];
            double speed[4];
            std::copy(std::begin(state.q), std::end(state.q), now);
            std::copy(std::begin(state.u), std::end(state.u), speed);
            is_apart = impulse_n_s > 0 && load_at(model, contact, now, speed).depth_m < 0;
        }
        if (!is_apart) {
            continue;  // it never touched, or still does
        }
        ++impacts;
        CHECK(energy_of(model, state) < before_j);
    }
    CHECK(deepest_m < 0.004);
}

TEST_CASE("steps of half the length change the impulse of a touch by less than a percent") {
    Random random(7);
    const PlantModel model = RandomPlant(random).model;
    double worst = 0;
    for (int sample = 0; sample < 100; ++sample) {
        const PlanarContact contact = sample % 2 == 0 ? frame_under(0.11) : tip_before(2);
        double impulse_n_s[2];
        for (int k = 0; k < 2; ++k) {
            Random same(static_cast<std::uint64_t>(100 + sample));
            dynamics::PlantState<double> state{};
            state.q[2] = same.uniform(-0.01, 0.01);
            state.u[0] = sample % 2 == 0 ? 0 : 0.2;
            state.u[1] = sample % 2 == 0 ? 0.3 : 0;
            const double still[4] = {};
            double q[4];
            std::copy(std::begin(state.q), std::end(state.q), q);
            PlanarContact near = contact;
            const double gap_m = -load_at(model, near, q, still).depth_m - 1e-4;
            near.surface_m = {near.surface_m.x + gap_m * near.normal.x, near.surface_m.z + gap_m * near.normal.z};
            ContactTickRecord record;
            const ContactStep step{near, {0, 0}, record, k == 0 ? 1 : 0.5};
            impulse_n_s[k] = 0;
            for (int t = 0; t < 3; ++t) {
                state = step(model, state, dynamics::motion_at(model, state.q, state.u),
                             dynamics::PlantCommand<double>{}, 0.01, FreeAir{});
                impulse_n_s[k] += record.normal_impulse_n_s;
            }
        }
        REQUIRE(impulse_n_s[0] > 0);
        worst = std::max(worst, std::abs(impulse_n_s[1] / impulse_n_s[0] - 1));
    }
    CAPTURE(worst);
    CHECK(worst < 0.01);
}
