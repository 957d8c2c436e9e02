#include "downwash/identification/flight_filter.hpp"

#include <stdexcept>
#include <utility>

#include "downwash/identification/flight_filter_of.hpp"

namespace downwash::identification {
namespace {

using Make = std::unique_ptr<FlightFilter> (*)(const SpaceRobot&, const LoggedFlight&, const FilterSettings&);

template <int n>
std::unique_ptr<FlightFilter> make(const SpaceRobot& robot, const LoggedFlight& flight,
                                   const FilterSettings& settings) {
    return std::make_unique<FlightFilterOf<n>>(robot, flight, settings);
}

template <int... n>
constexpr std::array<Make, sizeof...(n)> makers(std::integer_sequence<int, n...> /*joints*/) {
    return {make<n>...};
}

}  // namespace

std::unique_ptr<FlightFilter> make_flight_filter(const SpaceRobot& robot, const LoggedFlight& flight,
                                                 const FilterSettings& settings) {
    simulation::require_built_joints(robot);
    static constexpr auto all = makers(std::make_integer_sequence<int, DOWNWASH_MAX_JOINTS + 1>());
    return all[static_cast<std::size_t>(robot.joints())](robot, flight, settings);
}

}  // namespace downwash::identification
