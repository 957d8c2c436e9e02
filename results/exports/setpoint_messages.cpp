#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/formats.hpp"
#include "downwash/exports/setpoint_file.hpp"
#include "downwash/results/json_place.hpp"

namespace downwash {
namespace {

using Json = nlohmann::json;

/// A value of a document, and how it is reached. Refers to those above it.
struct Node {
    const Json& json;
    const Node* above = nullptr;
    std::string_view key = {};
    std::size_t index = 0;  ///< in a list, where there is no key

    [[nodiscard]] std::string path() const {
        if (above == nullptr) {
            return "";
        }
        const std::string before = above->path();
        if (key.empty()) {
            return before + "[" + std::to_string(index) + "]";
        }
        return before.empty() ? std::string(key) : before + "." + std::string(key);
    }
};

/// Reads values of a document of JSON and collects what is wrong with them. After an error it hands out zeros.
class MessageReader {
 public:
    MessageReader(std::string_view text, const std::string& file) : text_(text), errors_(file) {}

    /// @throws InputError if it is no JSON
    [[nodiscard]] Json document() {
        try {
            return Json::parse(text_);
        } catch (const Json::parse_error& error) {
            add_parse_error(error.byte > 0 ? error.byte - 1 : 0);
        } catch (const Json::exception&) {
            errors_.add(0, "holds a number that is too large");
        }
        errors_.throw_any();
        return {};
    }

    /// @throws InputError with all errors once there are enough of them
    void report(const Node& node, const std::string& message) {
        constexpr int enough = 20;
        const std::string path = node.path();
        const problems::TextPlace place = problems::json_place(text_, path);
        errors_.add(static_cast<std::size_t>(place.line), static_cast<std::size_t>(place.column),
                    path + (path.empty() ? "" : ": ") + message);
        if (++count_ >= enough) {
            errors_.throw_any();
        }
    }
    void throw_any() const { errors_.throw_any(); }

    /// Calls read(node) for the member of a group; reports one that is missing.
    template <class Read>
    void with(const Node& group, std::string_view key, const Read& read) {
        const auto found = group.json.is_object() ? group.json.find(key) : group.json.end();
        if (!group.json.is_object()) {
            report(group, "expected a group of keys");
        } else if (found == group.json.end()) {
            report(group, "'" + std::string(key) + "' is missing here");
        } else {
            read(Node{*found, &group, key});
        }
    }

    /// Calls read(node, index) for each element of a list. @param size how many there have to be; empty: any
    template <class Read>
    void each(const Node& list, std::optional<std::size_t> size, const Read& read) {
        if (!list.json.is_array()) {
            report(list, "expected a list");
        } else if (size && list.json.size() != *size) {
            report(list, "expected a list of " + std::to_string(*size) + ", found " + std::to_string(list.json.size()));
        } else {
            for (std::size_t i = 0; i < list.json.size(); ++i) {
                read(Node{list.json[i], &list, {}, i}, i);
            }
        }
    }

    double number(const Node& node) {
        if (!node.json.is_number()) {
            report(node, "expected a number, found " + std::string(node.json.type_name()));
            return 0;
        }
        return node.json.get<double>();
    }
    double number(const Node& group, std::string_view key) {
        double value = 0;
        with(group, key, [&](const Node& node) { value = number(node); });
        return value;
    }
    /// A list of three.
    Vector3 vector(const Node& group, std::string_view key) {
        Vector3 vector{};
        with(group, key, [&](const Node& list) {
            each(list, 3, [&](const Node& node, std::size_t axis) { vector[axis] = number(node); });
        });
        return vector;
    }
    /// A group of x, y and z.
    Vector3 xyz(const Node& group, std::string_view key) {
        Vector3 vector{};
        with(group, key, [&](const Node& of) { vector = {number(of, "x"), number(of, "y"), number(of, "z")}; });
        return vector;
    }
    double duration_s(const Node& group, std::string_view key) {
        double time_s = 0;
        with(group, key, [&](const Node& of) { time_s = number(of, "sec") + number(of, "nanosec") / 1e9; });
        return time_s;
    }
    /// Calls read(node) for the only element of a list in a group: these messages have one joint of many freedoms.
    template <class Read>
    void with_only(const Node& group, std::string_view key, const Read& read) {
        with(group, key, [&](const Node& list) { each(list, 1, [&](const Node& node, std::size_t) { read(node); }); });
    }

 private:
    void add_parse_error(std::size_t byte) {
        const problems::TextPlace place = problems::place_of_byte(text_, byte);
        const std::string_view rest = text_.substr(std::min(byte, text_.size()));
        const bool is_word = !rest.empty() && std::isalpha(static_cast<unsigned char>(rest.front())) != 0;
        errors_.add(static_cast<std::size_t>(place.line), static_cast<std::size_t>(place.column),
                    is_word ? "this is no number of JSON, which has neither NaN nor infinity"
                            : "this is not JSON, or the file was cut off here");
    }

    std::string_view text_;
    LineErrors errors_;
    int count_ = 0;
};

/// The angle about z of an attitude.
double yaw_of(MessageReader& reader, const Node& transform) {
    constexpr double tolerance = 1e-6;
    double yaw_rad = 0;
    reader.with(transform, "rotation", [&](const Node& node) {
        const double x = reader.number(node, "x"), y = reader.number(node, "y"), z = reader.number(node, "z");
        const double w = reader.number(node, "w");
        const double length = std::sqrt(x * x + y * y + z * z + w * w);
        if (!(std::abs(length - 1) <= tolerance)) {
            reader.report(node, "expected a quaternion of length 1, found length " + to_text(length, 6));
        }
        yaw_rad = std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
    });
    return yaw_rad;
}

Setpoint setpoint_of_px4(MessageReader& reader, const Node& node) {
    constexpr double second_us = 1e6;
    Setpoint point;
    point.t_s = reader.number(node, "timestamp") / second_us;
    point.position_m = reader.vector(node, "position");
    point.velocity_m_s = reader.vector(node, "velocity");
    point.acceleration_m_s2 = reader.vector(node, "acceleration");
    point.yaw_rad = reader.number(node, "yaw");
    point.yaw_rate_rad_s = reader.number(node, "yawspeed");
    return point;
}

Setpoint setpoint_of_ros(MessageReader& reader, const Node& node) {
    Setpoint point;
    point.t_s = reader.duration_s(node, "time_from_start");
    reader.with_only(node, "transforms", [&](const Node& transform) {
        point.position_m = reader.xyz(transform, "translation");
        point.yaw_rad = yaw_of(reader, transform);
    });
    reader.with_only(node, "velocities", [&](const Node& twist) {
        point.velocity_m_s = reader.xyz(twist, "linear");
        point.yaw_rate_rad_s = reader.xyz(twist, "angular")[2];
    });
    reader.with_only(node, "accelerations", [&](const Node& twist) {
        point.acceleration_m_s2 = reader.xyz(twist, "linear");
        point.yaw_acceleration_rad_s2 = reader.xyz(twist, "angular")[2];
    });
    return point;
}

/// For each name of a JointTrajectory, which joint of the robot it is. Where no name is known, they are names of
/// another program, in the order of the joints.
std::vector<std::size_t> joint_order(MessageReader& reader, const Node& names,
                                     const std::vector<JointInWorld>& joints) {
    std::vector<std::size_t> order;
    std::vector<std::string_view> known;
    known.reserve(joints.size());
    for (const JointInWorld& joint : joints) {
        known.push_back(joint.name);
    }
    const auto index_of = [&](const Json& name) {
        const auto found = std::ranges::find_if(known, [&](std::string_view one) { return name == one; });
        return static_cast<std::size_t>(found - known.begin());
    };
    const bool are_foreign = names.json.is_array() && std::ranges::none_of(names.json, [&](const Json& name) {
                                 return index_of(name) < known.size();
                             });
    reader.each(names, joints.size(), [&](const Node& name, std::size_t i) {
        const std::size_t index = are_foreign ? i : index_of(name.json);
        if (index == known.size()) {
            reader.report(name, "the arm has no joint of that name: expected " + joined_names(known));
        } else if (std::ranges::find(order, index) != order.end()) {
            reader.report(name, "occurs twice");
        } else {
            order.push_back(index);
        }
    });
    return order;
}

/// Reads a JointTrajectory into set-points that have all but the arm, and expects their times.
void read_arm(MessageReader& reader, const Node& message, const std::vector<JointInWorld>& joints,
              std::vector<Setpoint>& points) {
    constexpr double tolerance_s = 1e-6;  // PX4's times are whole microseconds
    std::vector<std::size_t> order;
    reader.with(message, "joint_names", [&](const Node& names) { order = joint_order(reader, names, joints); });
    reader.throw_any();
    reader.with(message, "points", [&](const Node& list) {
        reader.each(list, points.size(), [&](const Node& node, std::size_t i) {
            Setpoint& point = points[i];
            point.joints.resize(joints.size());
            const double t_s = reader.duration_s(node, "time_from_start");
            if (!(std::abs(t_s - point.t_s) <= tolerance_s)) {
                reader.report(node, "expected the time of the vehicle's set-point, " + to_text(point.t_s, 9) +
                                        " s, found " + to_text(t_s, 9) + " s");
            }
            const auto read = [&](std::string_view key, double JointSetpoint::*number) {
                reader.with(node, key, [&](const Node& numbers) {
                    reader.each(numbers, order.size(), [&](const Node& value, std::size_t k) {
                        point.joints[order[k]].*number = reader.number(value);
                    });
                });
            };
            read("positions", &JointSetpoint::angle_rad);
            read("velocities", &JointSetpoint::rate_rad_s);
            read("accelerations", &JointSetpoint::acceleration_rad_s2);
        });
    });
}

SetpointFrame frame_of(const Json& vehicle) {
    const auto header = vehicle.find("header");
    const bool is_map =
        header != vehicle.end() && header->is_object() && header->value("frame_id", Json()) == map_frame_id;
    return is_map ? SetpointFrame::east_north_up : SetpointFrame::world;
}

}  // namespace

SetpointFile read_setpoint_messages(std::string_view text, const std::string& file,
                                    const std::vector<JointInWorld>& joints) {
    MessageReader reader(text, file);
    const Json document = reader.document();
    const Node root{document};
    SetpointFile read;
    std::string list_path = "trajectory_setpoints";
    const auto read_points = [&](const Node& list, Setpoint (*setpoint_of_message)(MessageReader&, const Node&)) {
        reader.each(list, {},
                    [&](const Node& node, std::size_t) { read.points.push_back(setpoint_of_message(reader, node)); });
    };
    if (document.contains("trajectory_setpoints")) {
        read.format = "px4";
        read.frame = SetpointFrame::north_east_down;
        reader.with(root, "trajectory_setpoints", [&](const Node& list) { read_points(list, setpoint_of_px4); });
    } else if (document.contains("multi_dof_joint_trajectory")) {
        read.format = "ros";
        read.has_yaw_acceleration = true;
        list_path = "multi_dof_joint_trajectory.points";
        reader.with(root, "multi_dof_joint_trajectory", [&](const Node& vehicle) {
            reader.with(vehicle, "points", [&](const Node& list) { read_points(list, setpoint_of_ros); });
            read.frame = frame_of(vehicle.json);
        });
    } else {
        reader.report(
            root, "there are no set-points: expected trajectory_setpoints (px4) or multi_dof_joint_trajectory (ros)");
    }
    reader.throw_any();
    read.add = [text, list_path](LineErrors& to, std::size_t point, const std::string& message) {
        const std::string path = list_path + "[" + std::to_string(point) + "]";
        const problems::TextPlace place = problems::json_place(text, path);
        to.add(static_cast<std::size_t>(place.line), static_cast<std::size_t>(place.column), path + ": " + message);
    };
    require_rising_times(read, file);
    read.has_arm = document.contains("joint_trajectory");
    if (read.has_arm) {
        reader.with(root, "joint_trajectory",
                    [&](const Node& message) { read_arm(reader, message, joints, read.points); });
    }
    reader.throw_any();
    return read;
}

}  // namespace downwash
