#include "downwash/exports/setpoint_file.hpp"

#include "downwash/base/csv_reader.hpp"
#include "downwash/base/key_error.hpp"
#include "downwash/base/text.hpp"
#include "downwash/exports/setpoint_table.hpp"

namespace downwash {
namespace {

constexpr std::size_t max_rows = 1'000'001;  // a million set-points, and the end
constexpr std::size_t max_columns = 200;

/// The columns of a file that a table describes, in its order. Adds an error for each that is missing.
std::vector<std::size_t> find_columns(CsvReader& csv, const std::vector<SetpointColumn>& columns) {
    std::vector<std::size_t> places;
    places.reserve(columns.size());
    for (const SetpointColumn& column : columns) {
        places.push_back(csv.required(column.name, "the columns that `downwash export` writes"));
    }
    return places;
}

}  // namespace

void require_rising_times(const SetpointFile& setpoints, const std::string& file) {
    constexpr int enough = 20;
    const std::vector<Setpoint>& points = setpoints.points;
    LineErrors errors(file);
    if (points.empty()) {
        errors.add(0, "there are no set-points");
    }
    int count = 0;
    for (std::size_t i = 1; i < points.size() && count < enough; ++i) {
        if (!(points[i].t_s > points[i - 1].t_s)) {
            ++count;
            setpoints.add(errors, i,
                          "the time does not rise: " + to_text(points[i].t_s, 9) + " s after " +
                              to_text(points[i - 1].t_s, 9) + " s");
        }
    }
    errors.throw_any();
}

SetpointFile read_setpoint_table(std::string_view text, const std::string& file,
                                 const std::vector<JointInWorld>& joints, bool turns) {
    LineErrors errors(file);
    CsvReader csv(text, errors, {max_rows, max_columns});
    const SetpointTable table = csv.find("timestamp") ? px4_table(joints) : world_table(joints, turns);
    constexpr double second_us = 1e6;
    const double unit_s = table.is_in_us ? 1 / second_us : 1;
    const std::size_t time = csv.required(table.time, "t_s, or PX4's timestamp");
    SetpointFile read{.format = table.format,
                      .frame = table.frame,
                      .has_yaw_rate = table.has_yaw_rate,
                      .has_yaw_acceleration = table.has_yaw_acceleration};
    for (const SetpointColumn& column : table.arm) {
        read.has_arm = read.has_arm || csv.find(column.name);
    }
    std::vector<SetpointColumn> columns = table.vehicle;
    if (read.has_arm) {
        columns.insert(columns.end(), table.arm.begin(), table.arm.end());
    }
    const std::vector<std::size_t> places = find_columns(csv, columns);
    errors.throw_any();
    std::vector<std::size_t> lines;
    while (csv.next()) {
        Setpoint point;
        point.joints.resize(read.has_arm ? joints.size() : 0);
        point.t_s = csv.number(time).value_or(0) * unit_s;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            columns[i].number(point) = csv.number(places[i]).value_or(0);
        }
        read.points.push_back(std::move(point));
        lines.push_back(csv.line());
    }
    errors.throw_any();
    read.add = [lines = std::move(lines)](LineErrors& to, std::size_t point, const std::string& message) {
        to.add(lines[point], message);
    };
    require_rising_times(read, file);
    return read;
}

SetpointFile read_setpoint_file(std::string_view text, const std::string& file, const std::vector<JointInWorld>& joints,
                                bool turns) {
    const std::string_view begin = trimmed(text.substr(0, 1000));
    SetpointFile read = is_mavlink_log(text)     ? read_mavlink_log(text, file)
                        : begin.starts_with('{') ? read_setpoint_messages(text, file, joints)
                                                 : read_setpoint_table(text, file, joints, turns);
    const double first_s = read.points.front().t_s;
    for (Setpoint& point : read.points) {
        point.t_s -= first_s;
    }
    return read;
}

}  // namespace downwash
