#include "downwash/report/page_flight.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "downwash/report/packed_numbers.hpp"

namespace downwash {
namespace {

using Json = nlohmann::ordered_json;

bool are_same(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
    });
}

}  // namespace

Json flight_json(const NumberTable& flight) {
    if (flight.rows() == 0) {
        return {};
    }
    PackedNumbers packed;
    std::vector<int> same_as;
    for (std::size_t i = 0; i < flight.columns.size(); ++i) {
        const auto end = flight.columns.begin() + static_cast<std::ptrdiff_t>(i);
        const auto twin = std::find_if(flight.columns.begin(), end,
                                       [&](const auto& column) { return are_same(column, flight.columns[i]); });
        same_as.push_back(twin == end ? -1 : static_cast<int>(twin - flight.columns.begin()));
        if (twin == end) {
            packed.add_smooth(flight.columns[i]);
        }
    }
    return {{"rows", flight.rows()}, {"columns", flight.names}, {"same_as", same_as}, {"data", packed.text()}};
}

std::string command_of_execution(const Json& solution) {
    const Json::json_pointer aero("/execution/aero"), index("/execution/world/index"), seed("/execution/world/seed");
    const auto is_count = [&](const Json::json_pointer& place) {
        return solution.contains(place) && solution[place].is_number_unsigned();
    };
    std::string command = "downwash execute effective.yaml --plan solution.json";
    command += solution.contains(aero) && solution[aero] == false ? " --aero off" : "";
    if (is_count(index) && is_count(seed)) {
        command += " --world " + solution[index].dump() + " --seed " + solution[seed].dump();
    }
    return command + " --out again";
}

}  // namespace downwash
