#include "vehicle_link.hpp"

#include <cstdio>

#include <nlohmann/json.hpp>

using nlohmann::json;

namespace {

constexpr int timeout_s = 2;

/// A plan with the names of solution.json.
json columns_of(const downwash::Plan& plan) {
    json columns;
    for (const downwash::ReferenceKnot& knot : plan.reference) {
        columns["t_s"].push_back(static_cast<double>(knot.tick) * plan.tick_s);
        for (std::size_t i = 0; i < plan.axes.size(); ++i) {
            const downwash::Axis& axis = plan.axes[i];
            columns[std::string(axis.position)].push_back(knot.point.position[i]);
            columns[std::string(axis.velocity)].push_back(knot.point.velocity[i]);
            columns[std::string(axis.acceleration)].push_back(knot.point.acceleration[i]);
        }
    }
    return columns;
}

Telemetry telemetry_of(const json& row) {
    Telemetry now{
        row.at("tick"), row.at("x_m"), row.at("z_m"), row.at("pitch_rad"), row.at("arm_rad"), row.at("vz_m_s"), {}};
    if (!row.at("range_up_m").is_null()) {
        now.range_up_m = row.at("range_up_m").get<double>();
    }
    return now;
}

/// Does something with the next message. What it throws of a message that it does not understand becomes
/// ConnectionLost.
template <class Use>
void with_message(LineSocket& socket, const Use& use) {
    const auto line = socket.receive(timeout_s);
    if (!line) {
        throw ConnectionLost("no message for " + std::to_string(timeout_s) + " s");
    }
    try {
        const json message = json::parse(*line);
        use(message.at("type").get<std::string>(), message);
    } catch (const json::exception&) {
        throw ConnectionLost("it sent what is no message: " + line->substr(0, 80));
    }
}

}  // namespace

VehicleLink::VehicleLink(const std::string& path) : socket_(LineSocket::connect_to(path, 10)) {
    with_message(socket_, [&](const std::string& type, const json& hello) {
        if (type != "hello") {
            throw ConnectionLost("it does not say hello");
        }
        tick_s_ = hello.at("tick_s");
        is_lock_step_ = hello.at("lock_step");
    });
}

Telemetry VehicleLink::next() {
    if (is_lock_step_ && is_waiting_) {
        socket_.send(json{{"type", "go"}}.dump());
    }
    is_waiting_ = true;
    std::optional<Telemetry> now;
    while (!now) {
        with_message(socket_, [&](const std::string& type, const json& message) {
            if (type == "telemetry") {
                now = telemetry_of(message);
            } else if (type == "accepted") {
                const std::size_t id = message.at("id");
                if (id >= sent_.size()) {
                    throw ConnectionLost("it accepts what was never sent");
                }
                accepted_ = sent_[id];
            } else if (type == "rejected") {
                std::printf("            the vehicle rejects a reference: %s\n",
                            message.at("reason").get<std::string>().c_str());
            } else if (type == "ended") {
                throw FlightFailed("the vehicle's flight has ended: " + message.at("outcome").get<std::string>());
            }
        });
    }
    return *now;
}

void VehicleLink::send(const Command& command) {
    socket_.send(json{{"type", "reference"},
                      {"id", sent_.size()},
                      {"from_tick", command.from_tick},
                      {"reference", columns_of(command.plan)}}
                     .dump());
    sent_.push_back(command);
}

void VehicleLink::end() {
    socket_.send(json{{"type", "end"}}.dump());
    for (bool has_heard = false; !has_heard;) {
        with_message(socket_, [&](const std::string& type, const json&) { has_heard = type == "ended"; });
    }
}
