#include "downwash/simulation/hover_equilibrium.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "downwash/base/numbers.hpp"
#include "downwash/controllers/reference_point.hpp"
#include "downwash/simulation/execution.hpp"
#include "downwash/simulation/flight_loop.hpp"
#include "downwash/simulation/map_effect.hpp"

namespace downwash {
namespace {

constexpr int all_numbers = simulation::state_numbers;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, all_numbers, all_numbers>;
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, all_numbers, 1>;

/// Energy only grows; nothing depends on it.
constexpr int energy_number =
    static_cast<int>(offsetof(simulation::VehicleState<double>, plant.energy_j) / sizeof(double));

/// Whether so many past motions belong to the state that its Jacobian takes longer than a hover from the start.
bool is_too_late(const FlownWorld& world) {
    return simulation::older_ticks(world.numbers.delay_ticks) > 0;
}

}  // namespace

struct HoverEquilibria::Impl {
    Impl(const FlightModel& the_model, const AeroMap* map, const FlightState& start)
        : model(the_model), reference(at_rest({start.plant.q[0], start.plant.q[1], start.plant.q[3]})) {
        if (map != nullptr) {
            maps = simulation::rotor_maps(model, *map);
        }
        begin(start);
    }

    /// One tick after another without noise and gusts.
    template <class Use>
    void with_tick(const FlownWorld& world, const Use& use) const {
        const auto with = [&](simulation::FlightEffect&& effect) {
            const simulation::FlightLoop loop(model.tick(), &world, effect);
            use([&](const FlightState& state) {
                controllers::Actuation<double> given{};
                return loop.quiet_tick(state, reference, given);
            });
        };
        if (maps) {
            with(simulation::FlightEffectOf{simulation::MapEffect<double>(*maps)});
        } else {
            with(simulation::FlightEffectOf{simulation::NoEffect{}});
        }
    }

    /// The vehicle after a hover in the nominal world, and what follows from its Jacobian there.
    void begin(const FlightState& start) {
        const FlownWorld quiet = without_noise(model.nominal_world());
        if (is_too_late(quiet)) {
            return;
        }
        with_tick(quiet, [&](const auto& tick) {
            FlightState state = start;
            state.world = memory_at_start(quiet, start.plant);
            const auto ticks = std::llround(settling_before_start_s / model.tick().tick_s);
            for (std::int64_t i = 0; i < ticks; ++i) {
                state = tick(state);
                if (!is_stable(state, reference)) {
                    return;
                }
            }
            state.plant.energy_j = 0;
            linearise(tick, state);
            if (!is_known) {
                return;
            }
            is_known = settle(tick, state);
            nominal = state;
        });
    }

    /// Numbers that stay what they are, or only add up what nothing depends on, are left out: those of rotors and
    /// integrators that the vehicle lacks.
    template <class Tick>
    void linearise(const Tick& tick, const FlightState& at) {
        std::vector<int> every;
        for (int i = 0; i < all_numbers; ++i) {
            if (i != energy_number) {
                every.push_back(i);
            }
        }
        used = every;
        const Matrix all = jacobian(tick, at, tick(at));
        used.clear();
        for (std::size_t i = 0; i < every.size(); ++i) {
            const auto k = static_cast<Eigen::Index>(i);
            Vector from = all.row(k).transpose();
            Vector to = all.col(k);
            from[k] = to[k] = 0;
            const bool stays = std::abs(all(k, k) - 1) < 1e-6;
            if (from.isZero(0) && stays) {
                constant.push_back(every[i]);
            } else if (!to.isZero(0) || (!from.isZero(0) && !stays)) {
                used.push_back(every[i]);
            }
        }
        const Matrix own = jacobian(tick, at, tick(at));
        newton = (Matrix::Identity(own.rows(), own.cols()) - own).inverse();
        is_known = newton.allFinite();
    }

    /// How the numbers in use follow from those of the tick before, by differences.
    template <class Tick>
    [[nodiscard]] Matrix jacobian(const Tick& tick, const FlightState& at, const FlightState& next) const {
        constexpr double step = 1e-6;
        const auto size = static_cast<Eigen::Index>(used.size());
        Matrix result(size, size);
        for (Eigen::Index column = 0; column < size; ++column) {
            FlightState changed = at;
            const int i = used[static_cast<std::size_t>(column)];
            set_number_at(changed, i, number_at<double>(at, i) + step);
            const FlightState after = tick(changed);
            result.col(column) = difference(after, next) / step;
        }
        return result;
    }

    [[nodiscard]] Vector difference(const FlightState& a, const FlightState& b) const {
        Vector result(static_cast<Eigen::Index>(used.size()));
        for (std::size_t i = 0; i < used.size(); ++i) {
            result[static_cast<Eigen::Index>(i)] = number_at<double>(a, used[i]) - number_at<double>(b, used[i]);
        }
        return result;
    }

    /// Newton's method with the Jacobian of the nominal world. @return whether it came to a fixed point
    template <class Tick>
    [[nodiscard]] bool settle(const Tick& tick, FlightState& state) const {
        constexpr int most_rounds = 40;
        constexpr double enough = 1e-7;
        for (int round = 0; round < most_rounds; ++round) {
            const Vector change = newton * difference(tick(state), state);
            if (!change.allFinite()) {
                return false;
            }
            for (std::size_t i = 0; i < used.size(); ++i) {
                set_number_at(state, used[i], number_at<double>(state, used[i]) + change[static_cast<Eigen::Index>(i)]);
            }
            if (change.cwiseAbs().maxCoeff() <= enough) {
                const FlightState next = tick(state);
                return std::ranges::all_of(
                    constant, [&](int i) { return number_at<double>(next, i) == number_at<double>(state, i); });
            }
        }
        return false;
    }

    /// Whether disturbances decay: all eigenvalues of the numbers that matter to later ones are inside the unit circle.
    template <class Tick>
    [[nodiscard]] bool is_attractive(const Tick& tick, const FlightState& at) const {
        constexpr double slack = 1e-6;  // of differences
        const Matrix all = jacobian(tick, at, tick(at));
        if (!all.allFinite()) {
            return false;
        }
        std::vector<Eigen::Index> kept;
        for (Eigen::Index i = 0; i < all.cols(); ++i) {
            if (!all.col(i).isZero(0)) {
                kept.push_back(i);
            }
        }
        const Eigen::EigenSolver<Matrix> modes(all(kept, kept), false);
        return modes.info() == Eigen::Success && modes.eigenvalues().cwiseAbs().maxCoeff() < 1 - slack;
    }

    const FlightModel& model;
    ReferencePoint reference;
    std::optional<simulation::RotorMaps> maps;
    bool is_known = false;      ///< whether the nominal world has an equilibrium
    FlightState nominal{};      ///< that equilibrium
    std::vector<int> used;      ///< numbers of a state that change and matter
    std::vector<int> constant;  ///< numbers that stay what they are
    Matrix newton;              ///< (I - J)^-1
};

HoverEquilibria::HoverEquilibria(const FlightModel& model, const AeroMap* map, const FlightState& start)
    : impl_(std::make_unique<const Impl>(model, map, start)) {}

HoverEquilibria::~HoverEquilibria() = default;

std::optional<FlightState> HoverEquilibria::in(const FlownWorld& world) const {
    if (!impl_->is_known || is_too_late(world)) {
        return std::nullopt;
    }
    std::optional<FlightState> found;
    const FlownWorld quiet = without_noise(world);
    impl_->with_tick(quiet, [&](const auto& tick) {
        FlightState state = impl_->nominal;
        if (!impl_->settle(tick, state) || !is_stable(state, impl_->reference) || !impl_->is_attractive(tick, state)) {
            return;
        }
        state.plant.energy_j = 0;
        found = state;
    });
    return found;
}

}  // namespace downwash
