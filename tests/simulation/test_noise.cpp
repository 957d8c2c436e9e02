#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstring>
#include <numbers>

#include "downwash/simulation/noise.hpp"
#include "downwash/simulation/world_tick.hpp"
#include "hover_scenes.hpp"

// The random numbers of worlds, and the gusts made of them.

using namespace downwash;
using namespace downwash::test;

TEST_CASE("Noise is standard normal, white, and the same for a tape and a tick") {
    constexpr int ticks = 40000;
    double sum[simulation::noise_count] = {}, squares[simulation::noise_count] = {}, fourth = 0;
    double with_next = 0, across = 0, between_tapes = 0;
    double before[simulation::noise_count] = {};
    for (int tick = 0; tick < ticks; ++tick) {
        double noise[simulation::noise_count], other[simulation::noise_count];
        simulation::draw_noise(simulation::normal_levels(), 77, tick, noise, 1);
        simulation::draw_noise(simulation::normal_levels(), 78, tick, other, 1);
        for (int i = 0; i < simulation::noise_count; ++i) {
            sum[i] += noise[i];
            squares[i] += noise[i] * noise[i];
            fourth += std::pow(noise[i], 4) / simulation::noise_count;
            with_next += noise[i] * before[i] / simulation::noise_count;
            between_tapes += noise[i] * other[i] / simulation::noise_count;
            before[i] = noise[i];
        }
        across += noise[0] * noise[1] + noise[3] * noise[4] + noise[6] * noise[7];
    }
    const double slack = 4 / std::sqrt(ticks);  // four standard deviations of a mean
    for (int i = 0; i < simulation::noise_count; ++i) {
        CHECK(std::abs(sum[i] / ticks) < slack);
        CHECK(std::abs(squares[i] / ticks - 1) < std::sqrt(2.0) * slack);
    }
    CHECK(fourth / ticks == Approx(3).margin(0.1));
    CHECK(std::abs(with_next / ticks) < slack);
    CHECK(std::abs(between_tapes / ticks) < slack);
    CHECK(std::abs(across / ticks) < 2 * slack);
    double again[simulation::noise_count];
    simulation::draw_noise(simulation::normal_levels(), 77, ticks - 1, again, 1);
    CHECK(std::memcmp(again, before, sizeof again) == 0);
}

TEST_CASE("Gusts have the variance and the spectrum of the Dryden model") {
    World world;
    world.gust_m_s = 0.4;
    world.gust_length_x_m = 2;
    world.gust_length_z_m = 1;
    world.wind_x_m_s = 2.5;
    const FlownWorld flown = make_world(test_robot(), world);
    constexpr double tick_s = 0.01, speed_m_s = 2.5;
    constexpr int length = 4096;
    constexpr int pieces = 150;
    // Angular frequencies around the corners at V / L = 1.25 and 2.5 rad/s.
    const int bins[] = {3, 6, 12, 24, 48, 96};
    double power[2][6] = {};
    double variance[2] = {};
    for (int piece = 0; piece < pieces; ++piece) {
        FlownWorld own = flown;
        own.world.tape = static_cast<std::uint64_t>(piece);
        auto memory = memory_at_start(own, {});
        std::complex<double> sums[2][6];
        for (int tick = 0; tick < length; ++tick) {
            const auto wind = simulation::wind_in(own.numbers, memory);
            const double gust[2] = {wind.x - 2.5, wind.z};
            for (int axis = 0; axis < 2; ++axis) {
                variance[axis] += gust[axis] * gust[axis] / length / pieces;
                for (int k = 0; k < 6; ++k) {
                    sums[axis][k] += std::polar(gust[axis], -2 * std::numbers::pi * bins[k] * tick / length);
                }
            }
            double noise[simulation::noise_count];
            simulation::draw_noise(simulation::normal_levels(), own.world.tape, tick, noise, 1);
            simulation::FlightMemory next;
            simulation::pass_tick(own.numbers, {}, memory, noise, next);
            memory = next;
        }
        for (int axis = 0; axis < 2; ++axis) {
            for (int k = 0; k < 6; ++k) {
                power[axis][k] += std::norm(sums[axis][k]) * tick_s / length / pieces;  // two-sided, per Hz
            }
        }
    }
    CHECK(variance[0] == Approx(0.16).epsilon(0.06));
    CHECK(variance[1] == Approx(0.16).epsilon(0.06));
    for (int k = 0; k < 6; ++k) {
        const double omega = 2 * std::numbers::pi * bins[k] / (length * tick_s);
        // MIL-F-8785C 3.7.2.1 as one-sided spectra over the spatial frequency; per Hz of two-sided ones: times pi / V.
        const double along = omega / speed_m_s * 2;
        const double upward = omega / speed_m_s * 1;
        const double x = 0.16 * 2 * 2 / std::numbers::pi / (1 + along * along);
        const double z = 0.16 * 1 / std::numbers::pi * (1 + 3 * upward * upward) / std::pow(1 + upward * upward, 2);
        INFO("at " << omega << " rad/s");
        CHECK(power[0][k] == Approx(x * std::numbers::pi / speed_m_s).epsilon(0.35));
        CHECK(power[1][k] == Approx(z * std::numbers::pi / speed_m_s).epsilon(0.35));
    }
}
