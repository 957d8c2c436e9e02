#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <limits>
#include <memory>

#include "../support/error_of.hpp"
#include "../support/mesh_bytes.hpp"
#include "../support/meshes.hpp"
#include "../support/random.hpp"
#include "../support/scratch_folder.hpp"
#include "downwash/base/files.hpp"
#include "downwash/base/text.hpp"
#include "downwash/scene/mesh_file.hpp"
#include "downwash/scene/mesh_welding.hpp"
#include "downwash/scene/scene.hpp"

using namespace downwash;
using namespace downwash::test;

namespace {

constexpr std::string_view ascii_triangle = R"(solid one
  facet normal 0 0 1
    outer loop
      vertex 0 0 0
      vertex 1 0 0
      vertex 0 1 2.5e0
    endloop
  endfacet
endsolid one
)";

std::string said_of(std::string_view bytes, const std::string& name) {
    return error_of([&] { return parse_mesh(bytes, name); });
}

std::string ascii_with(std::string_view from, std::string_view to) {
    std::string text(ascii_triangle);
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
    std::vector<Triangle> triangles;
    for (const auto& corners : mesh.triangles) {
        triangles.push_back(
            {mesh.vertices_m.at(corners[0]), mesh.vertices_m.at(corners[1]), mesh.vertices_m.at(corners[2])});
    }
    return triangles;
}

std::string words(const Vector3& v) {
    return " " + to_text(v[0]) + " " + to_text(v[1]) + " " + to_text(v[2]) + "\n";
}

std::string ascii_stl(const std::vector<Triangle>& triangles) {
    std::string text = "solid\n";
    for (const Triangle& t : triangles) {
        text += "facet normal 0 0 0\nouter loop\nvertex" + words(t[0]) + "vertex" + words(t[1]) + "vertex" +
                words(t[2]) + "endloop\nendfacet\n";
    }
    return text + "endsolid\n";
}

std::string obj(const std::vector<Triangle>& triangles) {
    std::string text;
    for (const Triangle& t : triangles) {
        text += "v" + words(t[0]) + "v" + words(t[1]) + "v" + words(t[2]) + "f -3 -2 -1\n";
    }
    return text;
}

}  // namespace

TEST_CASE("The same triangles come from binary STL, ASCII STL and OBJ") {
    Random random(1);
    std::vector<Triangle> triangles(50);
    for (Triangle& triangle : triangles) {
        for (Vector3& corner : triangle) {
            for (double& number : corner) {
                number = static_cast<float>(random.magnitude(-20, 6));
            }
        }
    }
    // Of corners that are nearer to each other than 1e-5 of the extent some join.
    const std::vector<Triangle> expected = triangles_of(with_joined_corners(*soup_of(triangles).surface));
    REQUIRE(std::count_if(expected.begin(), expected.end(), [&](const Triangle& t) {
                return std::find(triangles.begin(), triangles.end(), t) != triangles.end();
            }) > 20);
    CHECK(triangles_of(parse_mesh(binary_stl(triangles), "a.stl")) == expected);
    CHECK(triangles_of(parse_mesh(ascii_stl(triangles), "a.stl")) == expected);
    CHECK(triangles_of(parse_mesh(obj(triangles), "a.obj")) == expected);
    // A binary STL file is told by its size, even when it begins with solid.
    const auto box = box_triangles({0, 0, 0}, {1, 2, 3});
    CHECK(triangles_of(parse_mesh(binary_stl(box, "solid box"), "a.STL")) == box);
}

TEST_CASE(
    "ASCII STL may hold several solids, upper case and CRLF, OBJ texture, normals, polygons and corners counted back") {
    std::string text;
    for (const char c : std::string(ascii_triangle) + std::string(ascii_triangle)) {
        text += c == '\n' ? "\r\n" : std::string(1, static_cast<char>(std::toupper(c)));
    }
    const Triangle triangle{Vector3{0, 0, 0}, {1, 0, 0}, {0, 1, 2.5}};
    CHECK(triangles_of(parse_mesh(text, "a.stl")) == std::vector<Triangle>{triangle, triangle});
    const std::string polygons =
        "# a pentagon\nmtllib a.mtl\no part\nv 0 0 0\nv 1 0 0 1\nv 1 1 0 .5 .5 .5\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        "usemtl steel\ns off\nf 1/1 2//1 3/1/1 -1/-1/-1\nv 0 0 5\n  f +1 2 -1\n";
    const TriangleMesh mesh = parse_mesh(polygons, "a.obj");
    CHECK(mesh.vertices_m == std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 5}});
    CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 1, 4}});
}

TEST_CASE("A comment may end a line of OBJ") {
    const TriangleMesh mesh = parse_mesh("v 0 0 0 # corner \\\nv 1 0 0 #1\nv 0 1 0\nf 1 2 3 # all\n", "a.obj");
    CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}});
}

TEST_CASE("Wrong ASCII STL is an error with its line") {
    const auto [bytes, said] = GENERATE(table<std::string, std::string>({
        {"facet normal 0 0 1\nouter loop\n", "line 1: found 'facet', expected 'solid'"},
        {"solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet endsolid a\n",
         "line 1: holds a solid with its vertices: expected each of 'solid', 'facet', 'outer loop', 'vertex', "
         "'endloop', 'endfacet' and 'endsolid' at the beginning of a line"},
        {ascii_with("0 0 1\n    outer loop", "0 0 1 outer loop"), "line 3: found 'vertex', expected 'outer loop'"},
        {ascii_with("facet", "face"), "line 2: found 'face', expected 'facet' or 'endsolid'"},
        {ascii_with("outer loop", "outer"), "line 3: found 'outer', expected 'outer loop'"},
        {ascii_with("vertex 1 0 0", "vertex 1 0 inf"),
         "line 5: found 'inf', expected a finite number of at most 1e10 in size"},
        {ascii_with("vertex 1 0 0", "vertex 1 0 1e11"),
         "line 5: found '1e11', expected a finite number of at most 1e10 in size"},
        {ascii_with("vertex 1 0 0", "vertex 1,0 0 0"),
         "line 5: found '1,0', expected a finite number of at most 1e10 in size; write a decimal point, no comma"},
        {ascii_with("vertex 1 0 0\n", "\n"), "line 7: found 'endloop', expected 'vertex'"},
        {ascii_with("endloop", "vertex 1 1 1"), "line 7: found 'vertex', expected 'endloop'"},
        {ascii_with("endsolid one", "facet"), "line 9: the file ends here: expected 'outer loop'"},
        {ascii_with("endsolid one", "end"), "line 9: found 'end', expected 'facet' or 'endsolid'"},
        {ascii_with("endloop", "end loop 1"), "line 7: found 'end', expected 'endloop'"},
        {std::string(ascii_triangle) + "facet normal 0 0 1", "line 10: found 'facet', expected 'solid'"},
        {"solid nothing\nendsolid\n", "has no triangles: expected at least one"},
    }));
    CHECK(said_of(bytes, "a.stl") == "'a.stl' " + said);
}

TEST_CASE("Wrong binary STL is an error with its byte") {
    const std::string sound = binary_stl(box_triangles({0, 0, 0}, {1, 1, 1}));
    REQUIRE(said_of(sound, "a.stl") == "none");
    const auto with = [&sound](std::size_t at, const std::string& bytes) {
        return std::string(sound).replace(at, bytes.size(), bytes);
    };
    const auto bits = [](float number) { return little_endian(std::bit_cast<std::uint32_t>(number)); };
    CHECK(said_of(sound.substr(0, 83), "a.stl") ==
          "'a.stl' has 83 bytes: expected 84 or more in binary, or a first line 'solid' in ASCII");
    CHECK(said_of("", "a.stl") ==
          "'a.stl' has 0 bytes: expected 84 or more in binary, or a first line 'solid' in ASCII");
    CHECK(said_of(sound.substr(0, 683), "a.stl") ==
          "'a.stl' byte 80: says 12 triangles, expected 84 + 50 times as many bytes, 684, found 683");
    CHECK(said_of(with(80, little_endian(4294967294U)), "a.stl") ==
          "'a.stl' byte 80: says 4294967294 triangles, expected 84 + 50 times as many bytes, 214748364784, found 684");
    CHECK(said_of(with(80, little_endian(0)).substr(0, 683), "a.stl") ==
          "'a.stl' byte 80: says 0 triangles, expected 84 + 50 times as many bytes, 84, found 683");
    // As many bytes more as triangles have may be triangles.
    CHECK(said_of(with(80, little_endian(11)), "a.stl") ==
          "'a.stl' byte 80: says 11 triangles, expected 84 + 50 times as many bytes, 634, found 684");
    CHECK(said_of(sound + sound, "a.stl") ==
          "'a.stl' byte 80: says 12 triangles, expected 84 + 50 times as many bytes, 684, found 1368");
    CHECK(said_of(with(80, std::string("\0\0\0\x0c", 4)), "a.stl") ==
          "'a.stl' byte 80: the count of triangles is big-endian: expected little-endian numbers");
    CHECK(said_of(with(96, bits(std::numeric_limits<float>::quiet_NaN())), "a.stl") ==
          "'a.stl' byte 96: found nan, expected a finite number of at most 1e10 in size, little-endian");
    CHECK(said_of(with(84 + 50 + 44, bits(-std::numeric_limits<float>::infinity())), "a.stl") ==
          "'a.stl' byte 178: found -inf, expected a finite number of at most 1e10 in size, little-endian");
    CHECK(said_of(with(96, bits(2e10F)), "a.stl") ==
          "'a.stl' byte 96: found 2e+10, expected a finite number of at most 1e10 in size, little-endian");
    CHECK(said_of(binary_stl({}), "a.stl") == "'a.stl' has no triangles: expected at least one");
}

TEST_CASE("Wrong OBJ is an error with its line") {
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    const auto [bytes, said] = GENERATE_COPY(table<std::string, std::string>({
        {"v 1 2\n", "line 1: a vertex of 2 numbers: expected 3"},
        {"\n\nv 1 2 nan\n", "line 3: found 'nan', expected a finite number of at most 1e10 in size"},
        {"v 1 2 3 4 5\n", "line 1: a vertex of 5 numbers: expected 3"},
        {"v 4,0 0 1\n",
         "line 1: found '4,0', expected a finite number of at most 1e10 in size; write a decimal point, no comma"},
        {three + "f 1 2 3 1 2 3\n",
         "line 4: a face whose outline goes around more than once: expected each corner once"},
        {three + "f 1\n", "line 4: a face of 1 corner: expected at least 3"},
        {three + "f 1 2\n", "line 4: a face of 2 corners: expected at least 3"},
        {three + "f 1 2 4\n", "line 4: refers to vertex 4: expected one of the 3 before this line"},
        {three + "f 1 2 -4\n", "line 4: refers to vertex -4: expected one of the 3 before this line"},
        {three + "f 1 2 0\n", "line 4: found '0', expected a corner as i, i/t, i//n or i/t/n, with i other than 0"},
        {three + "f 1 2 3/x\n", "line 4: found '3/x', expected a corner as i, i/t, i//n or i/t/n, with i other than 0"},
        {three + "f 1 2 /3\n", "line 4: found '/3', expected a corner as i, i/t, i//n or i/t/n, with i other than 0"},
        {three + "f 1 2 3/1/1/1\n",
         "line 4: found '3/1/1/1', expected a corner as i, i/t, i//n or i/t/n, with i other than 0"},
        {three + "f 1 2 99999999999999999999\n",
         "line 4: found '99999999999999999999', expected a corner as i, i/t, i//n or i/t/n, with i other than 0"},
        {three + "face 1 2 3\n", "line 4: found 'face', expected a statement like 'v' or 'f'"},
        {three + "surf 0 1 0 1 1 2 3\n",
         "line 4: 'surf' is not read, and a surface may depend on it: expected polygons, 'f', only"},
        {three, "has no triangles: expected at least one"},
        {"", "has no triangles: expected at least one"},
    }));
    CHECK(said_of(bytes, "a.obj") == "'a.obj' " + said);
}

TEST_CASE("Meshes of more than two million triangles are errors") {
    std::string text = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 3";  // on a line, and never the same way around again
    for (int i = 0; i < 2'000'001; ++i) {
        text += i % 2 == 0 ? " 1" : " 2";
    }
    CHECK(said_of(text, "a.obj") == "none");
    CHECK(said_of(text + " 3", "a.obj") == "'a.obj' line 4: more triangles than expected, which is at most 2000000");
}

TEST_CASE("A line of more words than any face has corners is an error, whatever it says") {
    std::string words = "g";
    for (int i = 1; i < 2'001'000; ++i) {
        words += " x";
    }
    const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    CHECK(said_of(three + words + "\n", "a.obj") == "none");
    CHECK(said_of(three + "#" + words + " x\n", "a.obj") == "none");  // a comment
    CHECK(said_of(three + words + " x\n", "a.obj") ==
          "'a.obj' line 5: has more than 2001000 words: expected one statement in a line");
}

TEST_CASE("No beginning of an STL file passes for the whole without a remark") {
    const auto box = box_triangles({0, 0, 0}, {1, 1, 1});
    std::string ascii = ascii_stl(box);
    ascii.pop_back();  // its last line break may be missing
    for (const std::string& whole : {binary_stl(box, "solid box"), ascii}) {
        std::size_t remarked = 0;
        for (std::size_t size = 0; size < whole.size(); ++size) {
            CAPTURE(size);
            try {
                const TriangleMesh mesh = parse_mesh(whole.substr(0, size), "a.stl");
                REQUIRE_FALSE(mesh.remarks.empty());
                ++remarked;
            } catch (const InputError&) {
            }
        }
        CHECK(remarked == (whole == ascii ? 24U : 0U));  // behind whole facets, before or after the end of their lines
    }
}

TEST_CASE("STL files of other programs are read: nobody needs normals, counts or ends") {
    const auto box = box_triangles({0, 0, 0}, {1, 1, 1});
    const auto read = [&box](const std::string& bytes) {
        const TriangleMesh mesh = parse_mesh(bytes, "a.stl");
        CHECK(triangles_of(mesh) == box);
        return mesh.remarks;
    };
    const std::vector<std::string> none;
    std::string binary = binary_stl(box, "solid box");
    for (const float number :
         {std::numeric_limits<float>::quiet_NaN(), 1e30F, -std::numeric_limits<float>::infinity()}) {
        binary.replace(84 + 50 * 7, 4, little_endian(std::bit_cast<std::uint32_t>(number)));
        CHECK(read(binary) == none);
    }
    for (const std::uint32_t count : {0U, 4294967295U}) {
        for (const std::string header : {"stream", "solid stream"}) {
            CHECK(read(binary_stl(box, header).replace(80, 4, little_endian(count))) == none);
        }
    }
    CHECK(read(binary + "\n") ==
          std::vector<std::string>{"byte 684: the last 1 bytes are behind the last triangle and are ignored"});
    for (const std::string& rest : {std::string(3, 'x'), std::string(50, '\0'), std::string(100, '\x7f')}) {
        CHECK(read(binary + rest).size() == 1);
    }

    const std::string ascii = ascii_stl(box);
    const auto all = [&ascii](std::string_view from, std::string_view to) {
        std::string text = ascii;
        for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
            text.replace(at, from.size(), to);
        }
        return text;
    };
    for (const char* normal : {"nan nan nan", "-nan(ind) 0 0", "1.#QNAN 0 0", "1e40 0 0", "", "0 0"}) {
        CHECK(read(all("normal 0 0 0", std::string("normal ") + normal)) == none);
    }
    for (const std::string& text : {"\xef\xbb\xbf" + ascii, "\n \r\n\t" + ascii, "\xef\xbb\xbf\n  " + ascii,
                                    all("\n", "\r"), all("\n", "\r\n"), all("endsolid", "end solid box"),
                                    all("endloop", "end loop"), all("endfacet", "End Facet"), all("solid", "SOLID")}) {
        CAPTURE(text.substr(0, 40));
        CHECK(read(text) == none);
    }
    CHECK(read(all("endsolid\n", "")) ==
          std::vector<std::string>{"line 85: the file ends without 'endsolid', and may be cut off"});
    CHECK(read(ascii + "\x1a") == std::vector<std::string>{"line 87: found ' ' behind 'endsolid', which is ignored"});
    CHECK(read(ascii + std::string(7, '\0') + "\nmade by hand\n").size() == 1);
}

TEST_CASE("OBJ files of other programs are read: long lines, empty numbers, colours and line ends") {
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const auto read = [](const std::string& text) {
        const TriangleMesh mesh = parse_mesh(text, "a.obj");
        CHECK(mesh.vertices_m == std::vector<Vector3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
        CHECK(mesh.triangles == std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
        return mesh.remarks;
    };
    const std::vector<std::string> none;
    for (const char* face :
         {"f 1 2 \\\n 3 4\n", "f 1 2 \\\r\n 3 \\ \r\n4\r\n", "f \\\n1\\\n 2\\\n 3\\\n 4", "f 1// 2// 3// 4//\n",
          "f 1/1/ 2/2/ 3/3/ 4/4/\n", "f 1/ 2/ 3/ 4/\n", "f 1/0/0 2/0/0 3/-1/0 4//0\n", "fo 1 2 3 4\n"}) {
        CAPTURE(face);
        CHECK(read(square + face) == none);
        CHECK(read("\xef\xbb\xbf" + square + face) == none);
    }
    CHECK(read("v 0 0 0 1 1 1\nv 1 0 0 nan 0 2\nv 1 1 0 1 255 0 0\nv 0 1 0 1 0 0 0 1\nf 1 2 3 4\n") == none);
    std::string with_cr = square + "f 1 2 3 4\n";
    std::replace(with_cr.begin(), with_cr.end(), '\n', '\r');
    CHECK(read(with_cr) == none);
    // A comment does not go on: its last backslash is that of a path.
    CHECK(read("# C:\\meshes\\\n" + square + "f 1 2 3 4\n") == none);
    CHECK(read(square + "f 1 2 3 4\n\x1a") ==
          std::vector<std::string>{"line 6: the file ends with bytes that are no text, which are ignored"});
    CHECK(said_of(square + "f 1 2 3 4\n\x1a\nf 1 2 3\n", "a.obj") ==
          "'a.obj' line 6: found ' ', expected a statement like 'v' or 'f'");
    // A statement is told by the line on which it begins.
    CHECK(said_of(square + "f 1 2 \\\n 7\n", "a.obj") ==
          "'a.obj' line 5: refers to vertex 7: expected one of the 4 before this line");
}

TEST_CASE("UTF-16 is called by its name, and no message has bytes that are no text") {
    const auto wide = [](std::string_view text, bool is_big, bool has_mark) {
        std::string bytes = has_mark ? (is_big ? "\xfe\xff" : "\xff\xfe") : "";
        for (const char c : text) {
            bytes += is_big ? std::string{'\0', c} : std::string{c, '\0'};
        }
        return bytes;
    };
    for (const bool is_big : {false, true}) {
        for (const bool has_mark : {false, true}) {
            CHECK(said_of(wide(ascii_triangle, is_big, has_mark), "a.stl") ==
                  "'a.stl' is UTF-16 text: expected ASCII or UTF-8; save it in that encoding");
            CHECK(said_of(wide("v 0 0 0\r\n", is_big, has_mark), "a.obj") ==
                  "'a.obj' is UTF-16 text: expected ASCII or UTF-8; save it in that encoding");
        }
    }
    Random random(5);
    for (int round = 0; round < 300; ++round) {
        std::string bytes = round % 2 == 0 ? "v 0 0 " : "solid\nfacet\nouter loop\nvertex 0 0 ";
        for (int i = random.integer(1, 100); i > 0; --i) {
            bytes += static_cast<char>(random.integer(0, 255));
        }
        for (const char* name : {"a.stl", "a.obj"}) {
            const std::string said = said_of(bytes, name);
            CAPTURE(said);
            CHECK(is_utf8(said));
            CHECK(std::none_of(said.begin(), said.end(), [](char c) { return (c >= 0 && c < ' ') || c == '\x7f'; }));
        }
    }
}

TEST_CASE("Map coordinates keep their decimals until an offset is subtracted") {
    const TriangleMesh mesh = parse_mesh(
        "v 691234.5 5334567.8 523.1\nv 691244.5 5334567.8 523.1\nv 691244.5 5334577.8 523.1\nf 1 2 3\n", "a.obj");
    const Mesh placed{"", 1, std::make_shared<const TriangleMesh>(mesh), {691000, 5334000, 500}};
    CHECK(local_m(placed, mesh.vertices_m[0])[1] == Approx(567.8).epsilon(0).margin(1e-9));
    const Mesh far{"", 1, placed.surface};
    CHECK_THAT(
        error_of([&] {
            return Scene({{"", far, {}, {}}});
        }),
        Catch::EndsWith("farther than 1e6 m from its origin; an offset brings map coordinates there: expected for "
                        "example offset_m: [691240, 5334573, 523]"));
    const Scene scene({{"", placed, {1, 2, 3}, {}}});
    CHECK(scene.bounds(0).low_m[0] == Approx(235.5));
    CHECK(scene.bounds(0).high_m[1] == Approx(579.8));
}

TEST_CASE("A mesh file that cannot be read is told by its name") {
    const ScratchFolder folder;
    write_file(folder / "a.ply", "ply");
    const auto said_of_file = [&folder](const std::string& name) {
        return error_of([&] { return read_mesh(folder / name); });
    };
    const std::string in = "'" + folder.path().string() + "/";
    CHECK(said_of_file("none.stl") == in + "none.stl' cannot be read: there is no such file");
    CHECK(said_of_file("a.ply") == in + "a.ply' is of an unknown kind: expected a name that ends in .stl or .obj");
    write_file(folder / "a.stl", ascii_triangle);
    CHECK(said_of_file("a.stl") == "none");
}
