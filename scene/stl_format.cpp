#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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

/// The beginning of a file without byte order mark and blanks, as far as the name of a binary one would reach.
std::string_view beginning_of(std::string_view bytes) {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    const std::string_view content = trimmed(bytes.substr(bytes.starts_with(mark) ? mark.size() : 0));
    return content.substr(0, triangles_at + triangle_bytes);
}

bool begins_with_solid(std::string_view text) {
    return is_same_word(text.substr(0, 5), "solid");
}

/// Whether a file that is not binary by its size is meant as text.
bool is_text(std::string_view bytes) {
    const std::string_view begin = beginning_of(bytes);
    return (begins_with_solid(begin) || is_same_word(begin.substr(0, 6), "facet ")) &&
           begin.find('\0') == std::string_view::npos;
}

/// Whether a file is UTF-16 text.
bool is_utf16(std::string_view bytes) {
    std::string without_zeros(bytes.substr(0, triangles_at));
    std::erase(without_zeros, '\0');
    return has_utf16_mark(bytes) ||
           (bytes.substr(0, 2).find('\0') != std::string_view::npos && begins_with_solid(trimmed(without_zeros)));
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

bool is_coordinate(double number) {
    return std::abs(number) <= max_coordinate;
}

double number_in(std::string_view bytes, std::size_t at) {
    return static_cast<double>(number_at<float>(bytes.data() + at));
}

double read_coordinate(std::string_view bytes, std::size_t at, const std::string& name) {
    const double number = number_in(bytes, at);
    if (!is_coordinate(number)) {
        fail_at(name, at,
                "found " + to_text(number, 6) +
                    ", expected a finite number of at most 1e10 in size, "
                    "little-endian");
    }
    return number;
}

Vector3 read_vector(std::string_view bytes, std::size_t at, const std::string& name) {
    return {read_coordinate(bytes, at, name), read_coordinate(bytes, at + 4, name),
            read_coordinate(bytes, at + 8, name)};
}

/// Whether bytes may be triangles of their own: whole ones, with corners that are places and not all zero.
bool may_be_triangles(std::string_view bytes) {
    if (bytes.empty() || bytes.size() % triangle_bytes != 0 || is_padding(bytes)) {
        return false;
    }
    for (std::size_t at = 0; at < bytes.size(); at += triangle_bytes) {
        for (std::size_t i = 3; i < 12; ++i) {
            if (!is_coordinate(number_in(bytes, at + 4 * i))) {
                return false;
            }
        }
    }
    return true;
}

/// How many triangles a binary file has. A count of 0 or 4294967295 is that of a writer that could not go back to it:
/// the size tells.
/// @throws InputError when neither the size nor the stated count can be right
std::size_t binary_count(std::string_view bytes, const std::string& name) {
    if (bytes.size() < triangles_at) {
        fail_for_size(bytes, name);
    }
    const std::uint32_t stated = count_in(bytes);
    const std::string_view rest = bytes.substr(triangles_at);
    if (stated == 0 || stated == std::numeric_limits<std::uint32_t>::max()) {
        if (rest.size() % triangle_bytes != 0) {
            fail_for_size(bytes, name);
        }
        return rest.size() / triangle_bytes;
    }
    if (bytes.size() < size_of(stated)) {
        fail_for_size(bytes, name);
    }
    const std::string_view surplus = bytes.substr(static_cast<std::size_t>(size_of(stated)));
    if (is_binary(surplus) || may_be_triangles(surplus)) {
        fail_for_size(bytes, name);
    }
    return stated;
}

TriangleMesh parse_binary(std::string_view bytes, const std::string& name) {
    const std::size_t count = binary_count(bytes, name);
    if (count > max_pieces) {
        fail_at(name, count_at,
                "has " + std::to_string(count) + " triangles: expected at most " + std::to_string(max_pieces));
    }
    TriangleMesh mesh;
    mesh.vertices_m.reserve(3 * count);
    mesh.triangles.reserve(count);
    const std::size_t end = triangles_at + triangle_bytes * count;
    for (std::size_t at = triangles_at; at < end; at += triangle_bytes) {  // behind a normal that nobody uses
        add_triangle(mesh, {read_vector(bytes, at + 12, name), read_vector(bytes, at + 24, name),
                            read_vector(bytes, at + 36, name)});
    }
    if (end < bytes.size()) {
        mesh.remarks.push_back("byte " + std::to_string(end) + ": the last " + std::to_string(bytes.size() - end) +
                               " bytes are behind the last triangle and are ignored");
    }
    return mesh;
}

/// Reads one line after another, each of which has to be a certain one.
class AsciiStl {
 public:
    AsciiStl(std::string_view text, const std::string& name) : lines_(text, name) {}

    TriangleMesh read() {
        for (bool is_first = true; lines_.next(); is_first = false) {
            expect(!is_first || lines_.starts_with("solid"), "solid");
            expect_several_lines();
            if (!lines_.starts_with("solid")) {
                pass_over();
                continue;
            }
            do {
                if (!lines_.next()) {
                    mesh_.remarks.push_back("line " + std::to_string(lines_.number()) +
                                            ": the file ends without 'endsolid', and may be cut off");
                    return std::move(mesh_);
                }
            } while (read_facet());
            expect(is_end_of("solid"), "facet' or 'endsolid");
        }
        return std::move(mesh_);
    }

 private:
    /// Passes over what stands behind a solid, unless it would belong into one.
    void pass_over() {
        for (const char* word : {"facet", "outer", "vertex", "endloop", "endfacet", "endsolid", "end"}) {
            expect(!lines_.starts_with(word), "solid");
        }
        if (!is_told_of_rest_) {
            mesh_.remarks.push_back("line " + std::to_string(lines_.number()) + ": found '" +
                                    excerpt(lines_.words()[0]) + "' behind 'endsolid', which is ignored");
            is_told_of_rest_ = true;
        }
    }

    /// A line that begins a solid ends behind its name.
    void expect_several_lines() const {
        const auto& words = lines_.words();
        const auto is_vertex = [](std::string_view word) { return is_same_word(word, "vertex"); };
        if (std::any_of(words.begin() + 1, words.end(), is_vertex)) {
            lines_.fail(
                "holds a solid with its vertices: expected each of 'solid', 'facet', 'outer loop', 'vertex', "
                "'endloop', 'endfacet' and 'endsolid' at the beginning of a line");
        }
    }

    /// @return whether the current line begins a facet
    bool read_facet() {
        if (!lines_.starts_with("facet")) {
            return false;
        }
        if (mesh_.triangles.size() >= max_pieces) {
            lines_.fail("too many triangles: expected at most " + std::to_string(max_pieces));
        }
        // The rest of the line is a normal that nobody uses.
        move_on("outer loop");
        expect_words({"outer", "loop"}, 0);
        std::array<Vector3, 3> corners{};
        for (Vector3& corner : corners) {
            move_on("vertex");
            expect_words({"vertex"}, 3);
            const auto& words = lines_.words();
            corner = {lines_.coordinate(words[1]), lines_.coordinate(words[2]), lines_.coordinate(words[3])};
        }
        move_on("endloop");
        expect(is_end_of("loop"), "endloop");
        move_on("endfacet");
        expect(is_end_of("facet"), "endfacet");
        add_triangle(mesh_, corners);
        return true;
    }

    void move_on(const std::string& expected) {
        if (!lines_.next()) {
            lines_.fail("the file ends here: expected '" + expected + "'");
        }
    }

    /// Whether the current line ends a thing: "endloop" or "end loop". What follows "endsolid" is a name.
    [[nodiscard]] bool is_end_of(const std::string& thing) const {
        const auto& words = lines_.words();
        const bool is_one_word = is_same_word(words[0], "end" + thing);
        const std::size_t used = is_one_word ? 1 : 2;
        return (is_one_word || (words.size() > 1 && is_same_word(words[0], "end") && is_same_word(words[1], thing))) &&
               (thing == "solid" || words.size() == used);
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

    Lines lines_;
    TriangleMesh mesh_;
    bool is_told_of_rest_ = false;
};

}  // namespace

TriangleMesh parse_stl(std::string_view bytes, const std::string& name) {
    if (is_binary(bytes)) {
        return parse_binary(bytes, name);
    }
    if (is_utf16(bytes)) {
        fail_for_utf16(name);
    }
    if (is_text(bytes)) {
        return AsciiStl(text_of(bytes, name), name).read();
    }
    return parse_binary(bytes, name);
}

}  // namespace downwash::foreign
