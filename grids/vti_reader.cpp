#include <algorithm>
#include <array>
#include <cmath>

#include "downwash/base/key_error.hpp"
#include "downwash/base/lane_math.hpp"
#include "downwash/base/text.hpp"
#include "downwash/grids/grid_formats.hpp"
#include "downwash/grids/vtk_file.hpp"

namespace downwash {
namespace {

/// Reads the grid out of the file.
class VtiReader {
 public:
    VtiReader(const VtkFile& file, const GridReading& reading) : file_(file), reading_(reading) {}

    FactorGridParts read() {
        image_ = only_child(file_.root(), "ImageData");
        piece_ = only_child(image_, "Piece");
        read_extent();
        read_placement();
        read_field_data();
        read_fields();
        return std::move(parts_);
    }

 private:
    template <std::size_t N>
    using Numbers = std::array<double, N>;

    [[nodiscard]] pugi::xml_node only_child(pugi::xml_node parent, const char* name) const {
        const pugi::xml_node child = parent.child(name);
        if (!child) {
            file_.fail(parent, std::string("<") + parent.name() + "> holds no <" + name + ">");
        }
        if (const pugi::xml_node second = child.next_sibling(name)) {
            file_.fail(second, std::string("a second <") + name + ">: expected one; merge them before");
        }
        return child;
    }

    template <std::size_t N>
    Numbers<N> attribute(pugi::xml_node node, const char* name, const Numbers<N>* otherwise = nullptr) const {
        const pugi::xml_attribute found = node.attribute(name);
        if (!found && otherwise != nullptr) {
            return *otherwise;
        }
        Numbers<N> numbers{};
        std::string_view rest = found.value();
        bool is_sound = true;
        for (double& number : numbers) {
            const auto value = parse_number<double>(take_word(rest));
            is_sound = is_sound && value && std::abs(*value) <= 1e15;
            number = value.value_or(0);
        }
        if (!is_sound || !trimmed(rest).empty()) {
            file_.fail(node, std::string(name) + "=\"" + excerpt(found.value()) + "\": expected " + std::to_string(N) +
                                 " finite numbers");
        }
        return numbers;
    }

    void read_extent() {
        extent_ = attribute<6>(image_, "WholeExtent");
        if (attribute<6>(piece_, "Extent") != extent_) {
            file_.fail(piece_, "the piece has another Extent than the image's WholeExtent: expected one whole piece");
        }
        double nodes = 1;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = extent_[2 * axis];
            const double high = extent_[2 * axis + 1];
            const double min_high = axis == 1 ? low : low + 1;
            if (low != std::floor(low) || high != std::floor(high) || high < min_high || std::abs(low) > 1e9 ||
                std::abs(high) > 1e9) {
                file_.fail(image_, std::string("WholeExtent runs from ") + to_text(low) + " to " + to_text(high) +
                                       " along " + "xyz"[axis] +
                                       ": expected whole numbers, at least two nodes along "
                                       "x and z and one along y");
            }
            count_[axis] = static_cast<std::size_t>(high - low) + 1;
            nodes *= high - low + 1;
        }
        if (nodes > static_cast<double>(max_grid_nodes)) {
            file_.fail(image_, "the grid has " + to_text(nodes) +
                                   " nodes: expected at most 2^24, a larger step or a smaller extent");
        }
    }

    /// Where the nodes stand: the frame lies in the first node.
    void read_placement() {
        constexpr Numbers<3> no_origin{0, 0, 0};
        constexpr Numbers<3> unit_spacing{1, 1, 1};
        constexpr Numbers<9> no_turn{1, 0, 0, 0, 1, 0, 0, 0, 1};
        const auto origin_m = attribute<3>(image_, "Origin", &no_origin);
        spacing_m_ = attribute<3>(image_, "Spacing", &unit_spacing);
        const auto d = attribute<9>(image_, "Direction", &no_turn);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (!(spacing_m_[axis] > 0) && count_[axis] > 1) {
                file_.fail(image_, "Spacing is " + to_text(spacing_m_[axis]) + " along " + "xyz"[axis] +
                                       ": expected more than 0 m");
            }
        }
        constexpr double slack = 1e-6;
        const bool turns_about_z = std::abs(d[2]) <= slack && std::abs(d[5]) <= slack && std::abs(d[6]) <= slack &&
                                   std::abs(d[7]) <= slack && std::abs(d[8] - 1) <= slack &&
                                   std::abs(d[0] - d[4]) <= slack && std::abs(d[1] + d[3]) <= slack &&
                                   std::abs(d[0] * d[0] + d[3] * d[3] - 1) <= slack;
        if (!turns_about_z) {
            file_.fail(image_, "Direction=\"" + excerpt(image_.attribute("Direction").value()) +
                                   "\": expected a rotation about the vertical, c -s 0 s c 0 0 0 1");
        }
        const Numbers<3> steps_m{extent_[0] * spacing_m_[0], extent_[2] * spacing_m_[1], extent_[4] * spacing_m_[2]};
        const Vector3 first_m{origin_m[0] + d[0] * steps_m[0] + d[1] * steps_m[1],
                              origin_m[1] + d[3] * steps_m[0] + d[4] * steps_m[1], origin_m[2] + steps_m[2]};
        parts_.frame = PlaneOfMotion(first_m, lane::atan2(d[3], d[0]));
        const auto axis = [&](std::size_t i) {
            return count_[i] == 1 ? GridAxis{}
                                  : GridAxis{0, spacing_m_[i] * static_cast<double>(count_[i] - 1), count_[i]};
        };
        parts_.x = axis(0);
        parts_.y = axis(1);
        parts_.z = axis(2);
    }

    void read_field_data() {
        const VtkFile::Arrays field_data = file_.arrays_in(image_.child("FieldData"));
        if (const pugi::xml_node array = find(field_data, "lateral_offsets_m")) {
            const double tuples = attribute<1>(array, "NumberOfTuples")[0];
            if (!(tuples >= 1 && tuples <= 4096 && tuples == std::floor(tuples))) {
                file_.fail(array, "NumberOfTuples is " + to_text(tuples) + ": expected 1 to 4096 lateral offsets");
            }
            parts_.lateral_offsets_m = file_.numbers(array, static_cast<std::size_t>(tuples));
        }
        if (const pugi::xml_node array = find(field_data, "provenance")) {
            for (const std::string& text : file_.texts(array)) {
                parts_.provenance.push_back(provenance_entry(text));
            }
        }
        read_frame(field_data);
    }

    /// Where our own files say so the frame is the one that was written, to the bit. Another program may have cut or
    /// moved the grid since: then the placement of the nodes counts.
    void read_frame(const VtkFile::Arrays& field_data) {
        const pugi::xml_node origin = find(field_data, "frame_origin_m");
        const pugi::xml_node heading = find(field_data, "frame_heading_rad");
        const pugi::xml_node low = find(field_data, "frame_low_m");
        const pugi::xml_node high = find(field_data, "frame_high_m");
        if (!origin || !heading || !low || !high) {
            return;
        }
        const std::vector<double> origin_m = file_.numbers(origin, 3);
        const std::vector<double> low_m = file_.numbers(low, 3);
        const std::vector<double> high_m = file_.numbers(high, 3);
        const double heading_rad = file_.numbers(heading, 1)[0];
        if (!(std::abs(heading_rad) <= 1e4)) {
            return;
        }
        const PlaneOfMotion frame({origin_m[0], origin_m[1], origin_m[2]}, heading_rad);
        const std::array<GridAxis, 3> axes{GridAxis{low_m[0], high_m[0], count_[0]},
                                           GridAxis{low_m[1], high_m[1], count_[1]},
                                           GridAxis{low_m[2], high_m[2], count_[2]}};
        const auto is_near = [](double a, double b) { return std::abs(a - b) <= 1e-6; };
        const Vector3 first_m = frame.to_world(low_m[0], low_m[1], low_m[2]);
        const Vector3& expected_m = parts_.frame.origin_m();
        bool agrees = is_near(frame.cos_heading(), parts_.frame.cos_heading()) &&
                      is_near(frame.sin_heading(), parts_.frame.sin_heading());
        for (std::size_t i = 0; i < 3; ++i) {
            agrees = agrees && is_near(first_m[i], expected_m[i]) &&
                     (count_[i] == 1 || is_near(axes[i].step_m() / spacing_m_[i], 1));
        }
        if (agrees) {
            parts_.frame = frame;
            parts_.x = axes[0];
            parts_.y = axes[1];
            parts_.z = axes[2];
        }
    }

    void read_fields() {
        point_data_ = file_.arrays_in(piece_.child("PointData"));
        for (const std::string_view name : grid_field_names()) {
            const std::string stem(name == "factor" ? std::string_view(reading_.array) : name);
            std::vector<double> values = layers_of(stem, name == "factor");
            if (!values.empty()) {
                parts_.fields.push_back({std::string(name), std::move(values)});
            }
        }
    }

    /// The values of one field in all layers; empty when it is not there and not needed.
    std::vector<double> layers_of(const std::string& stem, bool is_needed) {
        const std::size_t layer_nodes = count_[0] * count_[1] * count_[2];
        const std::size_t layers = std::max<std::size_t>(1, parts_.lateral_offsets_m.size());
        if (layers * layer_nodes > max_grid_nodes) {
            file_.fail(image_, "the grid has more than 2^24 nodes in its " + std::to_string(layers) +
                                   " layers: expected a larger step, a smaller extent or fewer layers");
        }
        std::vector<double> values;
        for (std::size_t layer = 0; layer < layers; ++layer) {
            const std::string name = parts_.lateral_offsets_m.empty() ? stem : stem + "_" + std::to_string(layer + 1);
            const pugi::xml_node array = find(point_data_, name);
            if (!array) {
                if (!is_needed && layer == 0) {
                    return {};
                }
                fail_missing(name);
            }
            const std::vector<double> layer_values = file_.numbers(array, layer_nodes);
            values.insert(values.end(), layer_values.begin(), layer_values.end());
        }
        return values;
    }

    /// The array of that name, or none.
    static pugi::xml_node find(const VtkFile::Arrays& arrays, std::string_view name) {
        const auto found = arrays.find(name);
        return found == arrays.end() ? pugi::xml_node() : found->second;
    }

    [[noreturn]] void fail_missing(const std::string& name) const {
        if (find(file_.arrays_in(piece_.child("CellData")), name)) {
            file_.fail(piece_, "'" + excerpt(name) +
                                   "' is CellData: expected PointData (ParaView's filter Cell Data to Point Data "
                                   "makes it so)");
        }
        std::string present;
        for (const auto& [other, array] : point_data_) {
            if (present.size() < 200) {
                present += (present.empty() ? "" : ", ") + excerpt(other);
            }
        }
        file_.fail(piece_, "PointData holds no array '" + excerpt(name) + "'; it holds " +
                               (present.empty() ? "none" : present));
    }

    const VtkFile& file_;
    const GridReading& reading_;
    pugi::xml_node image_, piece_;
    VtkFile::Arrays point_data_;
    Numbers<6> extent_{};
    Numbers<3> spacing_m_{};
    std::array<std::size_t, 3> count_{};
    FactorGridParts parts_;
};

}  // namespace

FactorGrid parse_vti(std::string_view bytes, const std::string& name, const GridReading& reading) {
    const VtkFile file(bytes, name);
    FactorGridParts parts = VtiReader(file, reading).read();
    try {
        return FactorGrid(std::move(parts));
    } catch (const InputError& invalid) {
        std::vector<KeyError> errors = invalid.errors();
        for (KeyError& error : errors) {
            error = {"", name + ": " + error.key + (error.key.empty() ? "" : " ") + error.message};
        }
        throw InputError(std::move(errors));
    }
}

}  // namespace downwash
