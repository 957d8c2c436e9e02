#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "../support/error_of.hpp"
#include "../support/random.hpp"
#include "downwash/fitting/effect_fit.hpp"

using namespace downwash;
using downwash::test::Random;

namespace {

using Formula = std::function<double(double a, double b, double zeta)>;

double he_formula(double a, double b, double zeta) {
    return 1 + a * std::exp(-b * zeta);
}
double ceiling_formula(double k1, double k2, double zeta) {
    return 1 / (1 - 1 / (k1 * (zeta + k2) * (zeta + k2)));
}
double li_formula(double rho, double /*unused*/, double zeta) {
    return 1 / (1 - rho / (16 * zeta * zeta));
}

/// Least squares by looking: a net of points over the parameters, drawn closer around its best one again and again.
std::array<double, 2> best_by_looking(const Formula& formula, const std::vector<Measurement>& points) {
    constexpr int half = 12;
    std::array<double, 2> best{1, 1};
    double decades = 2;  // from a hundredth to a hundred
    for (int round = 0; round < 120; ++round, decades *= 0.8) {
        const std::array<double, 2> center = best;
        double least = 1e300;
        for (int i = -half; i <= half; ++i) {
            for (int j = -half; j <= half; ++j) {
                const double a = center[0] * std::pow(10, decades * i / half);
                const double b = center[1] * std::pow(10, decades * j / half);
                double sum = 0;
                for (const Measurement& point : points) {
                    const double k = formula(a, b, point.z_over_r);
                    sum += k > 0 ? (k - point.thrust_ratio) * (k - point.thrust_ratio) : 1e9;
                }
                if (sum < least) {
                    least = sum;
                    best = {a, b};
                }
            }
        }
    }
    return best;
}

double normal(Random& random) {
    constexpr double turn = 6.28318530717958647692;
    return std::sqrt(-2 * std::log(1 - random.uniform(0, 1))) * std::cos(turn * random.uniform(0, 1));
}

Measurement point_at(double z_over_r, double thrust_ratio) {
    Measurement point;
    point.z_over_r = z_over_r;
    point.thrust_ratio = thrust_ratio;
    return point;
}

std::vector<Measurement> samples(const SurfaceEffect& truth, int count, double sigma, Random& random) {
    std::vector<Measurement> points;
    for (int i = 0; i < count; ++i) {
        const double z_over_r = 0.3 + 2.5 * i / (count - 1);
        points.push_back(point_at(z_over_r, formula_factor(truth, z_over_r) + sigma * normal(random)));
        if (sigma > 0) {
            points.back().sigma = sigma;
        }
    }
    return points;
}

std::vector<Measurement> points_of(const std::vector<std::array<double, 2>>& values) {
    std::vector<Measurement> points;
    for (const auto& [z_over_r, thrust_ratio] : values) {
        points.push_back(point_at(z_over_r, thrust_ratio));
    }
    return points;
}

std::vector<Measurement> shipped(const std::string& source, const std::string& surface) {
    return read_measurements(DOWNWASH_MEASUREMENTS).with("source", source).with("surface", surface).points;
}

std::string error_of(EffectModel model, const std::vector<Measurement>& points, const FitOptions& options = {}) {
    return test::error_of([&] { return fit_effect(model, points, options); });
}

FitOptions fixing(const std::string& name, double value) {
    FitOptions options;
    options.fixed.emplace_back(name, value);
    return options;
}

}  // namespace

TEST_CASE("A fit finds the parameters that made its data, far from those of the source too") {
    Random random(1);
    for (int round = 0; round < 20; ++round) {
        for (const EffectModel model : {EffectModel::li, EffectModel::he, EffectModel::sanchez_cuevas}) {
            SurfaceEffect truth(model);
            if (model == EffectModel::li) {
                truth.parameters[0] = random.uniform(0.01, 1.3);
            } else if (model == EffectModel::he) {
                truth.parameters = {random.uniform(0.02, 20), random.uniform(0.1, 6)};
            } else {
                truth.parameters = {random.uniform(3, 100), random.uniform(0.4, 4)};
            }
            const EffectFit fit = fit_effect(model, samples(truth, 12, 0, random));
            CHECK(fit.is_converged);
            CHECK(fit.undetermined.empty());
            CHECK(fit.rmse < 1e-9);
            for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
                CHECK(fit.parameters[i].value == Approx(truth.parameters[i]).epsilon(1e-5));
                CHECK(fit.parameters[i].name == info(model).parameters[i].name);
                CHECK(fit.effect.parameters[i] == fit.parameters[i].value);
            }
        }
    }
}

TEST_CASE("Errors of a fit under noise are as large as its standard errors say") {
    constexpr int fits = 400;
    SurfaceEffect truth(EffectModel::he);
    truth.parameters = {0.5, 1.6};
    for (const bool is_weighted : {false, true}) {
        Random random(7);
        FitOptions options;
        options.is_weighted = is_weighted;
        std::array<int, 2> within_one{}, within_two{};
        double products = 0, correlations = 0, chi_squared = 0;
        for (int i = 0; i < fits; ++i) {
            const EffectFit fit = fit_effect(EffectModel::he, samples(truth, 20, 0.01, random), options);
            std::array<double, 2> error{};
            for (std::size_t j = 0; j < 2; ++j) {
                error[j] = (fit.parameters[j].value - truth.parameters[j]) / fit.parameters[j].standard_error.value();
                within_one[j] += std::abs(error[j]) < 1 ? 1 : 0;
                within_two[j] += std::abs(error[j]) < 2 ? 1 : 0;
            }
            products += error[0] * error[1];
            correlations += fit.correlation(0, 1).value();
            chi_squared += fit.reduced_chi_squared.value_or(0);
        }
        // Student's t with 18 degrees of freedom: 67.0 % within one and 93.9 % within two; normal: 68.3 % and 95.4 %.
        // Of 400 fits these shares have standard deviations of 2.3 % and 1.2 %; the bounds are three of them away.
        const double one = is_weighted ? 0.683 : 0.670;
        const double two = is_weighted ? 0.954 : 0.939;
        for (std::size_t j = 0; j < 2; ++j) {
            CHECK(static_cast<double>(within_one[j]) / fits == Approx(one).margin(0.07));
            CHECK(static_cast<double>(within_two[j]) / fits == Approx(two).margin(0.036));
        }
        CHECK(products / fits == Approx(correlations / fits).margin(0.25));
        CHECK(correlations / fits > 0.5);
        CHECK(chi_squared / fits == Approx(is_weighted ? 1 : 0).margin(0.05));
    }
}

TEST_CASE("A fit of one linear parameter has the closed form's value and standard error") {
    Random random(3);
    SurfaceEffect truth(EffectModel::he);
    const std::vector<Measurement> points = samples(truth, 15, 0.02, random);
    const EffectFit fit = fit_effect(EffectModel::he, points, fixing("b", 2));
    double ee = 0, ey = 0;
    for (const Measurement& point : points) {
        const double e = std::exp(-2 * point.z_over_r);
        ee += e * e;
        ey += e * (point.thrust_ratio - 1);
    }
    const double a = ey / ee;
    double squares = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double residual = points[i].thrust_ratio - 1 - a * std::exp(-2 * points[i].z_over_r);
        CHECK(fit.residuals[i] == Approx(residual).margin(1e-9));
        squares += residual * residual;
    }
    CHECK(fit.parameters[0].value == Approx(a).epsilon(1e-8));
    CHECK(fit.parameters[0].standard_error.value() == Approx(std::sqrt(squares / 14 / ee)).epsilon(1e-6));
    CHECK(fit.rmse == Approx(std::sqrt(squares / 15)).epsilon(1e-9));
    CHECK(fit.covariance[0][0] == Approx(squares / 14 / ee).epsilon(1e-6));
    CHECK(fit.parameters[1].is_fixed);
    CHECK(fit.parameters[1].value == 2);
    CHECK_FALSE(fit.parameters[1].standard_error);
    CHECK_FALSE(fit.correlation(0, 1));
}

TEST_CASE("Refits of the shipped measurements agree with a search by looking and with gnuplot") {
    // gnuplot 5.4.4 `fit` (Levenberg and Marquardt with its own differences): values, standard errors, RMSE.
    struct Expected {
        EffectModel model;
        Formula formula;
        std::vector<double> values, errors;
        double rmse;
    };
    struct Set {
        std::string source, surface;
        std::vector<Expected> expected;
    };
    const std::vector<Set> sets{
        {"jirs2024",
         "ceiling",
         {{EffectModel::sanchez_cuevas, ceiling_formula, {3.15108, 1.03004}, {0.750247, 0.170043}, 0.0182810},
          {EffectModel::fairing_cfd, ceiling_formula, {3.15108, 1.03004}, {0.750247, 0.170043}, 0.0182810},
          {EffectModel::he, he_formula, {0.307492, 1.20544}, {0.0183976, 0.0982907}, 0.0152469},
          {EffectModel::li, li_formula, {0.302283}, {0.0275532}, 0.0457812}}},
        {"jirs2024",
         "ground",
         {{EffectModel::sanchez_cuevas, ceiling_formula, {4.82309, 0.629196}, {1.91435, 0.195022}, 0.0358839},
          {EffectModel::fairing_cfd, ceiling_formula, {4.82309, 0.629196}, {1.91435, 0.195022}, 0.0358839},
          {EffectModel::he, he_formula, {0.503359, 1.64337}, {0.0472546, 0.194460}, 0.0283531},
          {EffectModel::li, li_formula, {0.393203}, {0.0279681}, 0.0530146}}},
        {"hydrus15_isolated",
         "ceiling",
         {{EffectModel::sanchez_cuevas, ceiling_formula, {5.65646, 0.567125}, {0.211226, 0.0179877}, 0.00345907},
          {EffectModel::fairing_cfd, ceiling_formula, {5.65646, 0.567125}, {0.211226, 0.0179877}, 0.00345907},
          {EffectModel::he, he_formula, {0.525556, 1.96819}, {0.0214625, 0.0825723}, 0.00838734},
          {EffectModel::li, li_formula, {0.398398}, {0.0336409}, 0.0549528}}},
    };
    for (const Set& set : sets) {
        const std::vector<Measurement> points = shipped(set.source, set.surface);
        CHECK(points.size() == (set.source == "jirs2024" ? 16 : 13));
        for (const Expected& expected : set.expected) {
            CAPTURE(set.source, set.surface, info(expected.model).name);
            const EffectFit fit = fit_effect(expected.model, points);
            const EffectFit again = fit_effect(expected.model, points);
            CHECK(again.effect.parameters == fit.effect.parameters);  // to the last bit
            CHECK(again.covariance == fit.covariance);
            const std::array<double, 2> looked = best_by_looking(expected.formula, points);
            CHECK(fit.is_converged);
            CHECK(fit.rmse == Approx(expected.rmse).epsilon(1e-5));
            for (std::size_t i = 0; i < expected.values.size(); ++i) {
                CHECK(fit.parameters[i].value == Approx(looked[i]).epsilon(1e-5));
                CHECK(fit.parameters[i].value == Approx(expected.values[i]).epsilon(5e-4));
                CHECK(fit.parameters[i].standard_error.value() == Approx(expected.errors[i]).epsilon(5e-3));
            }
        }
    }
}

TEST_CASE("A model without parameters is only compared, a parameter that leaves its range stays at the bound") {
    // K(0.5) = 4/3 and K(1) = 16/15.
    const EffectFit fit = fit_effect(EffectModel::cheeseman_bennett, points_of({{0.5, 1.3}, {1, 1.1}}));
    CHECK(fit.parameters.empty());
    CHECK(fit.rmse == Approx(1.0 / 30));
    CHECK(fit.residuals[0] == Approx(-1.0 / 30));
    CHECK(fit.residuals[1] == Approx(1.0 / 30));
    CHECK(fit_effect(EffectModel::none, points_of({{0.5, 1.3}})).rmse == Approx(0.3));
    const EffectFit bounded = fit_effect(EffectModel::li, points_of({{0.5, 0.95}, {1, 0.99}}));
    CHECK(bounded.parameters[0].value == 0);
    CHECK(bounded.parameters[0].is_at_bound);
    CHECK_FALSE(bounded.parameters[0].standard_error);
    CHECK(bounded.is_converged);
}

TEST_CASE("What the data do not determine is named, parameters that go together and could be zero too") {
    // No increment, so no decay of it, wherever that ended.
    const EffectFit flat = fit_effect(EffectModel::he, points_of({{0.5, 1}, {1, 1}, {2, 1}}));
    for (const FittedParameter& parameter : flat.parameters) {
        const bool is_named = std::count(flat.undetermined.begin(), flat.undetermined.end(), parameter.name) == 1;
        CHECK(is_named != parameter.is_at_bound);
        CHECK((is_named || parameter.name != "b"));
        CHECK_FALSE(parameter.standard_error);
    }
    CHECK(flat.rmse < 1e-9);
    // As many points as parameters: every curve through them is exact, and nothing is left to tell the noise by.
    const std::vector<Measurement> two = points_of({{0.5, 1.3}, {1, 1.1}});
    const EffectFit exact = fit_effect(EffectModel::he, two);
    CHECK(exact.rmse < 1e-9);
    CHECK_FALSE(exact.parameters[0].standard_error);
    CHECK_FALSE(exact.correlation(0, 1));
    // Over 0.03 radii nothing tells increment and decay apart: b = 2 with a standard error of several.
    const EffectFit fit = fit_effect(EffectModel::he, points_of({{1, 1.1}, {1.01, 1.11}, {1.02, 1.09}, {1.03, 1.1}}));
    CHECK(fit.correlation(0, 1).value() > 0.999);
    CHECK(fit.parameters[1].standard_error.value() > fit.parameters[1].value);
    CHECK(fit.undetermined == std::vector<std::string_view>{"a", "b"});
    for (const char* source : {"jirs2024", "hydrus15_isolated"}) {
        CHECK(fit_effect(EffectModel::he, shipped(source, "ceiling")).undetermined.empty());
        CHECK(fit_effect(EffectModel::sanchez_cuevas, shipped(source, "ceiling")).undetermined.empty());
    }
}

TEST_CASE("A fountain that the data do not show is at its bound, and its distance is not determined") {
    FitOptions options;
    options.neighbours = square_quadrotor(2.5);
    const EffectFit fit = fit_effect(EffectModel::multirotor_body, shipped("jirs2024", "ground"), options);
    CHECK(fit.parameters[0].value == 0);
    CHECK(fit.parameters[0].is_at_bound);
    CHECK_FALSE(fit.parameters[1].is_at_bound);
    CHECK(fit.undetermined == std::vector<std::string_view>{"b_over_radius"});
}

TEST_CASE("A weighted fit believes each point by its sigma") {
    SurfaceEffect truth(EffectModel::he);
    Random random(5);
    std::vector<Measurement> points = samples(truth, 10, 0, random);
    for (Measurement& point : points) {
        point.sigma = 1e-4;
    }
    points[3].thrust_ratio += 0.5;
    points[3].sigma = 100;
    FitOptions weighted;
    weighted.is_weighted = true;
    CHECK(fit_effect(EffectModel::he, points, weighted).parameters[0].value == Approx(0.4).epsilon(1e-4));
    CHECK(std::abs(fit_effect(EffectModel::he, points).parameters[0].value - 0.4) > 0.05);
    points[4].sigma.reset();
    points[4].line = 12;
    CHECK(error_of(EffectModel::he, points, weighted) ==
          "the measurements:12: no sigma; expected one for every measurement of a weighted fit");
}

TEST_CASE("Multirotor models are fitted with their neighbours") {
    const RotorNeighbours quad = square_quadrotor(2.5);
    SurfaceEffect truth(EffectModel::multirotor_body);
    truth.parameters = {1.7, 1.5};
    std::vector<Measurement> points;
    for (double zeta = 0.7; zeta < 4; zeta += 0.2) {
        points.push_back(point_at(zeta, formula_factor(truth, zeta, quad)));
    }
    FitOptions options;
    options.neighbours = quad;
    const EffectFit fit = fit_effect(EffectModel::multirotor_body, points, options);
    CHECK(fit.parameters[0].value == Approx(1.7).epsilon(1e-5));
    CHECK(fit.parameters[1].value == Approx(1.5).epsilon(1e-5));
}

TEST_CASE("Fits that make no sense are errors") {
    const std::vector<Measurement> one = points_of({{1, 1.1}, {1, 1.12}});
    CHECK(error_of(EffectModel::he, one) ==
          "the measurements: only 1 different z_over_r; expected at least 2, one for each parameter of the model");
    FitOptions of_file;
    of_file.source = "bench.csv";
    CHECK(error_of(EffectModel::he, one, of_file) ==
          "bench.csv: only 1 different z_over_r; expected at least 2, one for each parameter of the model");
    CHECK(error_of(EffectModel::he, one, fixing("b", 2)) == "none");
    CHECK(error_of(EffectModel::he, {}) == "the measurements: nothing to fit; expected at least one measurement");
    CHECK(error_of(EffectModel::table, one) == "a table has no parameters to fit; expected the name of a formula");
    CHECK(error_of(EffectModel::he, one, fixing("k1", 2)) == "the model he has no parameter 'k1' to be fixed");
    CHECK(error_of(EffectModel::he, one, fixing("b", 0)) ==
          "the parameter b cannot be fixed at 0; expected a number above 0 and at most 100");
    CHECK(error_of(EffectModel::he, one, fixing("a", std::nan(""))) ==
          "the parameter a cannot be fixed at nan; expected a number of at least 0 and at most 100");
    CHECK(error_of(EffectModel::cheeseman_bennett, points_of({{0.2, 1.5}})) ==
          "the formula of cheeseman-bennett has a pole where there are measurements; leave out those nearest to the "
          "surface");
}
