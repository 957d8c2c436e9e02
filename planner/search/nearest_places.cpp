#include "downwash/search/nearest_places.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>  // which the header below forgets
#include <utility>

#include <ompl/datastructures/NearestNeighborsGNATNoThreadSafety.h>

namespace downwash::planning {

/// OMPL's tree over places.
template <class Family>
struct NearestPlacesOf<Family>::Index {
    struct Place {
        Configuration at;
        std::size_t number;

        bool operator==(const Place& other) const { return number == other.number; }
        bool operator!=(const Place& other) const { return number != other.number; }
    };

    explicit Index(const SearchSpace& space) {
        neighbors.setDistanceFunction(
            [&space](const Place& a, const Place& b) { return space.distance_m(a.at, b.at); });
    }

    ompl::NearestNeighborsGNATNoThreadSafety<Place> neighbors;
};

template <class Family>
NearestPlacesOf<Family>::NearestPlacesOf(const SearchSpace& space, std::size_t indexed_from)
    : space_(space), indexed_from_(indexed_from) {}

template <class Family>
NearestPlacesOf<Family>::~NearestPlacesOf() = default;

template <class Family>
void NearestPlacesOf<Family>::add(const Configuration& place) {
    places_.push_back(place);
    if (index_ != nullptr) {
        index_->neighbors.add({places_.back(), places_.size() - 1});
    } else if (places_.size() >= indexed_from_) {
        index_ = std::make_unique<Index>(space_);
        std::vector<typename Index::Place> all;
        all.reserve(places_.size());
        for (std::size_t i = 0; i < places_.size(); ++i) {
            all.push_back({places_[i], i});
        }
        index_->neighbors.add(all);
    }
}

template <class Family>
auto NearestPlacesOf<Family>::scanned(const Configuration& to, std::size_t count) const -> std::vector<Found> {
    std::vector<Found> best;  // a heap
    best.reserve(count + 1);
    double farthest = HUGE_VAL;  // squared
    for (std::size_t i = 0; i < places_.size(); ++i) {
        const double squared = space_.squared_distance_m2(places_[i], to, farthest);
        if (squared >= farthest) {
            continue;
        }
        best.emplace_back(squared, i);
        std::push_heap(best.begin(), best.end());
        if (best.size() > count) {
            std::pop_heap(best.begin(), best.end());
            best.pop_back();
        }
        if (best.size() == count) {
            farthest = best.front().first;
        }
    }
    std::sort_heap(best.begin(), best.end());
    return best;
}

template <class Family>
auto NearestPlacesOf<Family>::indexed(const Configuration& to, std::size_t count) const -> std::vector<Found> {
    const typename Index::Place place{to, places_.size()};
    std::vector<typename Index::Place> near;
    index_->neighbors.nearestK(place, count, near);
    // Which of several places at the same distance it gives depends on random numbers: all that are as near follow. The
    // distance back may differ by rounding.
    constexpr double rounding_m = 1e-9;
    index_->neighbors.nearestR(place, space_.distance_m(near.back().at, to) + rounding_m, near);
    std::vector<Found> found;
    found.reserve(near.size());
    for (const typename Index::Place& each : near) {
        found.emplace_back(space_.squared_distance_m2(each.at, to, HUGE_VAL), each.number);
    }
    std::sort(found.begin(), found.end());
    found.resize(std::min(found.size(), count));
    return found;
}

template <class Family>
auto NearestPlacesOf<Family>::nearest(const Configuration& to, std::size_t count) const -> std::vector<std::size_t> {
    if (count == 0) {
        return {};
    }
    std::vector<std::size_t> numbers;
    for (const Found& found : index_ != nullptr ? indexed(to, count) : scanned(to, count)) {
        numbers.push_back(found.second);
    }
    return numbers;
}

template class NearestPlacesOf<Plane>;
template class NearestPlacesOf<Space>;

}  // namespace downwash::planning
