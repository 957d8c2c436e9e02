#include "downwash/identification/identification.hpp"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "downwash/base/infinity.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/identification/flight_filter.hpp"
#include "downwash/identification/information.hpp"
#include "downwash/identification/sought_numbers.hpp"
#include "downwash/identification/verdicts.hpp"

namespace downwash {
namespace {

using namespace identification;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int max_rounds = 12;   ///< of gains and noise, then of numbers
constexpr int first_passes = 2;  ///< of the noise, in the first round
/// A round that lowers the cost by less is the last: no number then changed by more than 0.1 standard deviations.
constexpr double small_gain = 5e-3;
constexpr double small_change = 0.05;  ///< the same of a variance of the noise, relative

/// Distances in radii at which K of a surface is identified.
const std::vector<double> node_distances{0.5, 0.75, 1, 1.5, 2, 3, 4, 6};

/// The noise before a flight says anything of it. Accelerations stand for numbers that are not found yet.
Noise first_noise(const Uncertainty& uncertainty) {
    const auto variance = [](double sd, double least) { return std::pow(std::max(sd, least), 2); };
    return {
        {variance(uncertainty.position_noise_m.high, 1e-3), 1e-6, 1e-6,
         variance(uncertainty.velocity_noise_m_s.high, 1e-3), variance(uncertainty.gyro_noise_rad_s.high, 1e-3), 1e-4},
        {0.01, 1, 100}};
}

/// How far accelerations may fall from their first values, and by how much at once.
constexpr double least_accelerations = 1e-7, smaller = 0.02;

/// The variance of what is measured for the next pass: it does not fall to nothing where the filter expects too much.
double next_measured(double before, double found) {
    constexpr double least = 1e-12, greatest_step = 3;
    return std::max({found, before / greatest_step, least});
}

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
                constexpr double step = 1e-4;  // of a standard deviation of what was known before
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
        const Uncertainty known = robot.uncertainty.value_or(Uncertainty{});
        FilterSettings filter;
        filter.gust_m_s = settings.air.gust_m_s.high;
        // Gusts of the default lengths pass a vehicle at 1 m/s, as those of worlds do.
        filter.gust_level_s = settings.air.gust_length_x_m;
        filter.gust_up_s = settings.air.gust_length_z_m;
        filter.surface = surface_;
        for (const LoggedFlight& flight : flights) {
            flights_.push_back({&flight, make_flight_filter(robot, flight, filter), {0, 0, 0}});
        }
        noise_.fill(first_noise(known));
    }

    /// Rounds of gains, noise and numbers until the numbers stay.
    void run() {
        for (rounds_ = 1; rounds_ <= max_rounds; ++rounds_) {
            const bool is_settled = find_noise(rounds_ == 1 ? first_passes : 1);
            if (solve() < small_gain && is_settled) {
                is_converged_ = true;
                break;
            }
        }
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
    [[nodiscard]] const PerChannel& noise(bool of_true_motion) const { return noise_[of_true_motion ? 1 : 0].measured; }
    [[nodiscard]] const PerChannel& counts(bool of_true_motion) const { return counts_[of_true_motion ? 1 : 0]; }
    [[nodiscard]] int rounds() const { return std::min(rounds_, max_rounds); }
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

    using AllNoise = std::array<Noise, 2>;  ///< of what vehicles saw, and of true motions

    /// Gains of the present numbers and a noise; then what of it is measured as the innovations show it.
    /// @param[in,out] noise before and after   @return the cost with the noise before
    double pass_all(AllNoise& noise) {
        std::array<FilterPass, 2> sums{};
        double cost = 0;
        for (Flight& flight : flights_) {
            const std::size_t group = flight.log->is_true_motion ? 1 : 0;
            const FilterPass pass =
                flight.filter->pass(sought_.trial(vehicle_.data(), flight.wind.data()), noise[group]);
            cost += pass.is_finite ? pass.cost : infinity;
            for (std::size_t k = 0; k < channel_count; ++k) {
                sums[group].squares[k] += pass.squares[k];
                sums[group].predicted[k] += pass.predicted[k];
                sums[group].counts[k] += pass.counts[k];
            }
        }
        for (std::size_t group = 0; group < 2; ++group) {
            counts_[group] = sums[group].counts;
            for (std::size_t k = 0; k < channel_count; ++k) {
                const double found = (sums[group].squares[k] - sums[group].predicted[k]) / sums[group].counts[k];
                if (std::isfinite(found)) {
                    noise[group].measured[k] = next_measured(noise[group].measured[k], found);
                }
            }
        }
        return std::isfinite(cost) ? cost : infinity;
    }

    /// The noise at the present numbers, and the gains that it gives: accelerations fall while that makes the logs more
    /// likely. @return whether it changed little
    bool find_noise(int passes) {
        const AllNoise before = noise_;
        double cost = infinity;
        for (int i = 0; i < passes; ++i) {
            cost = pass_all(noise_);
        }
        AllNoise less = noise_;
        for (Noise& noise : less) {
            for (double& acceleration : noise.accelerations) {
                acceleration *= smaller;
            }
        }
        if (less[0].accelerations[0] >= least_accelerations * first_noise({}).accelerations[0]) {
            if (pass_all(less) < cost) {
                noise_ = less;
                return false;
            }
            AllNoise kept = noise_;
            cost = pass_all(kept);  // its gains
        }
        if (cost == infinity) {
            throw_input_error(
                "no motion of this robot follows from its commands in the logs; are they logs of this robot, with its "
                "rotors in the same order and its thrusts in newtons?");
        }
        double change = 0;
        for (std::size_t k = 0; k < channel_count; ++k) {
            for (std::size_t group = 0; group < 2; ++group) {
                const double was = before[group].measured[k];
                change = std::max(change, std::abs(noise_[group].measured[k] - was) / was);
            }
        }
        return change < small_change;
    }

    /// The most likely numbers with the present gains. @return by how much the cost fell
    double solve() {
        ceres::Problem problem;  // it owns the costs
        const Index count = sought_.of_vehicle();
        problem.AddResidualBlock(new ceres::NormalPrior(MatrixXd::Identity(count, count), VectorXd::Zero(count)),
                                 nullptr, vehicle_.data());
        for (Flight& flight : flights_) {
            problem.AddResidualBlock(new FlightCost(*flight.filter, sought_), nullptr, vehicle_.data(),
                                     flight.wind.data());
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
        options.max_num_iterations = 3;
        options.function_tolerance = 1e-9;
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
    AllNoise noise_{};
    std::array<PerChannel, 2> counts_{};
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
