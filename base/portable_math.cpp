#include "downwash/base/portable_math.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

namespace downwash {
namespace {

/// Evaluates a polynomial whose coefficients begin with the highest power.
template <std::size_t Count>
double polynomial(const double (&coefficients)[Count], double x) {
    double sum = 0;
    for (const double c : coefficients) {
        sum = sum * x + c;
    }
    return sum;
}

}  // namespace

double natural_log(double x) noexcept {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (!(x > 0 && x < infinity)) {
        return x > 0 ? infinity : -infinity;
    }
    double halvings = 1;
    while (x > 1.5 || x < 0.6) {
        x = std::sqrt(x);
        halvings *= 2;
    }
    const double t = (x - 1) / (x + 1);  // |t| <= 0.25
    double sum = 0;
    for (int k = 25; k >= 1; k -= 2) {
        sum = sum * t * t + 1.0 / k;
    }
    return 2 * halvings * t * sum;
}

double natural_exp(double x) noexcept {
    int squarings = 0;
    while (x < -0.25) {
        x *= 0.5;
        ++squarings;
    }
    double sum = 1;
    for (int k = 14; k >= 1; --k) {
        sum = 1 + sum * x / k;
    }
    for (; squarings > 0; --squarings) {
        sum *= sum;
    }
    return sum;
}

double normal_quantile(double p) noexcept {
    const double q = p - 0.5;
    if (std::fabs(q) <= 0.425) {
        constexpr double above[] = {2.5090809287301226727e+3, 3.3430575583588128105e+4, 6.7265770927008700853e+4,
                                    4.5921953931549871457e+4, 1.3731693765509461125e+4, 1.9715909503065514427e+3,
                                    1.3314166789178437745e+2, 3.3871328727963666080e+0};
        constexpr double below[] = {
            5.2264952788528545610e+3, 2.8729085735721942674e+4, 3.9307895800092710610e+4, 2.1213794301586595867e+4,
            5.3941960214247511077e+3, 6.8718700749205790830e+2, 4.2313330701600911252e+1, 1.0};
        const double r = 0.180625 - q * q;
        return q * polynomial(above, r) / polynomial(below, r);
    }
    const double r = std::sqrt(-natural_log(q <= 0 ? p : 1 - p));
    double x = 0;
    if (r <= 5) {
        constexpr double above[] = {7.74545014278341407640e-4, 2.27238449892691845833e-2, 2.41780725177450611770e-1,
                                    1.27045825245236838258e+0, 3.64784832476320460504e+0, 5.76949722146069140550e+0,
                                    4.63033784615654529590e+0, 1.42343711074968357734e+0};
        constexpr double below[] = {
            1.05075007164441684324e-9, 5.47593808499534494600e-4, 1.51986665636164571966e-2, 1.48103976427480074590e-1,
            6.89767334985100004550e-1, 1.67638483018380384940e+0, 2.05319162663775882187e+0, 1.0};
        x = polynomial(above, r - 1.6) / polynomial(below, r - 1.6);
    } else {
        constexpr double above[] = {2.01033439929228813265e-7, 2.71155556874348757815e-5, 1.24266094738807843860e-3,
                                    2.65321895265761230930e-2, 2.96560571828504891230e-1, 1.78482653991729133580e+0,
                                    5.46378491116411436990e+0, 6.65790464350110377720e+0};
        constexpr double below[] = {
            2.04426310338993978564e-15, 1.42151175831644588870e-7, 1.84631831751005468180e-5, 7.86869131145613259100e-4,
            1.48753612908506148525e-2,  1.36929880922735805310e-1, 5.99832206555887937690e-1, 1.0};
        x = polynomial(above, r - 5) / polynomial(below, r - 5);
    }
    return q < 0 ? -x : x;
}

}  // namespace downwash
