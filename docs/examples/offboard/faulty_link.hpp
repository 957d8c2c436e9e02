#pragma once

#include <algorithm>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// What happens to datagrams on their way to the vehicle.
struct LinkFaults {
    double loss = 0;      ///< share that is lost
    double jitter_s = 0;  ///< each is late by up to so much, and may come after a later one
    double silent_from_s = std::numeric_limits<double>::infinity();   ///< from then on all are lost,
    double silent_until_s = std::numeric_limits<double>::infinity();  ///< until then
};

/// A link on which datagrams suffer.
class FaultyLink {
 public:
    explicit FaultyLink(const LinkFaults& faults, unsigned seed = 1) : faults_(faults), random_(seed) {}

    void put(double now_s, std::string datagram) {
        const double luck = share(), delay_s = faults_.jitter_s * share();
        const bool is_silent = now_s >= faults_.silent_from_s && now_s < faults_.silent_until_s;
        if (!is_silent && luck >= faults_.loss) {
            under_way_.push_back({now_s + delay_s, std::move(datagram)});
        }
    }
    /// Those that have arrived, in their order.
    std::vector<std::string> arrived(double now_s) {
        const auto earlier = [](const Datagram& a, const Datagram& b) { return a.at_s < b.at_s; };
        std::stable_sort(under_way_.begin(), under_way_.end(), earlier);
        std::vector<std::string> all;
        while (!under_way_.empty() && under_way_.front().at_s <= now_s) {
            all.push_back(std::move(under_way_.front().bytes));
            under_way_.erase(under_way_.begin());
        }
        return all;
    }

 private:
    struct Datagram {
        double at_s;
        std::string bytes;
    };
    /// Drawn evenly from 0 to below 1, the same on every machine.
    double share() { return static_cast<double>(random_()) / 4294967296.0; }

    LinkFaults faults_;
    std::mt19937 random_;
    std::vector<Datagram> under_way_;
};
