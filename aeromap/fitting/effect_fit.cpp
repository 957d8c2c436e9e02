#include "downwash/fitting/effect_fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"

namespace downwash {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A free parameter: its place in the model and the range it is sought in.
struct Free {
    std::size_t index;
    double low, high;
};

/// What is minimised: residuals of the points over the free parameters.
class Residuals {
 public:
    Residuals(SurfaceEffect start, std::vector<Free> free, const std::vector<Measurement>& points,
              const FitOptions& options)
        : effect_(std::move(start)), free_(std::move(free)), points_(points), options_(options) {}

    [[nodiscard]] const std::vector<Free>& free() const { return free_; }
    [[nodiscard]] std::size_t count() const { return points_.size(); }

    [[nodiscard]] SurfaceEffect effect(const double* values) const {
        SurfaceEffect effect = effect_;
        for (std::size_t i = 0; i < free_.size(); ++i) {
            effect.parameters[free_[i].index] = values[i];
        }
        return effect;
    }

    /// K minus thrust ratio at a point, in sigmas if weighted; infinite within a pole.
    [[nodiscard]] double at(const SurfaceEffect& effect, std::size_t i) const {
        const Measurement& point = points_[i];
        const double error = formula_factor(effect, point.z_over_r, options_.neighbours) - point.thrust_ratio;
        return options_.is_weighted ? error / *point.sigma : error;
    }

    [[nodiscard]] double sum_of_squares(const double* values) const {
        const SurfaceEffect here = effect(values);
        double sum = 0;
        for (std::size_t i = 0; i < count(); ++i) {
            const double error = at(here, i);
            sum += error * error;
        }
        return sum;
    }

    /// Derivatives by one free parameter, by differences that stay within its range.
    [[nodiscard]] Eigen::VectorXd slopes(const double* values, std::size_t parameter) const {
        constexpr double step = 6e-6;  // the cube root of the rounding error
        std::vector<double> low(values, values + free_.size());
        std::vector<double> high = low;
        const double h = step * std::max(std::abs(values[parameter]), 1e-3);
        low[parameter] = std::max(low[parameter] - h, free_[parameter].low);
        high[parameter] = std::min(high[parameter] + h, free_[parameter].high);
        const SurfaceEffect below = effect(low.data());
        const SurfaceEffect above = effect(high.data());
        Eigen::VectorXd result(static_cast<Eigen::Index>(count()));
        for (std::size_t i = 0; i < count(); ++i) {
            result[static_cast<Eigen::Index>(i)] = (at(above, i) - at(below, i)) / (high[parameter] - low[parameter]);
        }
        return result;
    }

 private:
    SurfaceEffect effect_;
    std::vector<Free> free_;
    const std::vector<Measurement>& points_;
    const FitOptions& options_;
};

/// The residuals as Ceres asks for them. Within a pole there are none, and the step is not taken.
class Cost : public ceres::CostFunction {
 public:
    explicit Cost(const Residuals& residuals) : of_(residuals) {
        set_num_residuals(static_cast<int>(of_.count()));
        mutable_parameter_block_sizes()->push_back(static_cast<int>(of_.free().size()));
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const SurfaceEffect effect = of_.effect(parameters[0]);
        for (std::size_t i = 0; i < of_.count(); ++i) {
            residuals[i] = of_.at(effect, i);
            if (!std::isfinite(residuals[i])) {
                return false;
            }
        }
        if (jacobians == nullptr || jacobians[0] == nullptr) {
            return true;
        }
        const auto rows = static_cast<Eigen::Index>(of_.count());
        const auto columns = static_cast<Eigen::Index>(of_.free().size());
        using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        Eigen::Map<RowMajor> jacobian(jacobians[0], rows, columns);
        for (Eigen::Index j = 0; j < columns; ++j) {
            const auto column = of_.slopes(parameters[0], static_cast<std::size_t>(j));
            if (!column.allFinite()) {
                return false;
            }
            jacobian.col(j) = column;
        }
        return true;
    }

 private:
    const Residuals& of_;
};

struct Minimum {
    std::vector<double> values;
    double sum_of_squares = infinity;
    bool is_converged = false;
};

Minimum minimised(const Residuals& residuals, std::vector<double> start) {
    ceres::Problem problem;
    problem.AddResidualBlock(new Cost(residuals), nullptr, start.data());  // the problem owns the cost
    for (std::size_t i = 0; i < start.size(); ++i) {
        problem.SetParameterLowerBound(start.data(), static_cast<int>(i), residuals.free()[i].low);
        problem.SetParameterUpperBound(start.data(), static_cast<int>(i), residuals.free()[i].high);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    options.max_num_iterations = 500;
    options.max_num_consecutive_invalid_steps = 50;
    options.function_tolerance = 1e-15;
    options.gradient_tolerance = 1e-15;
    options.parameter_tolerance = 1e-12;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    return {start, residuals.sum_of_squares(start.data()), summary.termination_type == ceres::CONVERGENCE};
}

/// The i-th of numbers that fill (0, 1) evenly (van der Corput).
double spread(std::size_t i, std::size_t base) {
    double result = 0, digit = 1;
    for (; i > 0; i /= base) {
        digit /= static_cast<double>(base);
        result += digit * static_cast<double>(i % base);
    }
    return result;
}

/// Starting points within the ranges, best first, of the source's values and points of a Halton sequence, spread evenly
/// over the decades from a thousandth to a thousand.
std::vector<std::vector<double>> starts(const Residuals& residuals, const std::vector<double>& source_values) {
    constexpr std::size_t tried = 400;
    constexpr std::array<std::size_t, max_model_parameters> bases{2, 3};
    std::vector<std::pair<double, std::vector<double>>> found;
    const auto consider = [&](const std::vector<double>& values) {
        const double sum = residuals.sum_of_squares(values.data());
        if (std::isfinite(sum)) {
            found.emplace_back(sum, values);
        }
    };
    consider(source_values);
    for (std::size_t i = 1; i <= tried; ++i) {
        std::vector<double> values;
        for (std::size_t j = 0; j < residuals.free().size(); ++j) {
            const Free& range = residuals.free()[j];
            const double decade = -3 + 6 * spread(i, bases[j]);
            values.push_back(std::clamp(std::pow(10.0, decade), range.low, range.high));
        }
        consider(values);
    }
    std::sort(found.begin(), found.end());
    constexpr std::size_t kept = 6;
    std::vector<std::vector<double>> best;
    for (std::size_t i = 0; i < std::min(kept, found.size()); ++i) {
        best.push_back(found[i].second);
    }
    return best;
}

/// The lowest minimum found from several starts.
Minimum search(const Residuals& residuals, const std::vector<double>& source_values) {
    Minimum best;
    for (const std::vector<double>& start : starts(residuals, source_values)) {
        Minimum found = minimised(residuals, start);
        if (found.sum_of_squares < best.sum_of_squares) {
            best = std::move(found);
        }
    }
    return best;
}

/// The model as its source gives it, with what the user fixed.
SurfaceEffect starting_effect(EffectModel model, const FitOptions& options) {
    const EffectModelInfo& known = info(model);
    SurfaceEffect effect(model);
    for (const auto& [name, value] : options.fixed) {
        const auto parameter = std::find_if(known.parameters.begin(), known.parameters.end(),
                                            [&name = name](const ModelParameter& p) { return p.name == name; });
        if (parameter == known.parameters.end()) {
            throw_input_error("the model " + std::string(known.name) + " has no parameter '" + excerpt(name) +
                              "' to be fixed");
        }
        if (!parameter->allows(value)) {
            throw_input_error("the parameter " + name + " cannot be fixed at " + to_text(value) +
                              "; expected a number " + parameter->range_text());
        }
        effect.parameters[static_cast<std::size_t>(parameter - known.parameters.begin())] = value;
    }
    return effect;
}

std::vector<Free> free_parameters(EffectModel model, const FitOptions& options) {
    constexpr double min_above_open = 1e-6;
    std::vector<Free> free;
    const auto& known = info(model).parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const bool is_fixed = std::any_of(options.fixed.begin(), options.fixed.end(),
                                          [&](const auto& fixed) { return fixed.first == known[i].name; });
        // The body's b of zero is no distance: it stands for that of the rotors.
        const bool is_open = known[i].is_open || (model == EffectModel::multirotor_body && i == 1);
        if (!is_fixed) {
            free.push_back({i, known[i].low + (is_open ? min_above_open : 0), known[i].high});
        }
    }
    return free;
}

void check_points(const std::vector<Measurement>& points, std::size_t free_count, const FitOptions& options) {
    if (points.empty()) {
        throw_input_error("nothing to fit; expected at least one measurement", options.source);
    }
    std::set<double> distances;
    for (const Measurement& point : points) {
        distances.insert(point.z_over_r);
        if (options.is_weighted && !point.sigma) {
            throw_input_error("no sigma; expected one for every measurement of a weighted fit",
                              options.source + ":" + std::to_string(point.line));
        }
    }
    if (distances.size() < free_count) {
        throw_input_error("only " + std::to_string(distances.size()) + " different z_over_r; expected at least " +
                              std::to_string(free_count) + ", one for each parameter of the model",
                          options.source);
    }
}

/// Names parameters of which hardly more than a combination is known: one of a pair that goes together is not told from
/// zero by the data.
void find_combinations(EffectFit& fit) {
    constexpr double max_correlation = 0.999;
    const auto is_vague = [&fit](std::size_t i) {
        return *fit.parameters[i].standard_error > std::abs(fit.parameters[i].value);
    };
    std::set<std::size_t> vague;
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const auto correlation = fit.correlation(i, j);
            if (correlation && std::abs(*correlation) > max_correlation && (is_vague(i) || is_vague(j))) {
                vague.insert({i, j});
            }
        }
    }
    for (const std::size_t i : vague) {
        fit.undetermined.push_back(fit.parameters[i].name);
    }
}

/// Fills in standard errors, covariance and what is undetermined, from the slopes at the minimum.
void judge(EffectFit& fit, const Residuals& residuals, const Minimum& minimum, const FitOptions& options) {
    // With columns of length one the normal matrix tells how far the parameters can be told apart.
    constexpr double min_change =
        1e-6;  // of K, which no one measures, when a parameter changes by one or by its own size
    const auto free_count = static_cast<Eigen::Index>(residuals.free().size());
    Eigen::MatrixXd scaled(static_cast<Eigen::Index>(residuals.count()), free_count);
    Eigen::VectorXd scale(free_count);
    std::vector<std::size_t> inner;  // free parameters that no bound holds
    for (std::size_t i = 0; i < residuals.free().size(); ++i) {
        const Free& free = residuals.free()[i];
        FittedParameter& parameter = fit.parameters[free.index];
        const double value = minimum.values[i];
        const double size = std::max(1.0, std::abs(value));
        Eigen::VectorXd slopes = residuals.slopes(minimum.values.data(), i);
        if (!slopes.allFinite()) {  // a pole is nearer than the step: the data say nothing of this parameter
            slopes.setZero();
        }
        const double length = slopes.norm();
        const bool is_felt = length * size > min_change;
        // What the data do not feel may be anywhere: no bound holds it.
        const double margin = 1e-9 * size;
        parameter.is_at_bound = is_felt && (value <= free.low + margin || value >= free.high - margin);
        if (!parameter.is_at_bound) {
            const auto j = static_cast<Eigen::Index>(inner.size());
            scale[j] = is_felt ? 1 / length : 0;
            scaled.col(j) = slopes * scale[j];
            inner.push_back(i);
        }
    }
    const auto p = static_cast<Eigen::Index>(inner.size());
    const double degrees = static_cast<double>(residuals.count()) - static_cast<double>(inner.size());
    if (options.is_weighted && degrees > 0) {
        fit.reduced_chi_squared = minimum.sum_of_squares / degrees;
    }
    if (p == 0) {
        return;
    }
    const auto columns = scaled.leftCols(p);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> normal(columns.transpose() * columns);
    constexpr double min_distinct = 1e-10;  // of an eigenvalue; the differences are good to some 1e-9 themselves
    for (Eigen::Index k = 0; k < p; ++k) {
        for (Eigen::Index j = 0; j < p; ++j) {
            if (normal.eigenvalues()[k] < min_distinct && std::abs(normal.eigenvectors()(j, k)) > 0.1) {
                const Free& free = residuals.free()[inner[static_cast<std::size_t>(j)]];
                fit.undetermined.push_back(fit.parameters[free.index].name);
            }
        }
    }
    if (!fit.undetermined.empty() || (!options.is_weighted && degrees <= 0)) {
        return;
    }
    const double variance = options.is_weighted ? 1 : minimum.sum_of_squares / degrees;
    const Eigen::MatrixXd inverse =
        normal.eigenvectors() * normal.eigenvalues().cwiseInverse().asDiagonal() * normal.eigenvectors().transpose();
    for (Eigen::Index j = 0; j < p; ++j) {
        const std::size_t row = residuals.free()[inner[static_cast<std::size_t>(j)]].index;
        for (Eigen::Index k = 0; k < p; ++k) {
            const std::size_t column = residuals.free()[inner[static_cast<std::size_t>(k)]].index;
            fit.covariance[row][column] = variance * scale[j] * scale[k] * inverse(j, k);
        }
        fit.parameters[row].standard_error = std::sqrt(fit.covariance[row][row]);
    }
    find_combinations(fit);
}

}  // namespace

std::optional<double> EffectFit::correlation(std::size_t i, std::size_t j) const {
    const auto& a = parameters[i].standard_error;
    const auto& b = parameters[j].standard_error;
    if (!a || !b || !(*a > 0 && *b > 0)) {
        return std::nullopt;
    }
    return std::clamp(covariance[i][j] / (*a * *b), -1.0, 1.0);
}

EffectFit fit_effect(EffectModel model, const std::vector<Measurement>& points, const FitOptions& options) {
    if (model == EffectModel::table) {
        throw_input_error("a table has no parameters to fit; expected the name of a formula");
    }
    const SurfaceEffect start = starting_effect(model, options);
    const Residuals residuals(start, free_parameters(model, options), points, options);
    const std::vector<Free>& free = residuals.free();
    check_points(points, free.size(), options);

    std::vector<double> source_values;
    source_values.reserve(free.size());
    for (const Free& range : free) {
        source_values.push_back(std::clamp(start.parameters[range.index], range.low, range.high));
    }
    const Minimum minimum =
        free.empty() ? Minimum{{}, residuals.sum_of_squares(nullptr), true} : search(residuals, source_values);
    if (!std::isfinite(minimum.sum_of_squares)) {
        throw_input_error("the formula of " + std::string(info(model).name) +
                          " has a pole where there are measurements; leave out those nearest to the surface");
    }

    EffectFit fit;
    fit.effect = residuals.effect(minimum.values.data());
    fit.is_converged = minimum.is_converged;
    const auto& known = info(model).parameters;
    for (std::size_t i = 0; i < known.size(); ++i) {
        const bool is_free = std::any_of(free.begin(), free.end(), [i](const Free& range) { return range.index == i; });
        fit.parameters.push_back({known[i].name, fit.effect.parameters[i], std::nullopt, !is_free, false});
    }
    fit.covariance.assign(known.size(), std::vector<double>(known.size(), 0));
    double squares = 0;
    for (const Measurement& point : points) {
        fit.residuals.push_back(point.thrust_ratio - formula_factor(fit.effect, point.z_over_r, options.neighbours));
        squares += fit.residuals.back() * fit.residuals.back();
    }
    fit.rmse = std::sqrt(squares / static_cast<double>(points.size()));
    judge(fit, residuals, minimum, options);
    return fit;
}

}  // namespace downwash
