#include "downwash/controllers/bernstein.hpp"

#include <algorithm>
#include <cassert>

namespace downwash::controllers {

Bound is_at_most(std::span<const double> coefficients, double limit) noexcept {
    constexpr int max_halvings = 20;
    constexpr int max_size = max_bernstein_degree + 1;
    const int size = static_cast<int>(coefficients.size());
    assert(size >= 1 && size <= max_size);

    // Parts of [0, 1] that are to be looked at, the leftmost last.
    double parts[max_halvings + 1][max_size];
    int halvings[max_halvings + 1] = {0};
    int count = 1;
    std::copy(coefficients.begin(), coefficients.end(), parts[0]);
    while (count > 0) {
        double* part = parts[count - 1];
        if (!(part[0] <= limit && part[size - 1] <= limit)) {
            return Bound::broken;
        }
        bool is_kept = true;
        for (int i = 1; i < size - 1; ++i) {
            is_kept = is_kept && part[i] <= limit;
        }
        if (is_kept) {
            --count;
            continue;
        }
        if (halvings[count - 1] == max_halvings) {
            return Bound::open;
        }
        // The right half takes the place of the whole, the left one goes on top of it.
        double* left = parts[count];
        halvings[count] = ++halvings[count - 1];
        ++count;
        left[0] = part[0];
        for (int step = 1; step < size; ++step) {
            for (int i = 0; i < size - step; ++i) {
                part[i] = 0.5 * (part[i] + part[i + 1]);
            }
            left[step] = part[0];
        }
    }
    return Bound::kept;
}

}  // namespace downwash::controllers
