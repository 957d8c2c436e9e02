#include "downwash/logs/rosbag_reader.hpp"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"
#include "downwash/logs/candidate_series.hpp"
#include "downwash/logs/ros_message.hpp"

namespace downwash::logs {
namespace {

constexpr std::string_view magic = "#ROSBAG V2.0\n";
constexpr std::size_t length_bytes = 4;
constexpr std::size_t max_header_bytes = std::size_t{1} << 20U;
constexpr std::size_t max_bag_message_bytes = std::size_t{64} << 20U;
constexpr std::size_t max_connections = 10'000;

/// Kinds of records.
enum : unsigned { message_data = 2, bag_header = 3, index_data = 4, chunk = 5, chunk_info = 6, connection = 7 };

using Fields = std::map<std::string, std::string, std::less<>>;

/// A topic of a bag, and what is taken from it.
struct Topic {
    std::string name, type;
};

class Bag {
 public:
    Bag(LogBytes& bytes, const LogOptions& options) : bytes_(bytes), options_(options) {}

    FlightLog read() {
        if (bytes_.peek(magic.size()) != magic) {
            fail("is no bag of ROS 1: expected #ROSBAG V2.0; a bag of ROS 2 can be read once it is a table");
        }
        bytes_.skip(magic.size());
        while (read_record()) {
        }
        log_.files = {bytes_.name()};
        log_.format = LogFormat::rosbag;
        log_.recorded_axes = options_.axes.value_or(LogAxes::up);
        log_.axes_source = options_.axes ? AxesSource::declared : AxesSource::format;
        choose(candidates_, log_);
        for (const std::string& topic : options_.topics) {
            if (!read_topics_.contains(topic)) {
                fail("there is no topic '" + excerpt(topic) + "' in this bag that says something of a flight");
            }
        }
        if (!skipped_topics_.empty()) {
            log_.remarks.push_back("the first topic of each kind is read, not " +
                                   excerpt(joined(skipped_topics_, ", ")) + "; --topic says which");
        }
        return std::move(log_);
    }

 private:
    [[noreturn]] void fail(const std::string& message) const { bytes_.fail_at(record_at_, message); }

    /// False at the end, and where a log that may be truncated ends.
    bool has(std::uint64_t count) {
        if (count <= bytes_.left()) {
            return true;
        }
        const std::string text = "the log ends within a record";
        if (!options_.allows_truncation) {
            fail(text + "; --allow-truncated reads it up to there");
        }
        log_.remarks.push_back("byte " + std::to_string(record_at_) + ": " + text + ", which is left out");
        return false;
    }

    bool read_record() {
        record_at_ = bytes_.offset();
        if (bytes_.left() == 0 || !has(length_bytes)) {
            return false;
        }
        const std::size_t header_bytes = number_at<std::uint32_t>(bytes_.peek(length_bytes).data());
        if (header_bytes > max_header_bytes) {
            fail("the header of a record has " + std::to_string(header_bytes) + " bytes: expected less than 1 MiB");
        }
        if (!has(length_bytes + header_bytes + length_bytes)) {
            return false;
        }
        const std::string_view head = bytes_.peek(length_bytes + header_bytes + length_bytes);
        const Fields fields = fields_of(head.substr(length_bytes, header_bytes));
        const std::uint64_t data_bytes = number_at<std::uint32_t>(head.data() + length_bytes + header_bytes);
        const std::uint64_t whole_bytes = head.size() + data_bytes;
        const auto op = fields.find("op");
        if (op == fields.end() || op->second.size() != 1) {
            fail("a record does not say what it is: its header has no op");
        }
        const auto kind = static_cast<unsigned char>(op->second[0]);
        if (kind == chunk) {
            enter_chunk(fields, head.size(), data_bytes);
            return true;
        }
        if (!has(whole_bytes)) {
            return false;
        }
        if (record_at_ < chunk_end_ && record_at_ + whole_bytes > chunk_end_) {
            fail("a record goes on behind the end of its chunk at byte " + std::to_string(chunk_end_));
        }
        if (kind == connection) {
            add_connection(fields, data_bytes, head.size());
        } else if (kind == message_data) {
            take_message(fields, data_bytes, head.size());
        } else if (kind != bag_header && kind != index_data && kind != chunk_info) {
            fail("a record has the unknown op " + std::to_string(kind));
        }
        bytes_.skip(whole_bytes);
        return true;
    }

    Fields fields_of(std::string_view bytes) const {
        Fields fields;
        while (!bytes.empty()) {
            const std::size_t size =
                bytes.size() < length_bytes ? bytes.size() : number_at<std::uint32_t>(bytes.data());
            if (bytes.size() < length_bytes || size > bytes.size() - length_bytes) {
                fail("a field of a header is longer than the header");
            }
            const std::string_view field = bytes.substr(length_bytes, size);
            const std::size_t equals = field.find('=');
            if (equals == std::string_view::npos) {
                fail("a field of a header has no name: '" + excerpt(field) + "'");
            }
            fields[std::string(field.substr(0, equals))] = field.substr(equals + 1);
            bytes.remove_prefix(length_bytes + size);
        }
        return fields;
    }

    /// The records within a chunk are read as those around it.
    void enter_chunk(const Fields& fields, std::size_t head_bytes, std::uint64_t data_bytes) {
        const auto compression = fields.find("compression");
        if (compression == fields.end() || compression->second != "none") {
            fail("the chunk is compressed" +
                 (compression == fields.end() ? std::string() : " by " + excerpt(compression->second)) +
                 ": `rosbag decompress` makes a bag that can be read");
        }
        if (record_at_ < chunk_end_) {
            fail("a chunk begins within a chunk");
        }
        chunk_end_ = record_at_ + head_bytes + data_bytes;
        bytes_.skip(head_bytes);
    }

    std::uint32_t number_in(const Fields& fields, std::string_view name) const {
        const auto field = fields.find(name);
        if (field == fields.end() || field->second.size() != sizeof(std::uint32_t)) {
            fail("the header of a record has no number " + std::string(name));
        }
        return number_at<std::uint32_t>(field->second.data());
    }

    void add_connection(const Fields& fields, std::uint64_t data_bytes, std::size_t head_bytes) {
        const std::uint32_t id = number_in(fields, "conn");
        if (connections_.contains(id)) {
            return;  // it stands in the chunk and at the end
        }
        if (data_bytes > max_header_bytes || connections_.size() == max_connections) {
            fail("the bag has a connection of " + std::to_string(data_bytes) + " bytes, or more than " +
                 std::to_string(max_connections) + " of them");
        }
        const auto size = static_cast<std::size_t>(data_bytes);
        const Fields about = fields_of(bytes_.peek(head_bytes + size).substr(head_bytes));
        const auto type = about.find("type");
        const auto topic = fields.find("topic");
        if (type == about.end() || topic == fields.end()) {
            fail("a connection names no topic or no type");
        }
        std::optional<Topic>& added = connections_[id];
        if (!is_of_a_flight(type->second)) {
            return;
        }
        const bool is_wanted =
            options_.topics.empty()
                ? first_of_type_.try_emplace(type->second, topic->second).first->second == topic->second
                : std::ranges::find(options_.topics, topic->second) != options_.topics.end();
        if (is_wanted) {
            added = {topic->second, type->second};
            read_topics_.insert(topic->second);
        } else if (options_.topics.empty()) {
            skipped_topics_.insert(topic->second);
        }
    }

    void take_message(const Fields& fields, std::uint64_t data_bytes, std::size_t head_bytes) {
        const std::uint32_t id = number_in(fields, "conn");
        const auto known = connections_.find(id);
        if (known == connections_.end()) {
            fail("a message is of the connection " + std::to_string(id) + ", which no record describes before");
        }
        const std::optional<Topic>& topic = known->second;
        if (!topic) {
            return;
        }
        if (data_bytes > max_bag_message_bytes) {
            fail("a message of " + excerpt(topic->name) + " has more than 64 MiB");
        }
        const auto size = static_cast<std::size_t>(data_bytes);
        RosMoment moment = read_ros_message(topic->type, bytes_.peek(head_bytes + size).substr(head_bytes));
        if (!moment.is_whole) {
            fail("a message of " + excerpt(topic->name) + " ends before its type " + topic->type + " does");
        }
        const double stamp_s = moment.stamp_s > 0 ? moment.stamp_s : record_time_s(fields);
        for (RosMoment::Row& row : moment.rows) {
            const bool is_setpoint =
                row.series == &FlightLog::position_m && topic->name.find("setpoint") != std::string::npos;
            CandidateSeries& into = candidate(is_setpoint ? &FlightLog::setpoint_m : row.series, *topic);
            if (into.series.width == 0) {
                into.series.width = row.numbers.size();
            }
            if (row.numbers.size() == into.series.width) {
                into.late_rows += into.series.add(stamp_s, row.numbers) ? 0 : 1;
            }
        }
    }

    double record_time_s(const Fields& fields) const {
        const auto time = fields.find("time");
        if (time == fields.end() || time->second.size() != 2 * sizeof(std::uint32_t)) {
            fail("the header of a message has no time");
        }
        return number_at<std::uint32_t>(time->second.data()) +
               1e-9 * number_at<std::uint32_t>(time->second.data() + sizeof(std::uint32_t));
    }

    CandidateSeries& candidate(LogSeries FlightLog::*what, const Topic& topic) {
        for (CandidateSeries& each : candidates_) {
            if (each.what == what && each.series.source == topic.name) {
                return each;
            }
        }
        CandidateSeries& added = candidates_.emplace_back();
        added.what = what;
        added.rank = rank_of(topic.type);
        added.rotor_unit = RotorUnit::share;
        added.series.source = topic.name;
        return added;
    }

    LogBytes& bytes_;
    const LogOptions& options_;
    FlightLog log_;
    std::uint64_t record_at_ = 0, chunk_end_ = 0;
    std::map<std::uint32_t, std::optional<Topic>> connections_;  ///< empty: of no interest
    std::map<std::string, std::string> first_of_type_;
    std::set<std::string, std::less<>> read_topics_, skipped_topics_;
    std::deque<CandidateSeries> candidates_;
};

}  // namespace

FlightLog read_rosbag(LogBytes& bytes, const LogOptions& options) {
    return Bag(bytes, options).read();
}

}  // namespace downwash::logs
