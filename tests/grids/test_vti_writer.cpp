#include <catch2/catch.hpp>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "../support/base64_bytes.hpp"
#include "downwash/base/byte_order.hpp"
#include "downwash/grids/factor_grid_file.hpp"
#include "grids.hpp"

using namespace downwash;

namespace {

/// A written file, taken apart as "VTK XML formats" of the VTK User's Guide describes it.
class Written {
 public:
    explicit Written(const FactorGrid& grid) : text_(vti_text(grid)) {
        REQUIRE(document_.load_buffer(text_.data(), text_.size()));
        REQUIRE(image().parent().attribute("type").as_string() == std::string("ImageData"));
    }

    [[nodiscard]] pugi::xml_node image() const { return document_.child("VTKFile").child("ImageData"); }
    [[nodiscard]] std::vector<double> numbers(const char* attribute) const {
        return in_text(image().attribute(attribute).as_string());
    }
    [[nodiscard]] std::vector<double> field_numbers(const char* name) const {
        return in_text(image().child("FieldData").find_child_by_attribute("Name", name).text().as_string());
    }
    /// The arrays at the points, by name: each is a count of bytes and its numbers, in base64 at its offset.
    [[nodiscard]] std::map<std::string, std::vector<double>> arrays() const {
        const std::string appended = document_.child("VTKFile").child("AppendedData").text().as_string();
        const std::string data = appended.substr(appended.find('_') + 1);
        std::map<std::string, std::vector<double>> all;
        for (const pugi::xml_node& array : image().child("Piece").child("PointData")) {
            const std::size_t begin = array.attribute("offset").as_ullong();
            const std::size_t size =
                number_at<std::uint64_t>(test::base64_bytes(data.substr(begin, 12)).value().data());
            const std::string bytes = test::base64_bytes(data.substr(begin, base64_letters(size + 8))).value();
            auto& values = all[array.attribute("Name").as_string()];
            for (std::size_t at = 8; at < bytes.size(); at += 8) {
                values.push_back(number_at<double>(bytes.data() + at));
            }
        }
        return all;
    }

 private:
    static std::vector<double> in_text(const std::string& text) {
        std::istringstream words(text);
        return {std::istream_iterator<double>(words), {}};
    }

    std::string text_;
    pugi::xml_document document_;
};

}  // namespace

TEST_CASE("a planar grid is written as an image in the world, a layer an array") {
    const FactorGrid grid = test::layered();
    const Written written(grid);
    // x of the grid is -0.1 to 0.2 m along the heading 0.3 rad from (3, -4, 0.1).
    CHECK(written.numbers("WholeExtent") == std::vector<double>{0, 1, 0, 0, 0, 1});
    const double c = std::cos(0.3);
    const double s = std::sin(0.3);
    const auto is_near = [](const std::vector<double>& a, const std::vector<double>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](double left, double right) { return std::abs(left - right) < 1e-15; });
    };
    CHECK(is_near(written.numbers("Origin"), {3 - 0.1 * c, -4 - 0.1 * s, 0.1}));
    CHECK(is_near(written.numbers("Spacing"), {0.2 + 0.1, 0.2 + 0.1, 2}));
    CHECK(is_near(written.numbers("Direction"), {c, -s, 0, s, c, 0, 0, 0, 1}));
    CHECK(written.field_numbers("lateral_offsets_m") == grid.lateral_offsets_m());
    CHECK(written.field_numbers("frame_heading_rad") == std::vector<double>{0.3});
    CHECK(written.arrays() == std::map<std::string, std::vector<double>>{{"factor_1", {1, 1.1, 1.2, 1.3}},
                                                                         {"factor_2", {2.1, 2.2, 2.3, 2.4}},
                                                                         {"flyable_1", {1, 1, 0, 0}},
                                                                         {"flyable_2", {1, 1, 1, 1}}});
    std::string provenance;
    for (const double letter : written.field_numbers("provenance")) {
        provenance += letter == 0 ? '\n' : static_cast<char>(letter);
    }
    CHECK(provenance == "program: downwash 0.1.0\nnote: caf\xc3\xa9: <&>\n");
}

TEST_CASE("every number of a grid stands in the image to the bit") {
    test::Random random(11);
    for (int i = 0; i < 100; ++i) {
        const FactorGrid grid = test::any_grid(random);
        const auto arrays = Written(grid).arrays();
        const std::size_t layer_nodes = grid.nodes() / grid.layers();
        REQUIRE(arrays.size() == grid.fields().size() * grid.layers());
        for (const GridField& field : grid.fields()) {
            std::vector<double> values;
            for (std::size_t layer = 1; layer <= grid.layers(); ++layer) {
                const auto& of_layer =
                    arrays.at(field.name + (grid.lateral_offsets_m().empty() ? "" : "_" + std::to_string(layer)));
                REQUIRE(of_layer.size() == layer_nodes);
                values.insert(values.end(), of_layer.begin(), of_layer.end());
            }
            REQUIRE(values == field.values);
        }
    }
}
