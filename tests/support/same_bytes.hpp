#pragma once

#include <algorithm>
#include <cstring>

#include "downwash/planner/solution.hpp"

namespace downwash::test {

/// The same reference, knot by knot, to the last bit.
inline bool same_bytes(const Plan& a, const Plan& b) {
    return std::equal(a.reference.begin(), a.reference.end(), b.reference.begin(), b.reference.end(),
                      [](const ReferenceKnot& k, const ReferenceKnot& l) {
                          return k.tick == l.tick && std::memcmp(&k.point, &l.point, sizeof(k.point)) == 0;
                      });
}

/// The same flight, tick by tick, to the last bit.
inline bool same_bytes(const Execution& a, const Execution& b) {
    return a.energy_j == b.energy_j && std::equal(a.rows.begin(), a.rows.end(), b.rows.begin(), b.rows.end(),
                                                  [](const FlightRow& r, const FlightRow& s) {
                                                      return std::memcmp(r.q, s.q, sizeof(r.q)) == 0 &&
                                                             std::memcmp(r.u, s.u, sizeof(r.u)) == 0 &&
                                                             r.energy_j == s.energy_j;
                                                  });
}

}  // namespace downwash::test
