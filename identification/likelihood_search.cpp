#include "downwash/identification/identification.hpp"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/identification/flight_filter.hpp"
#include "downwash/identification/information.hpp"
#include "downwash/identification/noise_search.hpp"
#include "downwash/identification/sought_numbers.hpp"
#include "downwash/identification/verdicts.hpp"

namespace downwash {
namespace {

using namespace identification;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int max_rounds = 12;  ///< of gains and noise, then of numbers
constexpr int max_steps = 4;    ///< of the numbers, in a round
/// A round that lowers the cost by less is the last: no number then changed by more than 0.1 standard deviations.
constexpr double small_gain = 5e-3;
/// The same of the noise, of -2 log likelihood: half of what chance changes it by.
constexpr double small_fall = 0.5;

/// Distances in radii at which K of a surface is identified.
const std::vector<double> node_distances{0.5, 0.75, 1, 1.5, 2, 3, 4, 6};

/// The innovations of a flight as Ceres asks for them; slopes are differences.
class FlightCost : public ceres::CostFunction {
 public:
    FlightCost(const FlightFilter& filter, const SoughtNumbers& sought) : filter_(filter), sought_(sought) {
        set_num_residuals(static_cast<int>(filter.size()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(sought.of_vehicle()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(SoughtNumbers::of_wind()));
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const Index count = filter_.size();
        VectorXd here(count);
        if (!filter_.innovations(sought_.trial(parameters[0], parameters[1]), here)) {
            return false;
        }
        Eigen::Map<VectorXd>(residuals, count) = here;
        for (const int block : {0, 1}) {
            if (jacobians == nullptr || jacobians[block] == nullptr) {
                continue;
            }
            using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
            const Index columns = parameter_block_sizes()[static_cast<std::size_t>(block)];
            Eigen::Map<RowMajor> jacobian(jacobians[block], count, columns);
            std::array<std::vector<double>, 2> at{
                std::vector<double>(parameters[0], parameters[0] + sought_.of_vehicle()),
                std::vector<double>(parameters[1], parameters[1] + SoughtNumbers::of_wind())};
            for (Index i = 0; i < columns; ++i) {
                constexpr double step = 1e-5;  // of a standard deviation of what was known before
                double& moved = at[static_cast<std::size_t>(block)][static_cast<std::size_t>(i)];
                const double from = std::exchange(moved, moved + step);
                VectorXd there(count);
                if (!filter_.innovations(sought_.trial(at[0].data(), at[1].data()), there)) {
                    return false;
                }
                jacobian.col(i) = (there - here) / step;
                moved = from;
            }
        }
        return true;
    }

 private:
    const FlightFilter& filter_;
    const SoughtNumbers& sought_;
};

/// The search for the most likely numbers.
class Search {
 public:
    Search(const SpaceRobot& robot, const std::vector<LoggedFlight>& flights, const IdentifySettings& settings)
        : surface_(nodes_of(settings)), sought_(robot, settings, surface_), vehicle_(vehicle_size(), 0.0) {
        FilterSettings filter;
        filter.gusts = {settings.air.gust_m_s.high, settings.air.gust_length_x_m, settings.air.gust_length_z_m};
        filter.surface = surface_;
        for (const LoggedFlight& flight : flights) {
            flights_.push_back({&flight, make_flight_filter(robot, flight, filter), {0, 0, 0}});
        }
        for (const bool of_true_motion : {false, true}) {
            std::vector<const LoggedFlight*> group;
            for (const LoggedFlight& flight : flights) {
                if (flight.is_true_motion == of_true_motion) {
                    group.push_back(&flight);
                }
            }
            noise_[of_true_motion ? 1 : 0] = {first_noise(group, robot.joints()), robot.joints() > 0};
        }
    }

    /// Rounds of gains, noise and numbers until the numbers stay.
    void run() {
        for (rounds_ = 1; rounds_ <= max_rounds && !is_converged_; ++rounds_) {
            linearise();
            const double fall = lower_noise();
            is_converged_ = solve() < small_gain && fall < small_fall;
        }
        --rounds_;
        lower_noise();  // of the last numbers, with its gains
    }

    [[nodiscard]] Information information() const {
        std::vector<FlightInnovations> all;
        for (const Flight& flight : flights_) {
            all.push_back(innovations_of(flight));
        }
        return information_of(all, sought_.of_vehicle());
    }

    /// Mean square of the innovations, over what the filter expects.
    [[nodiscard]] double fit() const {
        double sum = 0, count = 0;
        for (const Flight& flight : flights_) {
            VectorXd values(flight.filter->size());
            if (!flight.filter->innovations(sought_.trial(vehicle_.data(), flight.wind.data()), values)) {
                return infinity;
            }
            sum += values.squaredNorm();
            count += static_cast<double>(values.size());
        }
        return sum / count;
    }

    [[nodiscard]] const SoughtNumbers& sought() const { return sought_; }
    [[nodiscard]] const std::vector<double>& vehicle() const { return vehicle_; }
    [[nodiscard]] const SurfaceNodes& surface() const { return surface_; }
    [[nodiscard]] const std::array<double, 3>& wind(std::size_t flight) const { return flights_[flight].wind; }
    [[nodiscard]] const PerChannel& noise(bool of_true_motion) const {
        return noise_[of_true_motion ? 1 : 0].noise().measured;
    }
    [[nodiscard]] const PerChannel& counts(bool of_true_motion) const {
        return noise_[of_true_motion ? 1 : 0].counts();
    }
    [[nodiscard]] int rounds() const { return rounds_; }
    [[nodiscard]] bool is_converged() const { return is_converged_; }

 private:
    struct Flight {
        const LoggedFlight* log;
        std::unique_ptr<FlightFilter> filter;
        std::array<double, 3> wind;
    };

    static SurfaceNodes nodes_of(const IdentifySettings& settings) {
        SurfaceNodes nodes{settings.ground_m, settings.ceiling_m, {}};
        if (settings.ground_m || settings.ceiling_m) {
            nodes.z_over_r = node_distances;
        }
        return nodes;
    }
    [[nodiscard]] std::size_t vehicle_size() const { return static_cast<std::size_t>(sought_.of_vehicle()); }

    /// Applies a function of filter and trial to all flights of what vehicles saw (0), or of true motions (1).
    template <class Run>
    void for_flights(std::size_t group, const Run& run) {
        for (Flight& flight : flights_) {
            if ((flight.log->is_true_motion ? 1U : 0U) == group) {
                run(*flight.filter, sought_.trial(vehicle_.data(), flight.wind.data()));
            }
        }
    }

    /// Linearises the motions at the present numbers.
    void linearise() {
        for (const std::size_t group : {0U, 1U}) {
            for_flights(group, [&](FlightFilter& filter, const Trial& trial) {
                filter.linearise(trial, noise_[group].noise());
            });
        }
    }

    /// Finds the noise at the present numbers, and the gains that it gives. @return by how much -2 log likelihood fell
    double lower_noise() {
        double fall = 0;
        for (const std::size_t group : {0U, 1U}) {
            const auto pass = [&](const Noise& noise) {
                FilterPass sums;
                sums.is_finite = true;
                for_flights(group,
                            [&](FlightFilter& filter, const Trial& trial) { sums += filter.pass(trial, noise); });
                return sums;
            };
            const std::optional<double> by = noise_[group].lower(pass);
            if (!by) {
                throw_input_error(
                    "no motion of this robot follows from its commands in the logs; are they logs of this robot, with "
                    "its rotors in the same order and its thrusts in newtons?");
            }
            fall += *by;
        }
        return fall;
    }

    /// The most likely numbers with the present gains. @return by how much the cost fell
    double solve() {
        ceres::Problem problem;  // it owns the costs
        const Index count = sought_.of_vehicle();
        double residuals = 0;
        problem.AddResidualBlock(new ceres::NormalPrior(MatrixXd::Identity(count, count), VectorXd::Zero(count)),
                                 nullptr, vehicle_.data());
        for (Flight& flight : flights_) {
            problem.AddResidualBlock(new FlightCost(*flight.filter, sought_), nullptr, vehicle_.data(),
                                     flight.wind.data());
            residuals += static_cast<double>(flight.filter->size());
            problem.AddResidualBlock(new ceres::NormalPrior(MatrixXd::Identity(3, 3), VectorXd::Zero(3)), nullptr,
                                     flight.wind.data());
        }
        for (Index i = 0; i < count; ++i) {
            problem.SetParameterLowerBound(vehicle_.data(), static_cast<int>(i), sought_.least(i));
        }
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.logging_type = ceres::SILENT;
        options.num_threads = 1;
        options.max_num_iterations = max_steps;
        options.function_tolerance = small_gain / std::max(1.0, residuals);
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        return summary.initial_cost - summary.final_cost;
    }

    [[nodiscard]] FlightInnovations innovations_of(const Flight& flight) const {
        const FlightCost cost(*flight.filter, sought_);
        const Index rows = flight.filter->size();
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        RowMajor by_vehicle(rows, sought_.of_vehicle()), by_wind(rows, SoughtNumbers::of_wind());
        FlightInnovations own;
        own.value.resize(rows);
        const std::array<const double*, 2> at{vehicle_.data(), flight.wind.data()};
        std::array<double*, 2> slopes{by_vehicle.data(), by_wind.data()};
        static_cast<void>(cost.Evaluate(at.data(), own.value.data(), slopes.data()));
        own.slope.resize(rows, by_vehicle.cols() + by_wind.cols());
        own.slope << by_vehicle, by_wind;
        own.per_tick = flight.filter->per_tick();
        const auto& ticks = flight.log->ticks;
        own.tick_s = (ticks.back().t_s - ticks.front().t_s) / static_cast<double>(ticks.size() - 1);
        return own;
    }

    SurfaceNodes surface_;
    SoughtNumbers sought_;
    std::vector<double> vehicle_;
    std::vector<Flight> flights_;
    std::array<NoiseSearch, 2> noise_;  ///< of what vehicles saw, and of true motions
    int rounds_ = 0;
    bool is_converged_ = false;
};

void require_usable(const LoggedFlight& flight) {
    constexpr double least_s = 2;
    if (flight.ticks.size() < 2 || flight.ticks.back().t_s - flight.ticks.front().t_s < least_s) {
        throw_input_error(flight.name + ": is shorter than 2 s: expected a flight with several motions");
    }
}

/// The beginning of a flight.
LoggedFlight beginning(LoggedFlight flight, double length_s) {
    const double end_s = flight.ticks.front().t_s + length_s;
    std::erase_if(flight.ticks, [&](const LoggedTick& tick) { return tick.t_s > end_s; });
    return flight;
}

}  // namespace

Identification identify(const SpaceRobot& robot, const std::vector<LoggedFlight>& flights,
                        const IdentifySettings& settings) {
    simulation::require_built_joints(robot);
    std::vector<LoggedFlight> used;
    for (const LoggedFlight& flight : flights) {
        require_usable(flight);
        used.push_back(beginning(flight, settings.max_length_s));
    }
    Search search(robot, used, settings);
    search.run();
    Identification found;
    found.iterations = search.rounds();
    found.is_converged = search.is_converged();
    found.fit = search.fit();
    for (const LoggedFlight& flight : used) {
        found.duration_s += flight.ticks.back().t_s - flight.ticks.front().t_s;
    }
    const Information information = search.information();
    add_numbers(search.sought(), search.vehicle(), information, settings, found);
    add_ratios(search.sought(), search.surface(), search.vehicle(), information, found);
    for (std::size_t i = 0; i < used.size(); ++i) {
        add_wind(search.sought(), used[i].name, search.wind(i), i, information, settings, found);
    }
    const bool sees = std::ranges::any_of(used, [](const LoggedFlight& flight) { return !flight.is_true_motion; });
    if (sees) {
        add_noise(search.noise(false), search.counts(false), found);
    }
    add_left_out(robot, sees, found);
    return found;
}

}  // namespace downwash
