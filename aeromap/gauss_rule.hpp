#pragma once

// Private to aeromap.

#include <array>
#include <cstddef>

namespace downwash {

/// A node of a rule on [-1, 1].
struct GaussNode {
    double position, weight;
};

/// N-point Gauss-Legendre rule after the substitution s = (3 t - t^3) / 2, which is flat at both ends: integrands that
/// start or end like a square root (the rim of a disc, the flank of a cylinder) lose their singularity.
template <std::size_t N>
constexpr std::array<GaussNode, N> smoothed(const std::array<GaussNode, N / 2>& upper_half) {
    std::array<GaussNode, N> rule{};
    for (std::size_t j = 0; j < N / 2; ++j) {
        const double t = upper_half[j].position;
        const double s = 0.5 * t * (3 - t * t);
        const double weight = 1.5 * (1 - t * t) * upper_half[j].weight;
        rule[j] = {-s, weight};
        rule[N - 1 - j] = {s, weight};
    }
    return rule;
}

// Nodes from the outermost inwards: zeros of the Legendre polynomials.
inline constexpr auto smoothed_2 = smoothed<2>({{{0.57735026918962576, 1}}});
inline constexpr auto smoothed_4 =
    smoothed<4>({{{0.8611363115940526, 0.34785484513745385}, {0.33998104358485626, 0.6521451548625461}}});
inline constexpr std::array<GaussNode, 3> legendre_6{{{0.932469514203152, 0.17132449237917036},
                                                      {0.6612093864662645, 0.3607615730481386},
                                                      {0.2386191860831969, 0.46791393457269104}}};
inline constexpr auto smoothed_6 = smoothed<6>(legendre_6);
inline constexpr auto smoothed_8 = smoothed<8>({{{0.9602898564975363, 0.10122853629037626},
                                                 {0.7966664774136267, 0.22238103445337448},
                                                 {0.525532409916329, 0.31370664587788727},
                                                 {0.1834346424956498, 0.362683783378362}}});
inline constexpr std::array<GaussNode, 6> legendre_12{{{0.9815606342467192, 0.04717533638651183},
                                                       {0.9041172563704749, 0.10693932599531843},
                                                       {0.7699026741943047, 0.16007832854334622},
                                                       {0.5873179542866175, 0.20316742672306592},
                                                       {0.3678314989981802, 0.2334925365383548},
                                                       {0.1252334085114689, 0.24914704581340277}}};
inline constexpr auto smoothed_12 = smoothed<12>(legendre_12);

/// Gauss rules without the substitution, for integrands that are smooth up to their ends.
template <std::size_t N>
constexpr std::array<GaussNode, N> plain(const std::array<GaussNode, N / 2>& upper_half) {
    std::array<GaussNode, N> rule{};
    for (std::size_t j = 0; j < N / 2; ++j) {
        rule[j] = {-upper_half[j].position, upper_half[j].weight};
        rule[N - 1 - j] = upper_half[j];
    }
    return rule;
}

inline constexpr auto plain_6 = plain<6>(legendre_6);
inline constexpr auto plain_12 = plain<12>(legendre_12);

/// Integral of f over [low, high].
template <class Rule, class Function>
double integrate(const Rule& rule, double low, double high, Function&& f) {
    const double middle = 0.5 * (low + high);
    const double half = 0.5 * (high - low);
    double sum = 0;
    for (const GaussNode& node : rule) {
        sum += node.weight * f(middle + half * node.position);
    }
    return half * sum;
}

}  // namespace downwash
