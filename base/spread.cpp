#include "downwash/base/spread.hpp"

#include <algorithm>

#include "downwash/base/portable_math.hpp"

namespace downwash {

double Spread::difference(double p, double nominal, bool range_is_of_number) const noexcept {
    switch (form) {
        case Form::sd: {
            constexpr double cut = 3;
            constexpr double below_cut = 0.0013498980316300946;  // the probability of less than -3
            const double x = normal_quantile(below_cut + std::clamp(p, 0.0, 1.0) * (1 - 2 * below_cut));
            const double deviation = high * std::clamp(x, -cut, cut);
            return low == 0 ? deviation : low + deviation;
        }
        case Form::range:
            return low + p * (high - low) - (range_is_of_number ? nominal : 0);
        case Form::factor:
            return (low + p * (high - low)) * nominal - nominal;
        case Form::exact:
            break;
    }
    return 0;
}

}  // namespace downwash
