#include <cmath>
#include <cstddef>
#include <cstdint>

#include "downwash/base/byte_order.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/foreign_file.hpp"

namespace downwash::foreign {
namespace {

// Binary: 80 bytes of anything, the count of triangles, and for each a normal, three vertices and two more bytes.
constexpr std::size_t count_at = 80;
constexpr std::size_t triangles_at = 84;
constexpr std::size_t triangle_bytes = 50;

void add_triangle(TriangleMesh& mesh, const std::array<Vector3, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices_m.size());
    mesh.vertices_m.insert(mesh.vertices_m.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
}

std::uint32_t count_in(std::string_view bytes, bool is_big_endian = false) {
    return number_at<std::uint32_t>(bytes.data() + count_at, is_big_endian);
}

/// In 64 bits no count overflows.
std::uint64_t size_of(std::uint32_t triangles) {
    return triangles_at + std::uint64_t{triangle_bytes} * triangles;
}

bool is_binary(std::string_view bytes) {
    return bytes.size() >= triangles_at && bytes.size() == size_of(count_in(bytes));
}

/// Whether a file that is not binary by its size is meant as text.
bool is_text(std::string_view bytes) {
    const std::string_view begin = bytes.substr(0, triangles_at + triangle_bytes);
    return is_same_word(begin.substr(0, 5), "solid") && begin.find('\0') == std::string_view::npos;
}

[[noreturn]] void fail_for_size(std::string_view bytes, const std::string& name) {
    if (bytes.size() < triangles_at) {
        fail(name, "has " + std::to_string(bytes.size()) +
                       " bytes: expected 84 or more in binary, or a first line 'solid' in ASCII");
    }
    if (bytes.size() == size_of(count_in(bytes, true))) {
        fail_at(name, count_at, "the count of triangles is big-endian: expected little-endian numbers");
    }
    const std::uint32_t count = count_in(bytes);
    fail_at(name, count_at,
            "says " + std::to_string(count) + " triangles, expected 84 + 50 times as many bytes, " +
                std::to_string(size_of(count)) + ", found " + std::to_string(bytes.size()));
}

double read_coordinate(std::string_view bytes, std::size_t at, const std::string& name) {
    const auto number = static_cast<double>(number_at<float>(bytes.data() + at));
    if (!(std::abs(number) <= max_coordinate)) {
        fail_at(name, at,
                "found " + to_text(number, 6) +
                    ", expected a finite number of at most 1e6 in size, "
                    "little-endian");
    }
    return number;
}

Vector3 read_vector(std::string_view bytes, std::size_t at, const std::string& name) {
    return {read_coordinate(bytes, at, name), read_coordinate(bytes, at + 4, name),
            read_coordinate(bytes, at + 8, name)};
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name) {
    const std::size_t count = count_in(bytes);
    if (count > max_pieces) {
        fail_at(name, count_at,
                "has " + std::to_string(count) + " triangles: expected at most " + std::to_string(max_pieces));
    }
    TriangleMesh mesh;
    mesh.vertices_m.reserve(3 * count);
    mesh.triangles.reserve(count);
    for (std::size_t at = triangles_at; at < bytes.size(); at += triangle_bytes) {
        static_cast<void>(read_vector(bytes, at, name));  // the normal: only checked
        add_triangle(mesh, {read_vector(bytes, at + 12, name), read_vector(bytes, at + 24, name),
                            read_vector(bytes, at + 36, name)});
    }
    return mesh;
}

/// Reads one line after another, each of which has to be a certain one.
class AsciiStl {
 public:
    AsciiStl(std::string_view text, const std::string& name) : lines_(text, name) {}

    TriangleMesh read() {
        while (lines_.next()) {
            expect(lines_.starts_with("solid"), "solid");
            for (move_on("endsolid"); lines_.starts_with("facet"); move_on("endsolid")) {
                read_facet();
            }
            expect(lines_.starts_with("endsolid"), "facet' or 'endsolid");
        }
        return std::move(mesh_);
    }

 private:
    void read_facet() {
        if (mesh_.triangles.size() >= max_pieces) {
            lines_.fail("too many triangles: expected at most " + std::to_string(max_pieces));
        }
        expect_words({"facet", "normal"}, 3);
        static_cast<void>(numbers(2));  // the normal: only checked
        move_on("outer loop");
        expect_words({"outer", "loop"}, 0);
        std::array<Vector3, 3> corners{};
        for (Vector3& corner : corners) {
            move_on("vertex");
            expect_words({"vertex"}, 3);
            corner = numbers(1);
        }
        move_on("endloop");
        expect_words({"endloop"}, 0);
        move_on("endfacet");
        expect_words({"endfacet"}, 0);
        add_triangle(mesh_, corners);
    }

    void move_on(const std::string& expected) {
        if (!lines_.next()) {
            lines_.fail("the file ends here: expected '" + expected + "'");
        }
    }

    void expect(bool holds, const std::string& expected) const {
        if (!holds) {
            lines_.fail("found '" + excerpt(lines_.words()[0]) + "', expected '" + expected + "'");
        }
    }

    void expect_words(const std::vector<std::string_view>& expected, std::size_t numbers) const {
        const auto& words = lines_.words();
        std::string text;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            text += (i > 0 ? " " : "") + std::string(expected[i]);
        }
        for (std::size_t i = 0; i < expected.size(); ++i) {
            expect(i < words.size() && is_same_word(words[i], expected[i]), text);
        }
        if (words.size() != expected.size() + numbers) {
            lines_.fail("found " + std::to_string(words.size() - expected.size()) + " words after '" + text +
                        "', expected " + std::to_string(numbers) + (numbers > 0 ? " numbers" : ""));
        }
    }

    [[nodiscard]] Vector3 numbers(std::size_t first) const {
        const auto& words = lines_.words();
        return {lines_.coordinate(words[first]), lines_.coordinate(words[first + 1]),
                lines_.coordinate(words[first + 2])};
    }

    Lines lines_;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name) {
    if (is_binary(bytes)) {
        return parse_binary(bytes, name);
    }
    if (is_text(bytes)) {
        return AsciiStl(bytes, name).read();
    }
    fail_for_size(bytes, name);
}

}  // namespace downwash::foreign
